// SPDX-License-Identifier: Apache-2.0
#include "cli/presented.hpp"

#include <type_traits>
#include <utility>
#include <variant>

#include "emulators/memory/impaired.hpp"
#include "emulators/memory/overheard.hpp"
#include "harness/rig/real_target.hpp"

namespace armjig::cli {
namespace {

/// The device, whether it is emulated or at the other end of a link.
template <class Kind>
Outcome<std::unique_ptr<typename Kind::Hosted>> open_device(const Kind& kind, const Target& target,
                                                            RelayStatistics& statistics) {
  if (target.is_emulated()) return cli::emulate(kind, target.options, target.text);
  if constexpr (std::is_same_v<Kind, OnBus>) {
    return problem(ErrorCode::kUnsupported, target.text,
                   "adapters do whole transactions only, so that a tap would not be transparent; "
                   "of a bus only an emulated one can be recorded or served");
  } else {
    auto port = open_target<typename Kind::Port>(target, line_of(kind));
    if (!port) return tl::unexpected{port.error()};
    if constexpr (std::is_same_v<Kind, OnStream>) {
      return relay(*std::move(port), statistics);
    } else {
      auto relayed = relay(*std::move(port), statistics);
      if (!relayed) return problem(relayed.error().code, target.text, "it cannot be waited for");
      return *std::move(relayed);
    }
  }
}

}  // namespace

Outcome<std::unique_ptr<Presented>> Presented::open(const Device& device, const PresentHow& how) {
  std::unique_ptr<Presented> presented{new Presented};
  // Only real time can be told as a time of day.
  const auto epoch_ns = how.speed == 1 ? epoch_of({}) : 0;
  const auto made = std::visit(
      [&](const auto& kind) -> Outcome<void> {
        auto opened = open_device(kind, how.target, presented->relayed_);
        if (!opened) return tl::unexpected{opened.error()};
        auto capture = HostedCapture::open(how.capture, device, how.target.text, epoch_ns);
        if (!capture) return tl::unexpected{capture.error()};
        presented->capture_ = *std::move(capture);
        auto hosted = presented->capture_.watch(*std::move(opened));
        if (how.witness != nullptr) hosted = overhear(std::move(hosted), *how.witness);
        if (how.impairment) {
          auto impaired = impair(std::move(hosted), *how.impairment);
          if (!impaired) return tl::unexpected{impaired.error()};
          hosted = *std::move(impaired);
        }
        if (how.check != nullptr) hosted = how.check->watch(std::move(hosted));
        presented->hosted_ = std::move(hosted);
        return {};
      },
      device.port);
  if (!made) return tl::unexpected{made.error()};
  return presented;
}

}  // namespace armjig::cli
