// SPDX-License-Identifier: Apache-2.0
#include "cli/kinovazed_console.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <utility>

#include "cli/kinovazed_view.hpp"
#include "cli/parol6_arguments.hpp"
#include "emulators/host/emulated_session.hpp"

namespace armjig::cli {
namespace {

using namespace kinovazed;
using namespace std::chrono_literals;

constexpr Duration kPeriod = 10ms;
/// Well within the watchdog of the drive, and what a real server can follow.
constexpr Duration kRenewal = 200ms;

double seconds(Duration duration) { return std::chrono::duration<double>{duration}.count(); }

Parsed<std::int32_t> parse_deflection(std::string_view text) {
  std::int32_t value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size()) return value;
  return tl::unexpected{fmt::format("'{}' is no deflection: a whole number, 400 is full", text)};
}

template <std::size_t size>
std::string listed(const std::array<std::string_view, size>& names) {
  std::string text;
  for (const auto name : names) text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
  return text;
}

}  // namespace

std::span<const KinovaConsole::Row> KinovaConsole::rows() noexcept {
  using Self = KinovaConsole;
  constexpr auto kAlways = When::kAlways;
  constexpr auto kAlone = When::kAlone;
  static constexpr std::string_view kModes = "NoMode XYZ Rotation Axis1to3 Axis4to6";
  static constexpr std::string_view kObjectives =
      "Current Home Handle OpenDoor PullDoor SuckDoor Antenna FindBottle PlaceBottle";
  static constexpr std::array kRows{
      Row{"help", "[COMMAND]", "what there is", kAlways, &Self::help, ""},
      Row{"status", "", "what the last beat says, and what goes on", kAlways, &Self::status, ""},
      Row{"estop", "", "emergency stop, in any state", kAlways, &Self::plain<Verb::kEStop>, ""},
      Row{"quitestop", "", "end the emergency stop; then 'initialize'", kAlone,
          &Self::plain<Verb::kQuitEStop>, ""},
      Row{"initialize", "", "drive to the ready pose", kAlone, &Self::plain<Verb::kInitialize>, ""},
      Row{"retract", "", "fold the arm", kAlone, &Self::plain<Verb::kRetract>, ""},
      Row{"unfold", "", "the other way, to the ready pose", kAlone, &Self::plain<Verb::kUnfold>,
          ""},
      Row{"freeze", "", "hold still and refuse all that moves", kAlone, &Self::plain<Verb::kFreeze>,
          ""},
      Row{"unfreeze", "", "end of it; the joystick mode is lost", kAlone,
          &Self::plain<Verb::kUnfreeze>, ""},
      Row{"mode", "MODE", "what the joystick does; ends an objective", kAlone, &Self::mode, kModes},
      Row{"move", "X Y Z [SECONDS]", "hold the joystick until 'stop'; 400 is full deflection",
          kAlone, &Self::move, ""},
      Row{"run", "OBJECTIVE", "drive through its way-points", kAlone,
          &Self::objective<Verb::kRunObjective>, kObjectives},
      Row{"stop", "", "make the arm stand, whatever it does", kAlways, &Self::stop_arm, ""},
      Row{"activate", "OBJECTIVE", "whose frame 'position objective' means", kAlone,
          &Self::objective<Verb::kSetActiveObjective>, kObjectives},
      Row{"position", "[objective]", "the server writes it to its log", kAlone, &Self::position,
          "objective"},
      Row{"wait", "SECONDS", "do nothing for a time", kAlone, &Self::wait, ""},
      Row{"quit", "", "make the arm stand and leave; so does exit", kAlways, &Self::quit, ""},
  };
  return kRows;
}

KinovaConsole::KinovaConsole(ServerRig rig, std::string target, const DriveOptions& options,
                             Say say)
    : rig_{std::move(rig)},
      target_{std::move(target)},
      say_{std::move(say)},
      client_{rig_.port(), options} {}

Outcome<void> KinovaConsole::cycle() {
  renew_stick();
  if (wait_until_ && now() >= *wait_until_) wait_until_.reset();
  if (const auto polled = client_.poll(now() + kPeriod); !polled) {
    return problem(polled.error().code, target_, "is the server running?");
  }
  for (const auto& event : client_.take_events()) take(event);
  return {};
}

