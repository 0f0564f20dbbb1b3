// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <chrono>
#include <string>

#include "cli/devices/machines.hpp"
#include "harness/wire/kinovazed/line.hpp"

namespace armjig::kinovazed {
namespace {

using namespace std::chrono_literals;
using campaign::AbstractLetter;
using campaign::Acts;
using mealy::Row;

/// A reply comes when the arm was stopped, which takes three calls with pauses of 10 ms and what
/// the poll takes. settingMode is over by itself after half a second, so words may have few letters
/// there.
constexpr Duration kLetter = 60ms;
/// The slowest arm homes and folds in that time.
constexpr Duration kQuiet = 8s;

// What Kinova calls the retraction mode of an arm that is neither ready nor folded, and a height
// that no way-point of the objective has, in micrometres.
constexpr std::int64_t kElsewhere = 5;
constexpr std::int64_t kHeight = 300'000;

template <const auto& line>
void say(Acts& acts) {
  acts.send_line(line);
  acts.wait(kLetter);
}
template <const auto& line>
constexpr AbstractLetter letter(std::string_view name) {
  return {name, say<line>};
}

/// A program that was told to do it by hand may be done before the device has it.
constexpr Duration kHand = 200ms;

void hold(Acts& acts) {
  acts.set("arm.held", 1);
  acts.wait(kHand);
}
void put_elsewhere(Acts& acts) {
  acts.set("arm.held", 1);
  acts.set("arm.mode", kElsewhere);
  acts.set("arm.at.z", kHeight);
  acts.wait(kHand);
}
/// Somebody holds the arm but when it may move, and puts it elsewhere afterwards. So whatever is
/// asked of it takes time, and there is a state of the server for that.
void let_it_move(Acts& acts) {
  acts.set("arm.held", 0);
  acts.wait_until_quiet();
  put_elsewhere(acts);
}
void stop(Acts& acts) {
  acts.send_line("EStop");
  acts.wait(kLetter);
  put_elsewhere(acts);
}

constexpr std::string_view kEStop = "EStop";
constexpr std::string_view kQuitEStop = "QuitEStop";
constexpr std::string_view kInitialize = "Initialize";
constexpr std::string_view kUnfold = "Unfold";
constexpr std::string_view kRetract = "Retract";
constexpr std::string_view kFreeze = "Freeze";
constexpr std::string_view kUnfreeze = "Unfreeze";
constexpr std::string_view kXyz = "SetJoystickMode:XYZ";
constexpr std::string_view kNoMode = "SetJoystickMode:NoMode";
constexpr std::string_view kMove = "MoveJoystick:0:0:0";
constexpr std::string_view kRun = "RunObjective:Home";

constexpr std::array kLetters{letter<kEStop>("EStop"),
                              letter<kQuitEStop>("QuitEStop"),
                              letter<kInitialize>("Initialize"),
                              letter<kUnfold>("Unfold"),
                              letter<kRetract>("Retract"),
                              letter<kFreeze>("Freeze"),
                              letter<kUnfreeze>("Unfreeze"),
                              letter<kXyz>("SetJoystickMode XYZ"),
                              letter<kNoMode>("SetJoystickMode NoMode"),
                              letter<kMove>("MoveJoystick"),
                              letter<kRun>("RunObjective"),
                              AbstractLetter{"quiet", let_it_move}};

bool is_reply(const Message& message) {
  return message.name == "Accepted" || message.name == "Rejected";
}

/// Replies, then events: which comes first, if both come at once, is not said
/// (kinovazed.reply.race). When a heartbeat comes depends on when it is asked.
std::string said(std::span<const Message> messages) {
  std::string replies;
  std::string events;
  for (const auto& message : messages) {
    if (message.name == kHeartbeatName) continue;
    auto& list = is_reply(message) ? replies : events;
    if (!list.empty()) list += ", ";
    list += message.fault.empty() ? message.name : "noise";
  }
  if (replies.empty() || events.empty()) return replies + events;
  return replies + ", " + events;
}

/// docs/spec/kinovazed.md, "States" and "Interrupts and ends".
constexpr std::array kRows{
    Row{"", "EStop", "Accepted", "emergencyStopped"},
    Row{"emergencyStopped", "QuitEStop", "Accepted", "poweredOff"},
    Row{"poweredOff", "QuitEStop", "Accepted", ""},
    Row{"poweredOff", "Initialize", "Accepted", "initializing"},
    Row{"initializing", "quiet", "Initialized", "idle"},
    Row{"idle", "Initialize", "Accepted", "initializing"},
    Row{"idle", "Retract", "Accepted", "retracting"},
    Row{"idle", "Freeze", "Accepted, Freezed", "frozen"},
    Row{"idle", "SetJoystickMode XYZ", "Accepted", "settingMode"},
    Row{"idle", "SetJoystickMode NoMode", "Accepted, JoystickModeSet", "idle"},
    Row{"idle", "RunObjective", "Accepted", "runningSequence"},
    Row{"retracting", "quiet", "Retracted", "retracted"},
    Row{"retracted", "Unfold", "Accepted", "unfolding"},
    Row{"unfolding", "quiet", "Unfolded", "idle"},
    Row{"settingMode", "Retract", "Accepted", "retracting"},
    Row{"settingMode", "quiet", "JoystickModeSet", "steering"},
    Row{"steering", "Freeze", "Accepted, Freezed", "frozen"},
    Row{"steering", "SetJoystickMode XYZ", "Accepted", "settingMode"},
    Row{"steering", "SetJoystickMode NoMode", "Accepted, JoystickModeSet", "idle"},
    Row{"steering", "MoveJoystick", "Accepted", ""},
    Row{"steering", "RunObjective", "Accepted", "runningSequence"},
    Row{"runningSequence", "SetJoystickMode XYZ", "Accepted", "settingMode"},
    Row{"runningSequence", "SetJoystickMode NoMode", "Accepted, JoystickModeSet", "idle"},
    Row{"runningSequence", "RunObjective", "Accepted", ""},
    Row{"runningSequence", "quiet", "ObjectiveDone", "idle"},
    Row{"frozen", "Unfreeze", "Accepted, Unfreezed", "idle"},
    Row{"", "quiet", "", ""},
    Row{"", "", "Rejected", ""},
};
constexpr std::array kTables{mealy::Table{"emergencyStopped", kRows}};

}  // namespace

std::span<const campaign::Learnable> machines() {
  static const std::array kMachines{
      campaign::Learnable{.name = "server",
                          .letters = kLetters,
                          .said = said,
                          .is_reply = is_reply,
                          .quiet = kQuiet,
                          .documented = kTables,
                          .source = "docs/spec/kinovazed.md, States, Interrupts and ends",
                          .begin = hold,
                          .reset = stop}};
  return kMachines;
}

}  // namespace armjig::kinovazed
