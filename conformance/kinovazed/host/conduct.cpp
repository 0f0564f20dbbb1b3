// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/host/conduct.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "conformance/kinovazed/host/occasions.hpp"
#include "conformance/kinovazed/laws.hpp"
#include "harness/drive/kinovazed/drive.hpp"

namespace armjig::kinovazed::programs {
namespace {

using namespace conformance;
using namespace std::chrono_literals;
using enum State;

/// In which a server answers (kinovazed.time.answer).
constexpr Duration kAnswer = 500ms;
constexpr Duration kSilence = 3s;
/// In which a program has to see what a heartbeat shows.
constexpr Duration kReaction = 100ms;
constexpr Duration kLongestObjective = 60s;
constexpr Duration kMovesWindow = 1s;
/// Moves in such a window at 17 in a second, with one at each end.
constexpr std::size_t kMostMoves = 18;

bool is_deflection(const Command& command) noexcept {
  return command.verb == Verb::kMoveJoystick && command.deflection != Deflection{};
}

bool is_motion(State state) noexcept {
  return state == kInitializing || state == kRetracting || state == kUnfolding ||
         state == kRunningSequence;
}

/// The requirement that a command breaks that the state does not allow.
std::string_view requirement_of(State state, Verb verb, bool is_stop_unasked) noexcept {
  switch (state) {
    case kEmergencyStopped:
      return is_stop_unasked ? "kinovazed.host.sees-stop" : "kinovazed.host.initialize-first";
    case kPoweredOff:
      return "kinovazed.host.initialize-first";
    case kInitializing:
    case kRetracting:
    case kUnfolding:
      return "kinovazed.host.waits-for-event";
    case kSettingMode:
      return "kinovazed.host.mode-settles";
    case kRetracted:
      return "kinovazed.host.unfold-first";
    case kFrozen:
      return "kinovazed.host.unfreeze-first";
    case kSteering:
      return "kinovazed.host.steering-exit";
    case kRunningSequence:
      return "kinovazed.host.objective-runs";
    case kIdle:
      break;
  }
  return verb == Verb::kMoveJoystick ? "kinovazed.host.stick-mode"
                                     : "kinovazed.host.nothing-to-undo";
}

}  // namespace

void Conduct::begin(Instant time) noexcept {
  end();
  heard_ = time;
}

/// What the server's machine keeps it keeps: when a mode was set, and that an objective was chosen.
void Conduct::end() noexcept {
  requests_.clear();
  overtaken_.reset();
  moves_.clear();
  enter({}, std::nullopt);
  led_here_.reset();
  has_looked_ = is_silence_told_ = is_stop_unasked_ = is_deflected_ = false;
}

void Conduct::enter(Instant time, std::optional<State> state) noexcept {
  if (state == state_) return;
  before_until_ = {};
  state_ = state;
  entered_ = time;
  is_stop_unasked_ = is_patience_told_ = false;
  if (state_ && state_ != kSteering) is_deflected_ = false;
}

bool Conduct::is_silent(Instant time) const noexcept { return time - heard_ > kSilence + noise_; }

void Conduct::command(Instant time, const Command& command, const Complain& complain_now) {
  const auto complain = complain_now.resting_on({.since = time});
  give_up_waiting(time);
  note_occasions(time, command, complain);
  const bool is_estop = command.verb == Verb::kEStop;
  if (!is_estop && is_silent(time) && !std::exchange(is_silence_told_, true)) {
    complain("kinovazed.host.silent-server",
             fmt::format("{} came after {:.0f} ms without a message", to_string(command.verb),
                         milliseconds(time - heard_)));
  }
  if (!std::exchange(has_looked_, true) && !is_estop) {
    complain("kinovazed.host.looks-first", fmt::format("{} came first", to_string(command.verb)));
  }
  judge_turn(command, complain);
  if (requests_.empty()) judge_state(time, command, complain);
  judge_joystick(time, command, complain);
  judge_objective(command, complain);
  if (is_answered(command.verb)) requests_.push_back({.command = command, .sent = time});
}

void Conduct::note_occasions(Instant time, const Command& command, const Complain& complain) const {
  const auto note = [&complain](bool is_one, std::string_view what) {
    if (is_one) complain.occasion(what);
  };
  const auto verb = command.verb;
  note(is_silent(time), occasion::kSilence);
  note(verb == Verb::kEStop, occasion::kEstop);
  note(verb == Verb::kMoveJoystick, occasion::kJoystick);
  note(verb == Verb::kSetJoystickMode, occasion::kMode);
  note(is_steering_mode(command) && mode_set_, occasion::kTwoModes);
  note(names_objective(verb), occasion::kObjective);
  note(verb == Verb::kSetActiveObjective, occasion::kActiveObjective);
  note(verb == Verb::kGetObjectivePosition, occasion::kObjectivePosition);
}

/// Whether the documents let it come before the answers that are still to come.
bool Conduct::may_overtake(const Command& command) const noexcept {
  if (command.verb == Verb::kEStop || is_stick_at_rest(command)) return true;
  return command.verb == Verb::kSetJoystickMode &&
         requests_.back().command.verb == Verb::kRunObjective;
}

void Conduct::judge_turn(const Command& command, const Complain& complain) const {
  if (requests_.empty()) return;
  const auto is_estop = [](const Request& request) { return request.command.verb == Verb::kEStop; };
  if (command.verb == Verb::kEStop && std::ranges::any_of(requests_, is_estop)) {
    complain("kinovazed.host.estop-once", "EStop came again");
  } else if (!may_overtake(command)) {
    complain("kinovazed.host.one-at-a-time",
             fmt::format("{} came, and {} was not answered yet", to_string(command.verb),
                         to_string(requests_.back().command.verb)));
  }
}

/// A command that led to where the server rests may come again: the document has it answered.
bool Conduct::is_allowed(Instant time, Verb verb) const noexcept {
  const bool recurs = led_here_ == verb && !is_motion(*state_) && state_ != kSettingMode;
  if (is_accepted(*state_, verb) || recurs) return true;
  return time < before_until_ && (!before_ || is_accepted(*before_, verb));
}

void Conduct::judge_state(Instant time, const Command& command, const Complain& complain) const {
  const auto verb = command.verb;
  if (!state_ || !is_answered(verb) || is_allowed(time, verb)) return;
  complain(requirement_of(*state_, verb, is_stop_unasked_),
           fmt::format("{} came in state {}", to_string(verb), to_string(*state_)));
}

void Conduct::judge_joystick(Instant time, const Command& command, const Complain& complain) {
  if (command.verb == Verb::kMoveJoystick) {
    moves_.push_back(time);
    if (moves_.size() > kMostMoves) {
      const auto span = time - moves_.front();
      moves_.pop_front();
      if (span + noise_ < kMovesWindow) {
        moves_.clear();
        complain("kinovazed.host.stick-pace",
                 fmt::format("{} moves came in {:.0f} ms", kMostMoves + 1, milliseconds(span)),
                 {.since = time - span});
      }
    }
  }
  is_deflected_ = is_deflection(command) || (is_deflected_ && !is_stick_at_rest(command));
  if (command.verb == Verb::kSetJoystickMode) mode_ = command.mode;
  if (!is_steering_mode(command)) return;
  const bool can_be_taken = requests_.empty() && state_ && is_allowed(time, command.verb);
  if (can_be_taken && mode_set_ && time - *mode_set_ + noise_ < kModePause) {
    complain("kinovazed.host.mode-pause",
             fmt::format("{} came {:.0f} ms after another mode", to_string(command.mode),
                         milliseconds(time - *mode_set_)),
             {.since = *mode_set_});
  }
  mode_set_ = time;
}

void Conduct::judge_objective(const Command& command, const Complain& complain) {
  if (command.verb == Verb::kSetActiveObjective && state_ == kRunningSequence) {
    complain("kinovazed.host.active-objective",
             fmt::format("{} was chosen", to_string(command.objective)));
  }
  if (command.verb == Verb::kGetObjectivePosition && !is_objective_chosen_) {
    complain("kinovazed.host.chosen-objective", "no objective was chosen or run before");
  }
  is_objective_chosen_ = is_objective_chosen_ || names_objective(command.verb);
}

void Conduct::leave(Instant time, const Complain& complain_now) {
  const auto complain = complain_now.resting_on({.since = time});
  complain.occasion(occasion::kLeft);
  if (!moves_.empty()) complain.occasion(occasion::kJoystickLeft);
  give_up_waiting(time);
  if (is_silent(time)) return;
  if (!requests_.empty()) {
    complain("kinovazed.host.leaves-answered",
             fmt::format("the client left, and {} was not answered yet",
                         to_string(requests_.front().command.verb)));
  } else if (is_deflected_) {
    complain("kinovazed.host.leaves-stick", "the client left with the joystick deflected");
  } else if (state_ && is_motion(*state_)) {
    complain("kinovazed.host.leaves-motion",
             fmt::format("the client left in state {}", to_string(*state_)));
  }
}

void Conduct::tick(Instant time, const Complain& complain) {
  if (state_) complain.occasion(requirement_of(*state_, Verb::kUnfold, is_stop_unasked_));
  if (state_ != kRunningSequence || is_patience_told_) return;
  complain.occasion("kinovazed.host.objective-patience");
  const auto runs_for = time - entered_;
  if (runs_for <= kLongestObjective) return;
  is_patience_told_ = complain("kinovazed.host.objective-patience",
                               fmt::format("one runs for {:.0f} ms", milliseconds(runs_for)),
                               {.since = entered_, .beyond = runs_for - kLongestObjective});
}

/// What has an event of its own a documented server accepts without a word.
void Conduct::give_up_waiting(Instant time) {
  while (!requests_.empty() && time - requests_.front().sent > kAnswer + noise_) {
    const bool may_be_accepted = drive::event_of(requests_.front().command.verb).has_value();
    accept_first(time);
    if (!may_be_accepted) enter(time, std::nullopt);
  }
}

void Conduct::accept_first(Instant time) {
  const auto verb = requests_.front().command.verb;
  requests_.pop_front();
  enter(time, leads_to(verb));
  led_here_ = verb;
  is_stop_unasked_ = false;
  if (verb == Verb::kRunObjective) entered_ = time;
}

void Conduct::message(Instant time, const ServerMessage& message) {
  give_up_waiting(time);
  heard_ = time;
  is_silence_told_ = false;
  if (const auto* const beat = std::get_if<Heartbeat>(&message)) return take_beat(time, *beat);
  const auto event = std::get<Event>(message);
  const bool is_reply = event == Event::kAccepted || event == Event::kRejected;
  is_reply ? take_reply(time, event) : take_event(time, event);
}

void Conduct::take_reply(Instant time, Event reply) {
  const bool is_accepted = reply == Event::kAccepted;
  const bool is_of_request =
      !requests_.empty() && !(is_accepted && overtaken_ && requests_.front().sent < *overtaken_);
  if (!is_of_request) {
    const bool is_explained = !is_accepted || std::exchange(overtaken_, std::nullopt);
    if (!is_explained) enter(time, std::nullopt);
  } else if (is_accepted) {
    accept_first(time);
  } else {
    if (requests_.front().command.verb == Verb::kMoveJoystick) is_deflected_ = false;
    requests_.pop_front();
  }
}

void Conduct::take_event(Instant time, Event event) {
  const auto before = state_;
  const auto asked = std::ranges::find_if(requests_, [event](const Request& each) {
    return drive::event_of(each.command.verb) == event;
  });
  if (asked != requests_.end()) {
    led_here_ = asked->command.verb;
    overtaken_ = time;
    requests_.erase(asked);
  }
  enter(time, state_behind(event, mode_));
  before_ = before;
  before_until_ = time + noise_;
}

void Conduct::take_beat(Instant time, Heartbeat beat) noexcept {
  const bool is_first = !std::exchange(has_looked_, true);
  if (!requests_.empty()) return;  // it may show the state before or after them
  const auto shown = shown_state(beat);
  const bool is_as_known = shown ? state_ == shown : state_ && !shown_state(beat_of(*state_));
  if (is_as_known) return;
  const auto before = state_;
  enter(time, shown);
  is_stop_unasked_ = before.has_value() && shown == kEmergencyStopped;
  led_here_.reset();
  if (is_first) return;  // who has not read it commands nothing
  before_ = before;
  before_until_ = time + (before ? kReaction : Duration{}) + noise_;
}

}  // namespace armjig::kinovazed::programs
