// SPDX-License-Identifier: Apache-2.0
#include "cli/reference.hpp"

#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "emulators/host/host.hpp"
#include "emulators/host/served.hpp"
#include "harness/rig/real_target.hpp"

namespace armjig::cli {
namespace {

/// The bench goes first.
struct Reference {
  std::unique_ptr<Served> served;
  std::unique_ptr<Bench> bench;
};

template <class Kind>
Outcome<std::unique_ptr<typename Kind::Port>> open_served(const Kind& kind, const Target& target,
                                                          std::string_view scheme,
                                                          std::unique_ptr<Served>& served) {
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
          served = serve_aside(std::move(host));
          return parse_target(served->target()).and_then([&](const Target& place) {
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
            return open_served(kind, target, scheme, reference->served);
          };
        }
        auto rig = Rig<typename std::remove_cvref_t<decltype(kind)>::Port>::open(wiring, how);
        if (!rig) return;
        auto bench = kind.make_bench(*std::move(rig), how);
        if (bench) reference->bench = *std::move(bench);
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
  return [&device, other, scheme = how.target.scheme] {
    return open_reference(device, other, scheme);
  };
}

}  // namespace armjig::cli
