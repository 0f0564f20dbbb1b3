// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/bus_bench.hpp"
#include "conformance/morap/motors.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::morap::conformance {

/// The states in which cases begin, as indices into the suite's `starts`.
enum Start : std::uint8_t {
  kListening,     ///< as it is
  kUncalibrated,  ///< calibration unknown, no mode
  kDisabled,      ///< calibrated at 0 where it stands, no mode
  kProgrammable,  ///< likewise, with the stored controllers; what was in use is put back at the end
  kFresh,         ///< just switched on, the shaft held, all its ticks still to come
  kFree,          ///< just switched on, the shaft free to turn, calibrated at 0
  kSlow,          ///< likewise, and loops that run have ticks of `kSlowRateHz`
  kSwitchedOn,    ///< at rest when it was switched on; nothing was said to it since
};

/// A conversation with a motor node, in the words of its protocol.
class NodeBench final : public BusBench {
 public:
  struct Subject {
    BusAddress address;
    const Motor* motor = nullptr;  ///< none: it is found out, if it is a known one
    bool is_real = false;          ///< the first of its bus that answers; its shaft turns
    bool is_exact = false;         ///< time is virtual, and nothing on the bus takes longer than it
                                   ///< must
  };
  NodeBench(Rig<BusPort> rig, const Subject& subject);

  /// So long a node may hold the clock (morap.bus.clock-before-read).
  static constexpr Duration kLongestHold = std::chrono::milliseconds{5};
  /// Of loops whose ticks are told apart by a clock of this machine (morap.tick.slow-rate).
  static constexpr std::uint16_t kSlowRateHz = 5;
  NodeBench(const NodeBench&) = delete;
  NodeBench& operator=(const NodeBench&) = delete;
  ~NodeBench() override;

  [[nodiscard]] bool is_alive() override;
  [[nodiscard]] bool revive() override;
  void bring_to(std::size_t start) override;
  void measure_noise() override;

  // Writing. A byte without acknowledgement is a finding.
  void send(const Command& command);
  void send(CommandId id) { send(Command{id}); }
  void send(CommandId id, float value) { send(Command{id, value}); }
  void send(const ControllerSet& set) { send(Command{CommandId::kProgram, set}); }
  void tune(TuneKind kind, float inertia, float pole);
  /// Bytes in hexadecimal digits.
  void send_bytes(std::string_view hex, End end = End::kStop);
  void send_bytes(Bytes bytes, End end = End::kStop);

  // Reading: chooses, then reads in a transaction of its own.
  [[nodiscard]] std::vector<std::byte> read(CommandId selector, std::size_t size);
  /// Without choosing.
  [[nodiscard]] std::vector<std::byte> read_on(std::size_t size);
  [[nodiscard]] float number(CommandId selector);

  // Expecting.
  void expect_bytes(CommandId selector, std::string_view hex);
  void expect_read_on(std::string_view hex);
  void expect_same(Bytes actual, Bytes wanted);
  void expect_number(CommandId selector, float wanted);  ///< bit for bit
  void expect_near(CommandId selector, double wanted, double tolerance);
  void expect_volts(float wanted) { expect_number(CommandId::kReadVoltage, wanted); }
  /// The voltage of so many levels.
  void expect_levels(int levels) { expect_volts(static_cast<float>(levels) * kVoltsPerLevel); }
  void expect_status(MotorStatus wanted);
  void expect_programming(ProgrammingStatus wanted);
  void expect_absent(BusAddress address);

  // Time.
  /// Long enough for what waits for a tick of any rate from 200 Hz on.
  void settle();
  /// Waits until after the next tick; from then on the node has `rate_hz`. Of a fresh node it is
  /// known when that is. From `kSlow` on it is not, but ticks of loops are so far apart that the
  /// middle between two of them is; who misses it leaves the case open.
  void tick(std::uint16_t rate_hz = 0);
  /// Of loops: that of idling on a fresh node.
  [[nodiscard]] std::uint16_t loop_rate() const noexcept {
    return is_slow_ ? kSlowRateHz : kIdleRateHz;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  /// Waits until a read just now would still be before the next tick, as late as that is known.
  void wait_for_tick();
  /// The voltage that was chosen to be read.
  void expect_read_levels(int levels);
  /// Reads the voltage behind each of the next ticks.
  void expect_levels_at_ticks(std::span<const int> levels);
  void expect_levels_at_ticks(std::initializer_list<int> levels) {
    expect_levels_at_ticks(std::span{levels.begin(), levels.size()});
  }

  /// The motor of the node; skips the case if nobody knows it.
  [[nodiscard]] const Motor& motor();
  [[nodiscard]] BusAddress address() const noexcept { return subject_.address; }
  /// Turns the held shaft.
  void turn(int counts) { touch("encoder", counts); }

 protected:
  [[nodiscard]] Duration longest_answer() const noexcept override { return kLongestHold; }

 private:
  void expect_read(Bytes actual, Bytes wanted);
  void expect_state(CommandId selector, std::string_view name, int wanted);
  void find_node();
  void find_motor();
  void keep_sets();
  void put_sets_back();
  void prepare(const Command& command);
  void prepare(CommandId id) { prepare(Command{id}); }
  void prepare(CommandId id, float value) { prepare(Command{id, value}); }
  /// How a shaft turned on when nothing drove it any more, rad.
  struct Coasting {
    float first = 0.0F;
    float last = 0.0F;
    bool is_at_rest = false;
    bool is_slower = false;  ///< than it was when it was first looked at
  };
  void rest();
  [[nodiscard]] Coasting watch_rest();
  void brake();
  void hold(std::int64_t shaft);
  void power_up(std::int64_t shaft);
  void switch_on();
  void leave_slow_loop();
  void keep_pace();

  Subject subject_;
  bool is_found_ = false;
  std::array<std::vector<std::byte>, 2> kept_sets_;  ///< as they were before the first case
  std::int64_t shaft_ = 1;                           ///< 0: held
  bool has_rested_ = false;                          ///< while nothing drove it and nothing held it
  Instant next_tick_{};  ///< from `kSlow` on within a sixth of the time between two of them
  std::uint16_t rate_hz_ = kIdleRateHz;
  bool is_slow_ = false;
};

}  // namespace armjig::morap::conformance
