// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "emulators/kinovazed/bench_arm.hpp"
#include "emulators/kinovazed/jaco_arm.hpp"
#include "emulators/kinovazed/plant.hpp"
#include "harness/core/time.hpp"

namespace armjig::kinovazed::emulation {

/// What the server does to the arm; each can fail.
enum class ArmCall : std::uint8_t {
  kOpen,
  kTakeControl,
  kReleaseControl,
  kReadPosition,
  kReadStatus,
  kReadCurrent,
  kReadVelocity,
  kErase,
  kWriteAxes,
  kReleaseStick,
  kPressHome,
  kWriteTarget,
  kSelectCartesian,
  kSelectAngular,
};
/// As recordings and options spell them.
inline constexpr std::array<std::string_view, 14> kArmCallNames{"arm_open",
                                                                "take_control",
                                                                "release_control",
                                                                "position_read",
                                                                "status_read",
                                                                "current_read",
                                                                "velocity_read",
                                                                "trajectory_erase",
                                                                "joystick_axes_write",
                                                                "joystick_release",
                                                                "home_button_press",
                                                                "target_write",
                                                                "cartesian_mode_select",
                                                                "angular_mode_select"};

[[nodiscard]] constexpr std::string_view to_string(ArmCall call) noexcept {
  return kArmCallNames[static_cast<std::size_t>(call)];
}

/// What calls take with them and bring back, each its own.
struct ArmData {
  Stick stick;  ///< written
  Pose target;  ///< written
  Pose pose;    ///< read, as are the others
  ArmMode mode{};
  float current_sum{};
};

using Plant = std::variant<BenchArm, JacoArm>;

/// The arm on its USB cable: a plant, and whether calls get through to it.
class ArmPort {
 public:
  /// Uses of a call that fail, after `skip` that succeed. `count` -1: all.
  struct Failure {
    int skip = 0;
    int count = 0;
  };

  ArmPort() = default;
  explicit ArmPort(Plant plant) : plant_{std::move(plant)} {}

  /// Whether the next use of the call gets through.
  [[nodiscard]] bool attempt(ArmCall call) noexcept;
  /// False: the call does not get through, and nothing happens.
  [[nodiscard]] bool call(Instant time, ArmCall call, ArmData& data);

  void fail(ArmCall call, Failure failure) noexcept {
    failures_[static_cast<std::size_t>(call)] = failure;
  }
  void clear_failures() noexcept { failures_ = {}; }
  void unplug() noexcept { is_plugged_ = false; }
  void plug() noexcept { is_plugged_ = true; }

  [[nodiscard]] Plant& plant() noexcept { return plant_; }
  [[nodiscard]] const Plant& plant() const noexcept { return plant_; }

  /// Calls `use` with the plant, whichever it is, brought up to `time`.
  template <class Use>
  auto with_plant(Instant time, Use&& use) {
    return std::visit(
        [&](auto& plant) {
          plant.advance_to(time);
          return use(plant);
        },
        plant_);
  }

 private:
  Plant plant_;
  bool is_plugged_ = true;
  std::array<Failure, kArmCallNames.size()> failures_{};
};

}  // namespace armjig::kinovazed::emulation
