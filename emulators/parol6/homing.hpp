// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "emulators/parol6/joint.hpp"
#include "harness/core/quantity.hpp"
#include "harness/wire/parol6/joints.hpp"

namespace armjig::parol6::emulation {

/// The homing figures of one joint. Targets count from the switch.
struct HomingParameters {
  Level pressed_level{};
  StepRate seek_speed{};
  Steps back_off_target{};
  StepRate back_off_speed{};
  StepRate slow_seek_speed{};
  StepsPerSecond2 acceleration{};
  Steps standby_from_switch{};  ///< end of the final move
  Steps standby{};              ///< what the counter is set to there

  friend bool operator==(const HomingParameters&, const HomingParameters&) = default;
};

using HomingTable = std::array<HomingParameters, kJointCount>;

/// docs/spec/parol6.md, "Homing". The final move of J6 first parks at `kParkingJ6`, out of the way
/// of J5.
inline constexpr HomingTable kHomingTable{{
    {Level::kLow, StepRate{-2050}, Steps{850}, StepRate{-2050}, StepRate{-750},
     StepsPerSecond2{4500}, Steps{13500}, kStandby[0]},
    {Level::kHigh, StepRate{-2550}, Steps{1050}, StepRate{2050}, StepRate{-750},
     StepsPerSecond2{3000}, Steps{19588}, kStandby[1]},
    {Level::kHigh, StepRate{-2550}, Steps{1050}, StepRate{2050}, StepRate{-750},
     StepsPerSecond2{5000}, Steps{23020}, kStandby[2]},
    {Level::kLow, StepRate{5550}, Steps{-1550}, StepRate{-4050}, StepRate{4050},
     StepsPerSecond2{5500}, Steps{-10200}, kStandby[3]},
    {Level::kHigh, StepRate{-5050}, Steps{1550}, StepRate{4050}, StepRate{-4050},
     StepsPerSecond2{5500}, Steps{8900}, kStandby[4]},
    {Level::kLow, StepRate{-9550}, Steps{1550}, StepRate{4050}, StepRate{-8050},
     StepsPerSecond2{5500}, Steps{0}, kStandby[5]},
}};
inline constexpr Steps kParkingJ6{15900};
inline constexpr StepsPerSecond2 kParkingAccelerationJ6{10500};

/// The firmware's homing sequencer: J1 to J3 together, then J4, J6 to its parking place, J5, with
/// J6 returning at the end. Each group goes seek, back-off, slow seek, final move; but these are
/// independent conditions tried in a fixed order in every pass, not states, and after an
/// interruption several of them can act at once (parol6.home.interrupted).
class Homing {
 public:
  enum class Change : std::uint8_t {
    kNone,      ///< the next pass does the same as this one
    kStage,     ///< something was noticed, the next pass differs
    kFinished,  ///< all joints stand at standby
  };

  explicit Homing(const HomingTable& table) noexcept : table_{table} {}

  /// One pass of the sequencer.
  Change pass(std::array<Joint, kJointCount>& joints, Micros now) noexcept;

  /// Forgets the stages, but not which switches were seen.
  void reset() noexcept { stages_ = {}; }

  /// Forgets everything but which joints are homed.
  void forget() noexcept {
    reset();
    seen_ = {};
    seen_slow_ = {};
  }

  /// `flag(joint)` for each homed one.
  [[nodiscard]] std::uint8_t homed() const noexcept { return homed_; }

  friend bool operator==(const Homing&, const Homing&) = default;

 private:
  /// The firmware's stage variables, those that enable and clear-error wipe.
  struct Stages {
    bool has_begun = false;
    bool base_slow_seek = false;
    bool base_done = false;
    std::array<bool, kJointCount> slow_seek{};  ///< of J4, J5, J6
    bool j4_done = false;
    bool j6_parked = false;
    bool j5_done = false;

    friend bool operator==(const Stages&, const Stages&) = default;
  };

  void begin(std::array<Joint, kJointCount>& joints) noexcept;
  void base_pass(std::array<Joint, kJointCount>& joints, Micros now) noexcept;
  void wrist_pass(std::array<Joint, kJointCount>& joints, Micros now) noexcept;
  void single_pass(Joint& joint, std::size_t j, Micros now) noexcept;
  void seek(Joint& joint, bool& seen, Micros now) noexcept;
  void mark_homed(std::size_t j) noexcept { homed_ = static_cast<std::uint8_t>(homed_ | flag(j)); }
  void finish(std::array<Joint, kJointCount>& joints) noexcept;

  HomingTable table_;
  Stages stages_{};
  std::array<bool, kJointCount> seen_{};       ///< stage_1: the switch was hit once
  std::array<bool, kJointCount> seen_slow_{};  ///< stage_2: and slowly
  std::uint8_t homed_ = 0;
  bool noticed_ = false;  ///< something happened in this pass
};

}  // namespace armjig::parol6::emulation