void KinovaConsole::begin(std::string_view line) {
  const auto going_on = !is_busy() ? "" : asked_ ? asked_->name : wait_until_ ? "wait" : "move";
  run_command(*this, rows(), line, going_on,
              [this](Tone tone, std::string_view text) { say_(tone, text); });
}

void KinovaConsole::stop() {
  if (asked_) say_(Tone::kEvent, asked_->name + " is ended");
  asked_.reset();
  wait_until_.reset();
  steering_.reset();
  if (client_.drive().under_way()) {
    auto ended = client_.cancel();
    // Its reply has not come yet: that cannot be waited for.
    if (!ended) ended = client_.begin({.verb = Verb::kEStop});
    return follow("stop", ended ? Result<RequestId>{**ended} : tl::unexpected{ended.error()});
  }
  if (client_.drive().is_stick_deflected()) return ask("stop", {.verb = Verb::kMoveJoystick});
  say_(Tone::kAnswer, "nothing moves");
}

std::string KinovaConsole::occupation() {
  if (client_.drive().is_silent()) return "silent";
  if (steering_) return "move";
  if (wait_until_) return "wait";
  if (asked_) {
    const auto time = std::chrono::floor<std::chrono::seconds>(now() - asked_->since).count();
    return time == 0 ? asked_->name : fmt::format("{} {} s", asked_->name, time);
  }
  return hears_the_device() ? state_of(*client_.drive().heartbeat()) : "no beat yet";
}

// What goes on.

void KinovaConsole::ask(std::string_view name, const Command& command) {
  follow(name, client_.begin(command));
}

void KinovaConsole::follow(std::string_view name, const Result<RequestId>& id) {
  if (id) {
    asked_ = Asked{*id, std::string{name}, now()};
    return;
  }
  steering_.reset();
  const auto refusal = rig_.last_refusal();
  if (id.error().code == ErrorCode::kForbidden && refusal) {
    return say_(Tone::kFailed, "refused: " + refusal->reason);
  }
  const auto* const hint = id.error().code == ErrorCode::kBusy
                               ? "; the server needs a little time between two of them"
                               : "";
  say_(Tone::kFailed, fmt::format("{}: {}{}", name, describe(id.error().code), hint));
}

void KinovaConsole::renew_stick() {
  if (!steering_ || asked_) return;
  if (steering_->time && !steering_->until) steering_->until = now() + *steering_->time;
  if (steering_->until && now() >= *steering_->until) {
    steering_.reset();
    return ask("move", {.verb = Verb::kMoveJoystick});
  }
  if (now() < steering_->renew || client_.drive().awaits_reply()) return;
  steering_->renew = now() + kRenewal;
  (void)client_.begin({.verb = Verb::kMoveJoystick, .deflection = steering_->deflection});
}

void KinovaConsole::take(const DriveEvent& event) {
  if (event.kind == DriveEvent::Kind::kEnded) return take_ending(event);
  say_(Tone::kEvent, describe(event));
}

void KinovaConsole::take_ending(const DriveEvent& event) {
  const bool is_done = event.ending == Ending::kDone;
  if (!asked_ || event.request != asked_->id) {
    const bool is_renewal = steering_ && event.command.verb == Verb::kMoveJoystick;
    if (is_renewal && !is_done) {
      steering_.reset();
      say_(Tone::kFailed, describe(event));
    }
    return;
  }
  // What nobody answers ends as it is sent, and that is in front of `since`.
  const auto time = std::max(event.time - asked_->since, Duration::zero());
  asked_.reset();
  if (!is_done) steering_.reset();
  say_(is_done ? Tone::kAnswer : Tone::kFailed,
       fmt::format("{} ({:.3f} s)", describe(event), seconds(time)));
}

// The commands.

Read KinovaConsole::help(Words words) {
  if (words.size() > 1) return wrong("");
  const auto text = help_text(rows(), words.empty() ? std::string_view{} : words.front());
  if (text.empty()) return wrong(fmt::format("there is no command '{}'", words.front()));
  say_(Tone::kAnswer, text);
  return {};
}

