// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/devices.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "emulators/demo/demo.hpp"
#include "emulators/host/emulated_target.hpp"

namespace armjig {
namespace {

using Made = Outcome<std::unique_ptr<HostedStream>>;

Made make_demo(const HostedOptions& options, const std::string& where) {
  if (options.empty()) return make_hosted(demo::StreamDevice{});
  return problem(ErrorCode::kUnknownOption, where, "the demo device has no options");
}

Made make_parol6(const HostedOptions& options, const std::string& where) {
  auto arm = parol6::make_arm(options, where);
  if (!arm) return tl::unexpected{arm.error()};
  return make_hosted(*std::move(arm));
}

constexpr std::array kDevices{
    HostEntry{.device = "demo", .make = make_demo},
    HostEntry{.device = "parol6", .make = make_parol6},
};

std::string all_names() {
  std::string names;
  for (const auto& entry : kDevices) {
    if (!names.empty()) names += ", ";
    names += entry.device;
  }
  return names;
}

}  // namespace

std::span<const HostEntry> hosted_devices() noexcept { return kDevices; }

Outcome<std::unique_ptr<HostedStream>> make_hosted_device(const std::string& device,
                                                          const HostedOptions& options) {
  const auto* const entry = std::ranges::find(kDevices, device, &HostEntry::device);
  if (entry == kDevices.end()) {
    return problem(ErrorCode::kUnknownDevice, device, "there are: " + all_names());
  }
  return entry->make(options, device);
}

}  // namespace armjig
