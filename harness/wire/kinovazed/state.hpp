// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace armjig::kinovazed {

/// The states of the server by name; the recordings call them so. What leads from one to another
/// stands in the emulator, and anew in the judges (`conformance/kinovazed/laws.hpp`).
enum class State : std::uint8_t {
  kEmergencyStopped,
  kPoweredOff,
  kInitializing,
  kIdle,
  kRetracting,
  kRetracted,
  kUnfolding,
  kSettingMode,
  kSteering,
  kRunningSequence,
  kFrozen,
};
inline constexpr std::array<std::string_view, 11> kStateNames{
    "emergencyStopped", "poweredOff",      "initializing", "idle",
    "retracting",       "retracted",       "unfolding",    "settingMode",
    "steering",         "runningSequence", "frozen"};

[[nodiscard]] constexpr std::string_view to_string(State state) noexcept {
  return kStateNames[static_cast<std::size_t>(state)];
}

}  // namespace armjig::kinovazed
