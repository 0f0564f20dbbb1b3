// SPDX-License-Identifier: Apache-2.0
// What the network side of the server does with a line.
#include <fmt/core.h>

#include <utility>

#include "emulators/kinovazed/server.hpp"

namespace armjig::kinovazed::emulation {
namespace {

/// Commands whose one positive answer in profile documented is `Accepted`; the others have an
/// event.
bool has_no_event(Verb verb) noexcept {
  return verb == Verb::kEStop || verb == Verb::kQuitEStop || verb == Verb::kMoveJoystick;
}

/// The event that the network side itself sends behind `Accepted`.
std::optional<Event> prompt_event(Verb verb) noexcept {
  if (verb == Verb::kFreeze) return Event::kFreezed;
  if (verb == Verb::kUnfreeze) return Event::kUnfreezed;
  return std::nullopt;
}

/// A command whose result still holds in a state, and the event that says so.
struct Recurrence {
  State state;
  Verb verb;
  Event event;
};
/// kinovazed.reply.recurring.
constexpr std::array kRecurrences{
    Recurrence{State::kIdle, Verb::kInitialize, Event::kInitialized},
    Recurrence{State::kRetracted, Verb::kRetract, Event::kRetracted},
    Recurrence{State::kFrozen, Verb::kFreeze, Event::kFreezed},
    Recurrence{State::kSteering, Verb::kSetJoystickMode, Event::kJoystickModeSet},
    Recurrence{State::kIdle, Verb::kUnfold, Event::kUnfolded},
    Recurrence{State::kIdle, Verb::kUnfreeze, Event::kUnfreezed},
};

}  // namespace

void Server::serve_line(std::string_view line) {
  const auto& behaviour = options_.behaviour;
  const auto command = decode_command(line, behaviour.profile);
  if (!command) {
    const bool answers = !behaviour.ignores_bad_lines && command.error() != LineFault::kEmpty;
    if (answers) say(Event::kRejected);
    return;
  }
  const bool is_known = !names_objective(command->verb) ||
                        static_cast<std::size_t>(command->objective) < behaviour.objective_count;
  if (!is_known) return say(Event::kRejected);
  if (!is_answered(command->verb)) return serve_console(*command);
  begin(*command);
}

/// Every command first asks the arm's side something, and so waits for its turn there
/// (kinovazed.time.turn).
void Server::begin(const Command& command) {
  command_ = command;
  if (worker_.is_free_at(now_)) return decide();
  wait_for({.kind = Job::Kind::kWait}, Waiting::kForTurn);
}

void Server::decide() {
  if (repeats()) return;
  if (command_.verb == Verb::kRunObjective && !take_course()) return;
  const auto from = state_;
  const auto next = options_.machine.next_state(from, command_.verb);
  if (!next) return say(Event::kRejected);
  state_ = *next;
  if (command_.verb == Verb::kEStop) is_initialized_ = false;
  if (command_.verb == Verb::kSetJoystickMode) mode_ = command_.mode;
  if (command_.verb == Verb::kUnfreeze) led_to_idle_ = Verb::kUnfreeze;
  plan_jobs(from);
  finish_command();
}

bool Server::repeats() {
  if (!options_.behaviour.repeats_events) return false;
  for (const auto& row : kRecurrences) {
    if (row.state != state_ || row.verb != command_.verb) continue;
    const bool has_led_here = row.verb == Verb::kSetJoystickMode ? mode_ == command_.mode
                              : row.verb == Verb::kUnfold || row.verb == Verb::kUnfreeze
                                  ? led_to_idle_ == row.verb
                                  : true;
    if (!has_led_here) return false;
    say(row.event);
    return true;
  }
  const bool is_current_at_once =
      command_.verb == Verb::kRunObjective && command_.objective == Objective::kCurrent &&
      !options_.behaviour.moves_for_current && options_.machine.next_state(state_, command_.verb);
  if (!is_current_at_once) return false;
  state_ = State::kIdle;
  led_to_idle_ = Verb::kRunObjective;
  say(Event::kObjectiveDone);
  return true;
}

/// What an accepted command does to the arm before it is answered.
void Server::plan_jobs(State from) {
  using Kind = Job::Kind;
  const auto plan = [this](Job job) {
    job.goes_on = !planned_.empty();
    planned_.push_back(job);
  };
  switch (command_.verb) {
    case Verb::kEStop:
      if (from == State::kEmergencyStopped) return;
      plan({.kind = Kind::kStop});
      return plan({.kind = Kind::kReleaseControl});
    case Verb::kInitialize:
      plan({.kind = Kind::kTakeControl});
      return plan({.kind = Kind::kInitialize});
    case Verb::kUnfold:
      return plan({.kind = Kind::kUnfold});
    case Verb::kRetract:
      return plan({.kind = Kind::kRetract});
    case Verb::kFreeze:
      return plan({.kind = Kind::kStop});
    case Verb::kSetJoystickMode:
      plan({.kind = Kind::kStop});
      return plan({.kind = Kind::kSetMode, .mode = command_.mode});
    case Verb::kMoveJoystick:
      return plan({.kind = Kind::kMove, .deflection = command_.deflection});
    case Verb::kRunObjective:
      plan({.kind = Kind::kStop});
      return plan({.kind = Kind::kGoTo, .target = running_course_->path.points.front()});
    default:
      return;
  }
}

/// Waits for the next job, or answers when all are done.
void Server::finish_command() {
  if (!planned_.empty()) {
    const auto job = planned_.front();
    planned_.pop_front();
    return wait_for(job, Waiting::kForJobs);
  }
  if (options_.behaviour.accepts_before_event || has_no_event(command_.verb)) {
    say(Event::kAccepted);
  }
  if (const auto event = prompt_event(command_.verb)) say(*event);
}

bool Server::point_is_allowed(const Pose& pose) const noexcept {
  return !options_.behaviour.dies || is_in_workspace(pose);
}

/// Makes the objective of the command the current one and finds its first target. False: the
/// command is answered, or the process is dead.
bool Server::take_course() {
  const auto& behaviour = options_.behaviour;
  const auto* const path = options_.objectives.find(command_.objective);
  if (path == nullptr) {  // kinovazed.death.objective-missing
    behaviour.dies ? die() : say(Event::kRejected);
    return false;
  }
  Course course{*path, frame_of(path->origin.value_or(worker_.pose())), 1};
  auto& first = course.path.points.front();
  first = transformed(course.origin, first);
  if (!is_in_workspace(first)) {  // kinovazed.death.first-point
    behaviour.dies ? die() : say(Event::kRejected);
    return false;
  }
  const bool is_accepted = options_.machine.next_state(state_, command_.verb).has_value();
  if (is_accepted || behaviour.shares_objective) course_ = running_course_ = std::move(course);
  return true;
}

void Server::go_on_with_course() {
  auto& course = *running_course_;
  const auto point = transformed(course.origin, course.path.points[course.next]);
  ++course.next;
  if (!point_is_allowed(point)) return worker_.die();  // kinovazed.death.later-point
  worker_.then_stop();
  if (is_in_workspace(point)) worker_.then_go_to(point);
}

/// Commands that only the how-to of the document names. They answer nothing
/// (kinovazed.console.silent).
void Server::serve_console(const Command& command) {
  if (command.verb == Verb::kSetActiveObjective) return set_active_objective(command.objective);
  if (command.verb == Verb::kGetAbsolutePosition) return log_position("abs", worker_.pose());
  if (!course_) return log("no current objective");
  const auto pose = transformed(inverse(course_->origin), worker_.pose());
  if (is_in_workspace(pose)) return log_position("obj", pose);
  if (options_.behaviour.dies) return die();  // kinovazed.death.objective-position
  log("the position is out of range in the frame of the current objective");
}

void Server::set_active_objective(Objective objective) {
  const auto* const path = options_.objectives.find(objective);
  if (path == nullptr) {
    if (options_.behaviour.dies) return die();
    return log("no such objective");
  }
  course_ = Course{*path, frame_of(path->origin.value_or(worker_.pose())), 0};
  if (options_.behaviour.shares_objective) running_course_ = course_;
}

/// The line that the how-to tells people to paste into the file of objectives.
void Server::log_position(std::string_view frame, const Pose& pose) {
  log(fmt::format(
      "Current arm position ({}): {{ \"X\":  {}, \"Y\":  {}, \"Z\":  {}, \"pitch\":  {}, "
      "\"yaw\":  {}, \"roll\":  {} }}",
      frame, pose.x, pose.y, pose.z, pose.pitch, pose.yaw, pose.roll));
}

}  // namespace armjig::kinovazed::emulation
