// SPDX-License-Identifier: Apache-2.0
// One second of an emulated node alone with its motor, told something new every 50 ms: it
// acknowledges every byte, its states are those of the table, its shaft goes no faster than the
// supply lets it, and a copy goes on to the same bytes.
//
// Input: a motor and its load, when a copy is made (0: never), then commands, each one byte and a
// number of two; what is missing of the last one is 0, and it is said again until the second is
// over.
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/eeprom.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/morap/plant.hpp"
#include "fuzz/input.hpp"
#include "fuzz/morap_possible.hpp"
#include "fuzz/require.hpp"
#include "harness/wire/morap/figures.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::fuzz::motion {
namespace {

using namespace std::chrono_literals;
using namespace morap;
using emulation::Node;

constexpr std::size_t kCommands = 20;
constexpr Duration kBetween = 50ms;

struct Choice {
  CommandId id{};
  float largest{};  ///< number that follows it
};
constexpr std::array kChoices{
    Choice{CommandId::kPosition, std::numbers::pi_v<float>},
    Choice{CommandId::kSpeed, 8.0F},
    Choice{CommandId::kVoltage, 30.0F},
    Choice{CommandId::kDirectVoltage, 30.0F},
    Choice{CommandId::kTorque, 20.0F},
    Choice{CommandId::kCalibrateZero, 0.0F},
    Choice{CommandId::kCalibrateAngle, std::numbers::pi_v<float>},
    Choice{CommandId::kDisable, 0.0F},
    Choice{CommandId::kBrake14, 0.0F},
    Choice{CommandId::kBrake15, 0.0F},
    Choice{CommandId::kDefaultControllers, 0.0F},
};

Command command_from(Input& input) {
  const auto& [id, largest] = kChoices[input.u8() % kChoices.size()];
  if (!has_number(id)) return {id, {}};
  return {id, largest * static_cast<float>(input.i16()) / 32'768.0F};
}

emulation::NodeSetup setup_from(std::uint8_t choice) {
  const auto& motor = (choice & 1) != 0 ? kDcx22l : kDcx26l;
  const auto eeprom = emulation::eeprom_of(motor, choice >> 4);
  const double inertia = (choice & 2) != 0 ? 0.005 : 0.05;
  const double dry_friction = (choice & 4) != 0 ? 0.0 : 0.072;
  return {.eeprom = eeprom,
          .plant = emulation::plant_of(eeprom.motor, inertia, 0.041, dry_friction)};
}

/// A bus with that node.
class Bench {
 public:
  explicit Bench(const emulation::NodeSetup& setup)
      : fastest_{kSupply / setup.plant->torque_constant / setup.plant->gear_ratio},
        place_{bus_.attach(Node{setup})} {}

  void tell(const Command& command) { write(encode(command)); }

  /// What reads answer then, one byte after the other.
  void go_on_until(Instant time) {
    time_ = time;
    bus_.advance_to(time);
    ask(CommandId::kReadMotorStatus, 1);
    ask(CommandId::kReadAngle, sizeof(float));
    ask(CommandId::kReadCurrent, sizeof(float));
  }

  [[nodiscard]] const std::vector<std::byte>& answers() const noexcept { return answers_; }
  [[nodiscard]] double fastest() const noexcept { return fastest_; }  ///< rad/s
  [[nodiscard]] Node& node() { return bus_.device<Node>(place_); }

 private:
  static constexpr double kSupply = 24;  // V

  void pass(BusReply reply) {
    require(reply.outcome == BusReply::Outcome::kAck, "a node acknowledges what is meant for it");
    time_ = reply.end;
  }
  void write(Bytes bytes) {
    pass(bus_.start(time_, node().address(), /*is_read=*/false));
    for (const auto byte : bytes) pass(bus_.write(time_, byte));
    pass(bus_.stop(time_));
  }
  void ask(CommandId what, std::size_t size) {
    write(encode(Command{what, {}}));
    pass(bus_.start(time_, node().address(), /*is_read=*/true));
    for (std::size_t i = 0; i < size; ++i) {
      const auto reply = bus_.read(time_);
      pass(reply);
      answers_.push_back(reply.byte);
    }
    pass(bus_.stop(time_));
  }

  i2c::Bus bus_;
  double fastest_;
  std::size_t place_;
  Instant time_{};
  std::vector<std::byte> answers_;
};

void see(Bench& bench) {
  auto& node = bench.node();
  require_possible(node);
  constexpr double kOvershoot = 1.02;  // of an inductance
  require(std::abs(node.plant()->speed()) <= kOvershoot * bench.fastest(),
          "no shaft goes faster than the supply lets it");
}

void check_second(Input input) {
  Bench bench{setup_from(input.u8())};
  const std::size_t copied_at = input.u8();
  std::optional<Bench> copy;
  Command command;
  for (std::size_t i = 0; i < kCommands; ++i) {
    if (i == 0 || !input.is_empty()) command = command_from(input);
    if (i > 0 && i == copied_at) copy = bench;
    const auto end = at(kBetween * static_cast<std::int64_t>(i + 1));
    const auto live = [&](Bench& one) {
      one.tell(command);
      one.go_on_until(end);
    };
    live(bench);
    if (copy) live(*copy);
    see(bench);
  }
  require(!copy || bench.answers() == copy->answers(), "a copy goes on to the same bytes");
}

}  // namespace
}  // namespace armjig::fuzz::motion

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::motion::check_second(armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
