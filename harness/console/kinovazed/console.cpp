// SPDX-License-Identifier: Apache-2.0
#include "harness/console/kinovazed/console.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <utility>

#include "harness/console/kinovazed/view.hpp"
#include "harness/core/number.hpp"
#include "harness/drive/kinovazed/client.hpp"

namespace armjig::kinovazed::console {

using namespace drive;

namespace {

using namespace std::chrono_literals;

constexpr Duration kPeriod = 10ms;
/// Well within the watchdog of the drive, and what a real server can follow.
constexpr Duration kRenewal = 200ms;

template <std::size_t size>
std::string listed(const std::array<std::string_view, size>& names) {
  std::string text;
  for (const auto name : names) text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
  return text;
}

class Console final : public DeviceConsole {
 public:
  Console(Rig<SessionSource> rig, const std::string& target, const DriveOptions& options, Say say)
      : DeviceConsole{rows(),
                      target,
                      std::move(say),
                      {patience::kBeat,
                       "no beat came: is it a KinovaZED server, and serves it nobody else?"}},
        rig_{std::move(rig)},
        port_{rig_.port().make_port()},
        client_{*port_, options} {}

  std::string occupation() override;
  Instant now() override { return port_->now(); }

 private:
  static std::span<const Row> rows() noexcept;

  Outcome<void> exchange() override;
  bool hears_the_device() const override { return client_.drive().heartbeat().has_value(); }
  Parsed<std::string> state() override;
  /// Lets the stick go; ends an objective by a change of mode, any other motion by an EStop.
  void stand() override;

  // The commands.
  template <Verb verb>
  void plain() {
    steering_.reset();
    ask(to_string(verb), {.verb = verb});
  }
  Read mode(Words words);
  Read move(Words words);
  template <Verb verb>
  Read objective(Words words);
  Read position(Words words);

  /// A deflected stick, which has to be renewed.
  struct Steering {
    Deflection deflection;
    Instant renew{};
    std::optional<Duration> time;  ///< once it has begun
    std::optional<Instant> until;  ///< none: until something else is said
  };

  void ask(std::string_view name, const Command& command) { follow(name, client_.begin(command)); }
  void follow(std::string_view name, const Result<RequestId>& id);
  void renew_stick();
  void take_ending(const DriveEvent& event);