Read KinovaConsole::status(Words words) {
  if (!words.empty()) return wrong("");
  const auto& drive = client_.drive();
  if (!drive.heartbeat()) {
    say_(Tone::kFailed, "no beat yet");
    return {};
  }
  auto text = fmt::format("state      {}\nbeat       {}\njoystick   {}",
                          state_of(*drive.heartbeat()), flags_of(*drive.heartbeat()),
                          drive.is_stick_deflected() ? "deflected" : "at rest");
  if (const auto command = drive.under_way()) {
    text += fmt::format("\nunder way  {}", to_string(command->verb));
  }
  if (const auto impairments = rig_.impairments()) {
    text += "\nimpaired   " + to_string(*impairments);
  }
  say_(Tone::kAnswer, text);
  return {};
}

template <Verb verb>
Read KinovaConsole::plain(Words words) {
  if (!words.empty()) return wrong("");
  steering_.reset();
  ask(to_string(verb), {.verb = verb});
  return {};
}

Read KinovaConsole::mode(Words words) {
  if (words.size() != 1) return wrong("");
  const auto mode = find_word<Mode>(kModeNames, words[0]);
  if (!mode) {
    return wrong(fmt::format("'{}' is none of {}", words[0], listed(kModeNames)));
  }
  steering_.reset();
  ask("mode", {.verb = Verb::kSetJoystickMode, .mode = *mode});
  return {};
}

Read KinovaConsole::move(Words words) {
  if (words.size() != 3 && words.size() != 4) return wrong("");
  std::array<std::int32_t, 3> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = parse_deflection(words[i]);
    if (!number) return wrong(number.error());
    numbers[i] = *number;
  }
  std::optional<Duration> time;
  if (words.size() == 4) {
    const auto parsed = parse_seconds(words[3]);
    if (!parsed) return wrong(parsed.error());
    time = *parsed;
  }
  const Deflection deflection{numbers[0], numbers[1], numbers[2]};
  steering_.reset();
  if (deflection != Deflection{}) steering_ = Steering{deflection, now() + kRenewal, time, {}};
  ask("move", {.verb = Verb::kMoveJoystick, .deflection = deflection});
  return {};
}

template <Verb verb>
Read KinovaConsole::objective(Words words) {
  if (words.size() != 1) return wrong("");
  const auto objective = find_word<Objective>(kObjectiveNames, words[0]);
  if (!objective) {
    return wrong(fmt::format("'{}' is none of {}", words[0], listed(kObjectiveNames)));
  }
  steering_.reset();
  ask(verb == Verb::kRunObjective ? "run" : "activate", {.verb = verb, .objective = *objective});
  return {};
}

Read KinovaConsole::position(Words words) {
  const bool is_objective = words.size() == 1 && words[0] == "objective";
  if (!words.empty() && !is_objective) return wrong("");
  ask("position",
      {.verb = is_objective ? Verb::kGetObjectivePosition : Verb::kGetAbsolutePosition});
  return {};
}

Read KinovaConsole::stop_arm(Words words) {
  if (!words.empty()) return wrong("");
  stop();
  return {};
}

Read KinovaConsole::wait(Words words) {
  if (words.size() != 1) return wrong("");
  const auto time = parse_seconds(words[0]);
  if (!time) return wrong(time.error());
  wait_until_ = now() + *time;
  return {};
}

Read KinovaConsole::quit(Words words) {
  if (!words.empty()) return wrong("");
  wants_to_quit_ = true;
  return {};
}

Outcome<std::unique_ptr<DeviceConsole>> open_kinova_console(const RigOptions& how,
                                                            const std::string& target, Say say) {
  auto rig = ServerRig::open("kinovazed", how, open_kinovazed_session);
  if (!rig) return tl::unexpected{rig.error()};
  DriveOptions options;
  const auto profile = how.target.options.find("profile");
  if (profile != how.target.options.end() && profile->second == "documented") {
    options.profile = Profile::kDocumented;
  }
  return std::make_unique<KinovaConsole>(*std::move(rig), target, options, std::move(say));
}

}  // namespace armjig::cli
