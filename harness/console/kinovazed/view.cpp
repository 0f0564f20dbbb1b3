// SPDX-License-Identifier: Apache-2.0
#include "harness/console/kinovazed/view.hpp"

#include <fmt/core.h>

#include <array>
#include <string_view>
#include <utility>

namespace armjig::kinovazed::console {

namespace {

constexpr std::array<std::string_view, 8> kFlags{
    "connected", "emergency stop",    "initialized",      "freezed",
    "idle",      "running objective", "in joystick mode", "retracted"};

constexpr std::array<std::pair<std::uint8_t, std::string_view>, 6> kStates{{
    {beat::kEmergencyStop, "emergency stop"},
    {beat::kFreezed, "frozen"},
    {beat::kIdle, "idle"},
    {beat::kRunningObjective, "running an objective"},
    {beat::kInJoystickMode, "steering"},
    {beat::kRetracted, "retracted"},
}};

}  // namespace

std::string state_of(Heartbeat beat) {
  for (const auto& [flag, name] : kStates) {
    if ((beat.flags & flag) != 0) return std::string{name};
  }
  return (beat.flags & beat::kInitialized) != 0
             ? "initializing, retracting, unfolding or changing mode"
             : "powered off or initializing";
}

std::string flags_of(Heartbeat beat) {
  auto text = fmt::format("{}:", beat.flags);
  for (std::size_t i = 0; i < kFlags.size(); ++i) {
    if ((beat.flags >> i & 1) == 0) continue;
    text += fmt::format("{} {}", text.ends_with(':') ? "" : ",", kFlags[i]);
  }
  return text;
}

}  // namespace armjig::kinovazed::console
