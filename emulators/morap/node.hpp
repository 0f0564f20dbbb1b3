// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "emulators/morap/control.hpp"
#include "emulators/morap/cycles.hpp"
#include "emulators/morap/eeprom.hpp"
#include "emulators/morap/parameter_parser.hpp"
#include "emulators/morap/plant.hpp"
#include "emulators/morap/profile.hpp"
#include "harness/core/emulation.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::morap::emulation {

/// What the real firmware does in ways that nobody can predict: it writes or reads memory that
/// belongs to something else, or asks its number library for what has no answer. The emulator goes
/// on as harmlessly as it can and counts.
enum class Undefined : std::uint8_t {
  kOverlongFloat,   ///< a payload byte behind the fourth goes to other memory
  kReadPastFloat,   ///< a byte behind the fourth comes from other memory; read here as 0
  kEmptyFilter,     ///< a loop runs with a count of 0 and shifts memory; none is shifted here
  kCountAboveFour,  ///< a loop runs with a refused count that became active; four are used here
  kZeroRate,        ///< a division by 0; the slowest rate here
  kConversion,      ///< a number that does not fit an integer, or is none
};
inline constexpr std::size_t kUndefinedCount = 6;

/// How the pins of a node stand that lead to the power stage.
struct Drive {
  Bridge bridge = Bridge::kShorted;
  Level level = kZeroVolts;
};

/// Of the current sense: the largest code of its converter, and the shunt that the firmware
/// believes to be there.
inline constexpr std::uint16_t kFullScale = 4095;
inline constexpr double kBelievedShuntOhm = 820;

/// Everything that a node is made of.
struct NodeSetup {
  Eeprom eeprom;
  std::optional<PlantParameters> plant{};  ///< none: the shaft turns only by `turn_encoder`
  Profile profile = kFirmware;
  double shunt_ohm = kBelievedShuntOhm;  ///< that is there
  Duration tune_stretch{};               ///< how long the clock is held while the tuner computes
  Law law{};
};

/// A motor node with its firmware, motor and load: an `EmulatedBusDevice`. On one instant the plant
/// comes first, then the bus, then the tick. Times never decrease.
class Node {
 public:
  explicit Node(const NodeSetup& setup);

  // The bus.
  [[nodiscard]] bool acknowledges(std::uint8_t address) const noexcept;
  void start(Instant time, bool is_read) noexcept;
  [[nodiscard]] bool write(Instant time, std::byte byte) noexcept;
  [[nodiscard]] std::byte read(Instant time) noexcept;
  /// For the byte that was written last.
  [[nodiscard]] Duration stretch() const noexcept { return stretch_; }

  /// Does everything up to and including `time`.
  void advance_to(Instant time) noexcept;
  /// The first time at which `advance_to` does one more tick; never if it has no clock running.
  [[nodiscard]] Instant next_tick() const noexcept { return instant_of(next_tick_); }
  /// Power fails and comes back: memory is lost, the EEPROM and the shaft stay as they are.
  void restart(Instant time) noexcept;

  // Inputs for a node without a plant.
  void turn_encoder(Instant time, std::int32_t counts) noexcept;
  /// The current sense reads this from now on.
  void set_conversion(Instant time, std::uint16_t code) noexcept;

  // A look inside.
  [[nodiscard]] std::uint8_t address() const noexcept { return node_address(setup_.eeprom.node); }
  [[nodiscard]] MotorStatus status() const noexcept;
  [[nodiscard]] ProgrammingStatus programming_status() const noexcept { return ram_.programming; }
  /// What a read answers now.
  [[nodiscard]] CommandId selected() const noexcept { return ram_.selected; }
  [[nodiscard]] const ControllerSet& position_set() const noexcept { return ram_.position_set; }
  [[nodiscard]] const ControllerSet& speed_set() const noexcept { return ram_.speed_set; }
  [[nodiscard]] const Drive& output() const noexcept { return ram_.drive; }
  [[nodiscard]] float angle() const noexcept { return scale_.angle(encoder_count()); }  ///< rad
  /// nullptr if it has none.
  [[nodiscard]] Plant* plant() noexcept { return plant_ ? &*plant_ : nullptr; }
  [[nodiscard]] std::uint32_t count_of(Undefined what) const noexcept {
    return undefined_[static_cast<std::size_t>(what)];
  }

