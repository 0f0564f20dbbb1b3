// SPDX-License-Identifier: Apache-2.0
#include "cli/reference.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "emulators/host/host.hpp"
#include "emulators/host/served.hpp"
#include "harness/rig/real_target.hpp"

namespace armjig::cli {
namespace {

/// The bench goes first.
struct Reference {
  std::unique_ptr<Served> served;
  Hand hand{};
  std::unique_ptr<Bench> bench;
};

/// Until then a host that runs has done it.
constexpr std::chrono::seconds kLongestTouch{2};

/// Does to a served device what no client can.
Hand hand_at(Host& host, std::vector<DeviceInput> inputs) {
  const auto has = [inputs = std::move(inputs)](std::string_view name) {
    return std::ranges::find(inputs, name, &DeviceInput::name) != inputs.end();
  };
  const auto set = [&host](std::string_view name, std::int64_t value) {
    const auto is_taken = std::make_shared<std::promise<bool>>();
    auto answer = is_taken->get_future();
    host.set_input(std::string{name}, value,
                   [is_taken](bool taken) { is_taken->set_value(taken); });
    return answer.wait_for(kLongestTouch) == std::future_status::ready && answer.get();
  };
  return {has, set};
}

template <class Kind>
Outcome<std::unique_ptr<typename Kind::Port>> open_served(const Kind& kind, const Target& target,
                                                          std::string_view scheme,
                                                          Reference& reference) {
  using OpenedPort = Outcome<std::unique_ptr<typename Kind::Port>>;
  if constexpr (std::is_same_v<Kind, OnBus>) {
    return problem(ErrorCode::kUnsupported, target.text, "a bus cannot be hosted in this process");
  } else {
    HostOptions how;
    if (std::is_same_v<Kind, OnServer> || scheme == "tcp" || scheme == "rfc2217") {
      how.tcp.emplace();
    } else {
      how.pty.emplace();
    }
    return emulate(kind, target.options, target.text)
        .and_then([&](auto hosted) { return Host::open(std::move(hosted), how); })
        .and_then([&](Host host) -> OpenedPort {
          auto inputs = host.inputs();
          reference.served = serve_aside(std::move(host));
          reference.hand = hand_at(reference.served->host(), std::move(inputs));
          return parse_target(reference.served->target()).and_then([&](const Target& place) {
            return open_target<typename Kind::Port>(place, line_of(kind));
          });
        });
  }
}

std::shared_ptr<Bench> open_reference(const Device& device, const RigOptions& how,
                                      std::string_view scheme) {
  const auto reference = std::make_shared<Reference>();
  std::visit(
      [&](const auto& kind) {
        auto wiring = wiring_of(device, kind);
        if (scheme != "emulated") {
          wiring.open_emulated = [&](const Target& target) {
            return open_served(kind, target, scheme, *reference);
          };
        }
        auto rig = Rig<typename std::remove_cvref_t<decltype(kind)>::Port>::open(wiring, how);
        if (!rig) return;
        auto bench = kind.make_bench(*std::move(rig), how);
        if (!bench) return;
        reference->bench = *std::move(bench);
        reference->bench->set_hand(reference->hand);
      },
      device.port);
  return {reference, reference->bench.get()};
}

}  // namespace

std::function<std::shared_ptr<Bench>()> reference_of(const Device& device, const RigOptions& how,
                                                     const std::string& profile) {
  RigOptions other;
  other.target.text = other.target.scheme = "emulated";
  if (profile != to_string(armjig::Profile::kFirmware)) other.target.options["profile"] = profile;
  other.impairment = how.impairment;
  return [&device, other, scheme = how.target.scheme]() mutable {
    if (other.impairment) ++other.impairment->seed;  // no two are hit alike
    return open_reference(device, other, scheme);
  };
}

}  // namespace armjig::cli
