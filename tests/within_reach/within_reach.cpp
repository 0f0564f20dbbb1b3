// SPDX-License-Identifier: Apache-2.0
#include "tests/within_reach/within_reach.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

#include "tests/within_reach/without_hands.hpp"

namespace armjig::test {
namespace {

/// What stands for a real device. Those who open one have plain functions, which cannot keep it.
struct Reached {
  const cli::Device* device{};
  Target emulated;
  Endpoint* port{};  ///< of the emulated one, when it is there
};
Reached reached;

template <class Kind>
Outcome<std::unique_ptr<typename Kind::Port>> open_reached(const Target& /*place*/,
                                                           const SerialLine& /*line*/) {
  const auto& kind = std::get<Kind>(reached.device->port);
  return cli::wiring_of(*reached.device, kind).open_emulated(reached.emulated).map([](auto port) {
    reached.port = port.get();
    return without_hands(std::move(port));
  });
}

template <class Kind>
Outcome<std::unique_ptr<Bench>> open(const Kind& kind, std::string_view place) {
  auto wiring = cli::wiring_of(*reached.device, kind);
  wiring.open_real = open_reached<Kind>;
  RigOptions how;
  how.target = *parse_target(std::string{place});
  how.permissions = Permissions::all();
  how.when_left = WhenLeft::kSayNothing;
  auto rig = Rig<typename Kind::Port>::open(wiring, how);
  if (!rig) return tl::unexpected{rig.error()};
  return kind.make_bench(*std::move(rig), how);
}

}  // namespace

Outcome<std::unique_ptr<Bench>> bench_within_reach(
    const cli::Device& device, const Target& emulated,
    std::function<bool(std::string_view input)> has_input) {
  constexpr std::array<std::string_view, 3> kPlaces{"pty:/dev/null", "tcp:localhost:1",
                                                    "i2c:/dev/null"};
  reached = {&device, emulated};
  auto bench = std::visit(
      [&](const auto& kind) { return open(kind, kPlaces.at(device.port.index())); }, device.port);
  if (!bench) return bench;
  (*bench)->set_hand(
      {.has = std::move(has_input), .set = [](std::string_view input, std::int64_t value) {
         return reached.port->touch(input, value);
       }});
  return bench;
}

}  // namespace armjig::test