 private:
  enum class Mode : std::uint8_t {
    kDisabled,
    kPosition,
    kSpeed,
    kVoltage,
    kDirectVoltage,
    kTorque
  };
  enum class Pending : std::uint8_t { kNone, kStaged, kDefaults };

  void note(Undefined what) noexcept { ++undefined_[static_cast<std::size_t>(what)]; }
  [[nodiscard]] std::int32_t encoder_count() const noexcept;
  void set_encoder_count(std::int32_t count) noexcept;

  // Bytes from the bus.
  void handle(std::byte byte) noexcept;
  void handle_float(std::byte byte) noexcept;
  void apply_float(float value) noexcept;
  void handle_program(std::byte byte) noexcept;
  void handle_tune(std::byte byte) noexcept;
  void await_tick(Pending pending) noexcept;
  void set_mode(Mode mode) noexcept;
  void set_brake(bool is_on) noexcept;
  [[nodiscard]] bool is_known() const noexcept;
  [[nodiscard]] float sample_float() noexcept;
  [[nodiscard]] std::byte status_byte() const noexcept;
  [[nodiscard]] std::uint16_t convert_current() const noexcept;

  // Time.
  void run_before(Cycles time) noexcept;
  [[nodiscard]] bool has_idle_tick() const noexcept;
  void tick() noexcept;
  void install_pending() noexcept;
  void enter_mode() noexcept;
  void act() noexcept;
  void run_loop(const ControllerSet& set, float reference) noexcept;
  void drive(float volts) noexcept;
  [[nodiscard]] Level rounded(float volts) noexcept;
  void connect_plant() noexcept;
  [[nodiscard]] float turned_since(float& last_angle) noexcept;

  NodeSetup setup_;
  Scale scale_;
  bool is_on_bus_;
  std::optional<Plant> plant_;
  std::int64_t encoder_offset_ = 0;  ///< of the count to the plant's encoder
  std::uint16_t conversion_ = 0;     ///< without a plant
  std::array<std::uint32_t, kUndefinedCount> undefined_{};
  Cycles next_tick_;
  Cycles tick_period_;

  Duration stretch_{};

  /// What is lost with the power.
  struct Ram {
    // The bus.
    std::uint8_t count = 0;  ///< of bytes since the address; wraps
    CommandId id{};
    CommandId selected = CommandId::kReadAngle;
    FloatBytes value{};  ///< of a float being written or read
    std::array<std::byte, kTuneCommandSize> tune{};
    ParameterParser parser;
    // Parameters.
    ControllerSet staging;
    ControllerSet position_set;
    ControllerSet speed_set;
    Pending pending = Pending::kNone;
    ProgrammingStatus programming = ProgrammingStatus::kNothing;
    // What to do.
    bool is_calibrated = false;
    bool is_braked = false;  ///< documented profile only
    Mode mode = Mode::kDisabled;
    Mode last_mode = Mode::kDisabled;
    bool resets = false;  ///< the next step of a controller begins anew
    float position = 0.0F;
    float speed = 0.0F;
    float voltage = 0.0F;
    float current = 0.0F;
    // Doing it.
    FeedbackLoop loop;
    float voltage_mode_angle = 0.0F;  ///< one tick ago
    float torque_mode_angle = 0.0F;
    Drive drive;
    std::optional<Level> delayed;  ///< output of a loop, due at the next tick
  };
  Ram ram_;
};
static_assert(EmulatedBusDevice<Node>);

}  // namespace armjig::morap::emulation
