// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/kinovazed/fields.hpp"

#include <array>
#include <string_view>

namespace armjig::kinovazed {
namespace {

template <std::size_t size>
consteval std::array<NamedValue, size> numbered(const std::array<std::string_view, size>& names) {
  std::array<NamedValue, size> values{};
  for (std::size_t i = 0; i < size; ++i) values[i] = {static_cast<std::int64_t>(i), names[i]};
  return values;
}

constexpr auto kVerbs = numbered(kVerbNames);
constexpr auto kModes = numbered(kModeNames);
constexpr auto kObjectives = numbered(kObjectiveNames);
constexpr auto kEvents = numbered(kEventNames);
constexpr std::array<NamedValue, 1> kHeartbeats{{{0, kHeartbeatName}}};
constexpr std::array<std::string_view, 8> kBeatBits{
    "isRetracted", "isInJoystickMode", "isRunningObjective", "isIdle",
    "isFreezed",   "isInitialized",    "hasEmergencyStop",   "isConnected"};

consteval Field word(std::string_view name, std::uint16_t piece, std::string_view meaning,
                     std::span<const NamedValue> values) {
  return {name, piece, 0, Encoding::kCode, "", meaning, {}, values, 0, Place::kPiece};
}
consteval Field deflection(std::string_view name, std::uint16_t piece, std::string_view meaning) {
  return {name, piece, 0, Encoding::kSigned, "", meaning, {}, {}, 0, Place::kPiece};
}

constexpr Field kCommandWord = word("command", 0, "what to do", kVerbs);
constexpr std::array kPlain{kCommandWord};
constexpr std::array kWithMode{kCommandWord, word("mode", 1, "what the joystick moves", kModes)};
constexpr std::array kWithObjective{kCommandWord,
                                    word("objective", 1, "a list of way-points", kObjectives)};
constexpr std::array kWithDeflection{
    kCommandWord, deflection("x", 1, "to the right, or about the first axis; 400 is full"),
    deflection("y", 2, "to the front, or about the second axis; 400 is full"),
    deflection("z", 3, "up, or about the third axis; 400 is full")};
constexpr std::array kEvent{word("event", 0, "an answer, or what has happened", kEvents)};
constexpr std::array kHeartbeat{word("message", 0, "once a second", kHeartbeats),
                                Field{"state",
                                      1,
                                      0,
                                      Encoding::kBits,
                                      "",
                                      "of the server and its arm",
                                      kBeatBits,
                                      {},
                                      0,
                                      Place::kPiece}};

}  // namespace

std::span<const Field> command_fields(Verb verb) noexcept {
  switch (verb) {
    case Verb::kSetJoystickMode:
      return kWithMode;
    case Verb::kRunObjective:
    case Verb::kSetActiveObjective:
      return kWithObjective;
    case Verb::kMoveJoystick:
      return kWithDeflection;
    default:
      return kPlain;
  }
}

std::span<const Field> event_fields() noexcept { return kEvent; }
std::span<const Field> heartbeat_fields() noexcept { return kHeartbeat; }

}  // namespace armjig::kinovazed
