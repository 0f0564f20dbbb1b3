// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/bus_rig.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "harness/link/i2c_dev.hpp"
#include "harness/link/i2c_tiny_usb.hpp"
#include "harness/link/impaired_bus.hpp"
#include "harness/rig/bus_log.hpp"

namespace armjig {

Outcome<std::unique_ptr<BusPort>> open_bus(const Target& target, OpenEmulatedBus open_emulated) {
  if (target.is_emulated()) return open_emulated(target);
  if (target.scheme == "i2c") return open_i2c_dev(target.address);
  if (target.scheme == "i2c-tiny-usb") return open_i2c_tiny_usb(target.address);
  return problem(ErrorCode::kBadTarget, fmt::format("'{}'", target.text),
                 "a bus is written as emulated:, i2c:/dev/i2c-N or i2c-tiny-usb:");
}

Outcome<BusRig> BusRig::open(std::string_view device, const RigOptions& options,
                             OpenEmulatedBus open_emulated) {
  const bool is_emulated = options.target.is_emulated();
  if (options.impairment && !is_emulated) {
    return problem(ErrorCode::kUnsupported, "--impair",
                   "only an emulated bus can be made bad on purpose");
  }
  auto port = open_bus(options.target, open_emulated);
  if (!port) return tl::unexpected{port.error()};
  BusRig rig;
  rig.port_ = *std::move(port);
  if (!options.wire_log.empty()) {
    const auto entry = std::ranges::find(dissectors(), device, &DissectorEntry::device);
    auto logged = LoggedBus::log(std::move(rig.port_), options.wire_log, *entry);
    if (!logged) return tl::unexpected{logged.error()};
    rig.port_ = *std::move(logged);
  }
  if (options.impairment) {
    auto impaired = ImpairedBus::make(std::move(rig.port_), *options.impairment);
    if (!impaired) return tl::unexpected{impaired.error()};
    rig.port_ = *std::move(impaired);
  }
  if (!is_emulated) {
    const auto judge = std::ranges::find(bus_judges(), device, &BusJudgeEntry::device);
    auto guarded =
        std::make_unique<GuardedBus>(std::move(rig.port_), judge->make(), options.permissions);
    rig.guard_ = guarded.get();
    rig.port_ = std::move(guarded);
  }
  return rig;
}

std::optional<Refusal> BusRig::last_refusal() const {
  return guard_ == nullptr ? std::nullopt : guard_->last_refusal();
}

}  // namespace armjig