  Rig<SessionSource> rig_;
  std::unique_ptr<SessionPort> port_;
  Client client_;
  std::optional<RequestId> asked_;  ///< what goes on is its answer's
  std::optional<Steering> steering_;
};

std::span<const DeviceConsole::Row> Console::rows() noexcept {
  using Self = Console;
  static constexpr std::string_view kModes = "NoMode XYZ Rotation Axis1to3 Axis4to6";
  static constexpr std::string_view kObjectives =
      "Current Home Handle OpenDoor PullDoor SuckDoor Antenna FindBottle PlaceBottle";
  static constexpr std::array kRows{
      Row{"estop", "", "emergency stop, in any state", kAlways, run<&Self::plain<Verb::kEStop>>,
          ""},
      Row{"quitestop", "", "end the emergency stop; then 'initialize'", kAlone,
          run<&Self::plain<Verb::kQuitEStop>>, ""},
      Row{"initialize", "", "drive to the ready pose", kAlone, run<&Self::plain<Verb::kInitialize>>,
          ""},
      Row{"retract", "", "fold the arm", kAlone, run<&Self::plain<Verb::kRetract>>, ""},
      Row{"unfold", "", "the other way, to the ready pose", kAlone,
          run<&Self::plain<Verb::kUnfold>>, ""},
      Row{"freeze", "", "hold still and refuse all that moves", kAlone,
          run<&Self::plain<Verb::kFreeze>>, ""},
      Row{"unfreeze", "", "end of it; the joystick mode is lost", kAlone,
          run<&Self::plain<Verb::kUnfreeze>>, ""},
      Row{"mode", "MODE", "what the joystick does; ends an objective", kAlone, run<&Self::mode>,
          kModes},
      Row{"move", "X Y Z [SECONDS]", "hold the joystick until 'stop'; 400 is full deflection",
          kAlone, run<&Self::move>, ""},
      Row{"run", "OBJECTIVE", "drive through its way-points", kAlone,
          run<&Self::objective<Verb::kRunObjective>>, kObjectives},
      Row{"activate", "OBJECTIVE", "whose frame 'position objective' means", kAlone,
          run<&Self::objective<Verb::kSetActiveObjective>>, kObjectives},
      Row{"position", "[objective]", "the server writes it to its log", kAlone,
          run<&Self::position>, "objective"},
  };
  return kRows;
}

std::string Console::occupation() {
  if (client_.drive().is_silent()) return "silent";
  if (steering_) return "move";
  if (is_busy()) return going_on();
  return hears_the_device() ? state_of(*client_.drive().heartbeat()) : "no beat yet";
}

Outcome<void> Console::exchange() {
  renew_stick();
  if (const auto polled = client_.poll(now() + kPeriod); !polled) {
    return gone(polled.error().code, "is the server running?");
  }
  for (const auto& event : client_.take_events()) {
    if (event.kind == DriveEvent::Kind::kEnded) {
      take_ending(event);
    } else {
      say(Tone::kEvent, describe(event));
    }
  }
  return {};
}

Parsed<std::string> Console::state() {
  const auto& drive = client_.drive();
  if (!drive.heartbeat()) return wrong("no beat yet");
  auto text = fmt::format("state      {}\nbeat       {}\njoystick   {}",
                          state_of(*drive.heartbeat()), flags_of(*drive.heartbeat()),
                          drive.is_stick_deflected() ? "deflected" : "at rest");
  if (const auto command = drive.under_way()) {
    text += fmt::format("\nunder way  {}", to_string(command->verb));
  }
  if (const auto impairments = rig_.impairments()) {
    text += "\nimpaired   " + to_string(*impairments);
  }
  return text;
}

void Console::stand() {
  asked_.reset();
  steering_.reset();
  if (client_.drive().under_way()) {
    auto ended = client_.cancel();
    // Its reply has not come yet: that cannot be waited for.
    if (!ended) ended = client_.begin({.verb = Verb::kEStop});
    return follow("stop", ended ? Result<RequestId>{**ended} : tl::unexpected{ended.error()});
  }
  if (client_.drive().is_stick_deflected()) return ask("stop", {.verb = Verb::kMoveJoystick});
  say(Tone::kAnswer, "nothing moves");
}

// What goes on.

void Console::follow(std::string_view name, const Result<RequestId>& id) {
  if (id) {
    go_on(name);
    asked_ = *id;
    return;
  }
  steering_.reset();
  const auto refusal = rig_.last_refusal();
  if (id.error().code == ErrorCode::kForbidden && refusal) {
    return say(Tone::kFailed, "refused: " + refusal->reason);
  }
  const auto* const hint = id.error().code == ErrorCode::kBusy
                               ? "; the server needs a little time between two of them"
                               : "";
  say(Tone::kFailed, fmt::format("{}: {}{}", name, describe(id.error().code), hint));
}

void Console::renew_stick() {
  if (!steering_ || asked_) return;
  if (steering_->time && !steering_->until) steering_->until = now() + *steering_->time;
  if (steering_->until && now() >= *steering_->until) {
    steering_.reset();
    end();
    return ask("move", {.verb = Verb::kMoveJoystick});
  }
  if (now() < steering_->renew || client_.drive().awaits_reply()) return;
  steering_->renew = now() + kRenewal;
  (void)client_.begin({.verb = Verb::kMoveJoystick, .deflection = steering_->deflection});
}

void Console::take_ending(const DriveEvent& event) {
  const bool is_done = event.ending == Ending::kDone;
  if (!asked_ || event.request != *asked_) {
    const bool is_renewal = steering_ && event.command.verb == Verb::kMoveJoystick;
    if (is_renewal && !is_done) {
      if (steering_->time) end();
      steering_.reset();
      say(Tone::kFailed, describe(event));
    }
    return;
  }
  // What nobody answers ends as it is sent, and that is before it went on.
  const auto time = std::max(event.time - began(), Duration::zero());
  asked_.reset();
  if (!is_done) steering_.reset();
  if (!steering_ || !steering_->time) end();
  say(is_done ? Tone::kAnswer : Tone::kFailed,
      fmt::format("{} ({:.3f} s)", describe(event), std::chrono::duration<double>{time}.count()));
}

// The commands.

DeviceConsole::Read Console::mode(Words words) {
  const auto mode = find_word<Mode>(kModeNames, words[0]);
  if (!mode) return wrong(fmt::format("'{}' is none of {}", words[0], listed(kModeNames)));
  steering_.reset();
  ask("mode", {.verb = Verb::kSetJoystickMode, .mode = *mode});
  return {};
}

DeviceConsole::Read Console::move(Words words) {
  std::array<std::int32_t, 3> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = whole_text_as<std::int32_t>(words[i]);
    if (!number) {
      return wrong(fmt::format("'{}' is no deflection: a whole number, 400 is full", words[i]));
    }
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
DeviceConsole::Read Console::objective(Words words) {
  const auto objective = find_word<Objective>(kObjectiveNames, words[0]);
  if (!objective) {
    return wrong(fmt::format("'{}' is none of {}", words[0], listed(kObjectiveNames)));
  }
  steering_.reset();
  ask(verb == Verb::kRunObjective ? "run" : "activate", {.verb = verb, .objective = *objective});
  return {};
}

DeviceConsole::Read Console::position(Words words) {
  if (!words.empty() && words[0] != "objective") return wrong("");
  ask("position",
      {.verb = words.empty() ? Verb::kGetAbsolutePosition : Verb::kGetObjectivePosition});
  return {};
}

}  // namespace

Outcome<std::unique_ptr<DeviceConsole>> open(Rig<SessionSource> rig, const std::string& target,
                                             Say say) {
  DriveOptions options;
  const auto parsed = parse_target(target);
  if (!parsed) return tl::unexpected{parsed.error()};
  const auto profile = parsed->options.find("profile");
  if (profile != parsed->options.end() && profile->second == "documented") {
    options.profile = Profile::kDocumented;
  }
  return std::make_unique<Console>(std::move(rig), target, options, std::move(say));
}

}  // namespace armjig::kinovazed::console
