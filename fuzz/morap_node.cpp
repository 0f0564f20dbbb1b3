// SPDX-License-Identifier: Apache-2.0
// Two emulated nodes on buses of their own get the same treatment. One does each tick of its timer,
// the other leaps over ticks that repeat themselves, and is replaced by a copy now and then. Nobody
// on the bus may be able to tell them apart.
//
// Input: a node to begin with, then operations, each one byte and its arguments. What the input
// does not say is 0.
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/eeprom.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/morap/plant.hpp"
#include "fuzz/input.hpp"
#include "fuzz/require.hpp"
#include "harness/wire/morap/figures.hpp"

namespace armjig::fuzz::nodes {
namespace {

using namespace std::chrono_literals;
using morap::emulation::Node;
using morap::emulation::NodeSetup;

/// What one input may cost the node that does every tick.
constexpr Duration kLongest = 2s;
constexpr int kMostOperations = 80;

NodeSetup setup_from(Input& input) {
  const auto choice = input.u8();
  const auto& motor = (choice & 1) != 0 ? morap::kDcx26l : morap::kDcx22l;
  NodeSetup setup{.eeprom = morap::emulation::eeprom_of(motor, choice >> 1 & 0x0F)};
  if ((choice & 0x20) == 0) {
    constexpr double kInertia = 0.05;
    constexpr double kViscous = 0.1;
    setup.plant = morap::emulation::plant_of(setup.eeprom.motor, kInertia, kViscous,
                                             (choice & 0x40) != 0 ? 0.2 : 0.0);
  }
  if ((choice & 0x80) != 0) setup.profile = morap::emulation::kDocumented;
  return setup;
}

/// A bus with one node.
class Bench {
 public:
  explicit Bench(const NodeSetup& setup) : place_{bus_.attach(Node{setup})} {}

  [[nodiscard]] Node& node() { return bus_.device<Node>(place_); }
  [[nodiscard]] i2c::Bus& bus() noexcept { return bus_; }
  void tick_until(Instant time) {
    while (node().next_tick() < time) node().advance_to(node().next_tick());
  }

 private:
  i2c::Bus bus_;
  std::size_t place_;
};

class Pair {
 public:
  explicit Pair(const NodeSetup& setup) : fast_{setup}, plain_{setup} {}

  [[nodiscard]] Instant time() const noexcept { return time_; }
  [[nodiscard]] std::uint8_t address() { return fast_.node().address(); }

  void copy() {
    auto other = fast_;
    fast_ = std::move(other);
  }
  void wait(Duration duration) {
    time_ += duration;
    plain_.tick_until(time_);
    each([this](Bench& bench) { bench.bus().advance_to(time_); });
  }
  /// Of the master. Answers whether it was acknowledged.
  template <class Operation>
  bool pass(Operation operation) {
    plain_.tick_until(time_);
    const auto one = operation(fast_.bus(), time_);
    const auto other = operation(plain_.bus(), time_);
    require(one.outcome == other.outcome, "both acknowledge the same");
    require(one.end == other.end, "both hold the clock alike");
    require(one.byte == other.byte, "both answer the same");
    time_ = one.end;
    return one.outcome == BusReply::Outcome::kAck;
  }
  /// Beside the bus.
  template <class Operation>
  void each(Operation operation) {
    operation(fast_);
    operation(plain_);
    require(fast_.node().status() == plain_.node().status(), "both have the same status");
    require(fast_.node().programming_status() == plain_.node().programming_status(),
            "both are as far with programming");
  }

 private:
  Bench fast_;
  Bench plain_;
  Instant time_{};
};

void stop(Pair& pair) {
  (void)pair.pass([](i2c::Bus& bus, Instant time) { return bus.stop(time); });
}

void write(Pair& pair, std::uint8_t address, Bytes bytes, bool stops) {
  bool is_there =
      pair.pass([address](i2c::Bus& bus, Instant time) { return bus.start(time, address, false); });
  for (const auto byte : bytes) {
    if (!is_there) break;
    is_there = pair.pass([byte](i2c::Bus& bus, Instant time) { return bus.write(time, byte); });
  }
  if (stops) stop(pair);
}

void read(Pair& pair, std::uint8_t address, std::size_t count) {
  const bool is_there =
      pair.pass([address](i2c::Bus& bus, Instant time) { return bus.start(time, address, true); });
  for (std::size_t i = 0; is_there && i < count; ++i) {
    (void)pair.pass([](i2c::Bus& bus, Instant time) { return bus.read(time); });
  }
  stop(pair);
}

/// One of the commands, whole: a number or two bytes, as many as it wants or not.
void command(Input& input, Pair& pair) {
  std::vector<std::byte> bytes{static_cast<std::byte>(input.u8())};
  const auto more = input.bytes(input.u8() % 48U);
  bytes.insert(bytes.end(), more.begin(), more.end());
  write(pair, pair.address(), bytes, true);
}

void touch(Input& input, Pair& pair) {
  const auto what = input.u8();
  const auto value = input.i16();
  const auto time = pair.time();
  pair.each([=](Bench& bench) {
    if (what % 4 == 0) bench.node().turn_encoder(time, value);
    if (what % 4 == 1) bench.node().set_conversion(time, static_cast<std::uint16_t>(value) & 0xFFF);
    if (what == 0xAA) bench.node().restart(time);
  });
}

void operate(Input& input, Pair& pair) {
  switch (input.u8() % 8) {
    case 0:
    case 1:
    case 2:
      return command(input, pair);
    case 3:
      return read(pair, pair.address(), input.u8() % 16U);
    case 4:  // some ticks
      return pair.wait(std::chrono::microseconds{std::int64_t{16} * input.u8()});
    case 5:  // many ticks
      return pair.wait(std::chrono::milliseconds{input.u8()});
    case 6:
      return touch(input, pair);
    default: {  // any address, any bytes, no stop; and a copy takes over
      const auto address = static_cast<std::uint8_t>(input.u8() & 0x7FU);
      write(pair, address, input.bytes(input.u8() % 8U), false);
      pair.copy();
    }
  }
}

void check_nodes(Input input) {
  Pair pair{setup_from(input)};
  for (int i = 0; i < kMostOperations && !input.is_empty() && pair.time() < at(kLongest); ++i) {
    operate(input, pair);
  }
  pair.wait(20ms);
  for (const auto what : {std::byte{0x80}, std::byte{0x81}, std::byte{0x82}, std::byte{0x83},
                          std::byte{0x84}, std::byte{0x8B}}) {
    const std::array select{what};
    write(pair, pair.address(), select, true);
    read(pair, pair.address(), 4);
  }
}

}  // namespace
}  // namespace armjig::fuzz::nodes

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::nodes::check_nodes(armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
