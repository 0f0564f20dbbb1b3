// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

/// The words of the KinovaZED protocol (docs/spec/kinovazed.md), spelled exactly as on the wire.
namespace armjig::kinovazed {

/// Whose behaviour is meant: the server as shipped, or the one that its document promises.
enum class Profile : std::uint8_t { kFirmware, kDocumented };

/// What a client asks for.
enum class Verb : std::uint8_t {
  kEStop,
  kQuitEStop,
  kInitialize,
  kUnfold,
  kRetract,
  kFreeze,
  kUnfreeze,
  kSetJoystickMode,
  kMoveJoystick,
  kRunObjective,
  kSetActiveObjective,
  kGetObjectivePosition,
  kGetAbsolutePosition,
};
inline constexpr std::array<std::string_view, 13> kVerbNames{"EStop",
                                                             "QuitEStop",
                                                             "Initialize",
                                                             "Unfold",
                                                             "Retract",
                                                             "Freeze",
                                                             "Unfreeze",
                                                             "SetJoystickMode",
                                                             "MoveJoystick",
                                                             "RunObjective",
                                                             "SetActiveObjective",
                                                             "GetObjectivePosition",
                                                             "GetAbsolutePosition"};
/// The first so many are answered, and decided by the server's state; the others are for its log.
inline constexpr std::size_t kAnsweredVerbs = 10;
[[nodiscard]] constexpr bool is_answered(Verb verb) noexcept {
  return static_cast<std::size_t>(verb) < kAnsweredVerbs;
}
[[nodiscard]] constexpr bool names_objective(Verb verb) noexcept {
  return verb == Verb::kRunObjective || verb == Verb::kSetActiveObjective;
}

enum class Mode : std::uint8_t { kNoMode, kXyz, kRotation, kAxis1to3, kAxis4to6 };
inline constexpr std::array<std::string_view, 5> kModeNames{"NoMode", "XYZ", "Rotation", "Axis1to3",
                                                            "Axis4to6"};

/// The first seven are the document's, the others were added later.
enum class Objective : std::uint8_t {
  kCurrent,
  kHome,
  kHandle,
  kOpenDoor,
  kPullDoor,
  kSuckDoor,
  kAntenna,
  kFindBottle,
  kPlaceBottle,
};
inline constexpr std::size_t kDocumentedObjectives = 7;
inline constexpr std::array<std::string_view, 9> kObjectiveNames{
    "Current",  "Home",    "Handle",     "OpenDoor",   "PullDoor",
    "SuckDoor", "Antenna", "FindBottle", "PlaceBottle"};

/// What the server says, heartbeats aside. "Freezed" is theirs.
enum class Event : std::uint8_t {
  kAccepted,
  kRejected,
  kInitialized,
  kUnfolded,
  kRetracted,
  kFreezed,
  kUnfreezed,
  kJoystickModeSet,
  kObjectiveDone,
};
inline constexpr std::array<std::string_view, 9> kEventNames{
    "Accepted", "Rejected",  "Initialized",     "Unfolded",     "Retracted",
    "Freezed",  "Unfreezed", "JoystickModeSet", "ObjectiveDone"};

inline constexpr std::string_view kHeartbeatName = "Heartbeat";

/// Flags of a heartbeat; the document's names without "is" and "has".
namespace beat {
inline constexpr std::uint8_t kConnected = 1;
inline constexpr std::uint8_t kEmergencyStop = 2;
inline constexpr std::uint8_t kInitialized = 4;
inline constexpr std::uint8_t kFreezed = 8;
inline constexpr std::uint8_t kIdle = 16;
inline constexpr std::uint8_t kRunningObjective = 32;
inline constexpr std::uint8_t kInJoystickMode = 64;
inline constexpr std::uint8_t kRetracted = 128;
}  // namespace beat

[[nodiscard]] constexpr std::string_view to_string(Verb verb) noexcept {
  return kVerbNames[static_cast<std::size_t>(verb)];
}
[[nodiscard]] constexpr std::string_view to_string(Mode mode) noexcept {
  return kModeNames[static_cast<std::size_t>(mode)];
}
[[nodiscard]] constexpr std::string_view to_string(Objective objective) noexcept {
  return kObjectiveNames[static_cast<std::size_t>(objective)];
}
[[nodiscard]] constexpr std::string_view to_string(Event event) noexcept {
  return kEventNames[static_cast<std::size_t>(event)];
}

/// The word's value in one of the tables above; exact, case matters.
template <class Word, std::size_t size>
[[nodiscard]] constexpr std::optional<Word> find_word(
    const std::array<std::string_view, size>& names, std::string_view word) noexcept {
  for (std::size_t i = 0; i < size; ++i) {
    if (names[i] == word) return static_cast<Word>(i);
  }
  return std::nullopt;
}

}  // namespace armjig::kinovazed
