// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/kinovazed/drive.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "harness/wire/steps.hpp"

namespace armjig::kinovazed::drive {
namespace {

using std::chrono::seconds;

/// What a client has to know of a command, by `Verb`.
struct Row {
  Verb verb;
  std::optional<Event> event;
  Duration time;  ///< until the event
};
constexpr std::array<Row, kVerbNames.size()> kRows{{
    {Verb::kEStop, std::nullopt, {}},
    {Verb::kQuitEStop, std::nullopt, {}},
    {Verb::kInitialize, Event::kInitialized, seconds{30}},
    {Verb::kUnfold, Event::kUnfolded, seconds{15}},
    {Verb::kRetract, Event::kRetracted, seconds{30}},  // by way of its ready pose
    {Verb::kFreeze, Event::kFreezed, seconds{3}},
    {Verb::kUnfreeze, Event::kUnfreezed, seconds{3}},
    {Verb::kSetJoystickMode, Event::kJoystickModeSet, seconds{2}},
    {Verb::kMoveJoystick, std::nullopt, {}},
    {Verb::kRunObjective, Event::kObjectiveDone, seconds{60}},
    {Verb::kSetActiveObjective, std::nullopt, {}},
    {Verb::kGetObjectivePosition, std::nullopt, {}},
    {Verb::kGetAbsolutePosition, std::nullopt, {}},
}};

constexpr const Row& row_of(Verb verb) noexcept { return kRows[static_cast<std::size_t>(verb)]; }

std::string_view words_of(Ending ending) noexcept {
  static constexpr std::array<std::string_view, 6> kWords{
      "is done",
      "was rejected",
      "got no reply",
      "was accepted but does not end",
      "was ended by another command",
      "was lost with the connection",
  };
  return kWords[static_cast<std::size_t>(ending)];
}

}  // namespace

std::optional<Event> completion_of(Verb verb) noexcept { return row_of(verb).event; }

std::string describe(const DriveEvent& event) {
  using Kind = DriveEvent::Kind;
  switch (event.kind) {
    case Kind::kEnded: {
      auto line = std::string{encode(event.command).view()};
      line.resize(line.size() - 2);  // CR LF
      return fmt::format("{} {}", line, words_of(event.ending));
    }
    case Kind::kUnasked:
      return fmt::format("the server said {}, which nobody waited for", to_string(event.said));
    case Kind::kUnreadable:
      return "the server said something that is no message";
    case Kind::kArmStopped:
      return "the server stopped, which was not asked for here: trouble with its arm, or a "
             "supervisor; QuitEStop, then Initialize";
    case Kind::kStickReleased:
      return "the joystick was let go, because nobody renewed it";
    case Kind::kSilent:
      return "no beat for three seconds: the server is mute, or serves somebody else";
    case Kind::kBack:
      return "beats again";
  }
  return {};
}

std::optional<Event> event_of(Verb verb) noexcept { return row_of(verb).event; }
Duration time_for(Verb verb) noexcept { return row_of(verb).time; }
void Drive::connect(Instant now) noexcept {
  is_connected_ = true;
  is_silent_ = false;
  beat_.reset();
  heard_ = now;
  has_stopped_it_ = true;  // whoever was here before may have
}

void Drive::disconnect(Instant now) {
  is_connected_ = false;
  outgoing_.clear();
  splitter_ = {};
  while (!requests_.empty()) end(now, requests_.begin(), Ending::kLost);
}

Result<RequestId> Drive::begin(Instant now, const Command& command) {
  if (!is_connected_) return fail(ErrorCode::kDisconnected);
  const bool is_urgent = command.verb == Verb::kEStop || is_stick_at_rest(command);
  if (!is_urgent && (awaits_reply() || now < not_before(command))) return fail(ErrorCode::kBusy);
  take_for_granted(now);
  const auto id = next_id_++;
  outgoing_ += encode(command).view();
  requests_.push_back({.id = id,
                       .command = command,
                       .sent = now,
                       .reply_due = now + patience::kReply,
                       .event_due = now + patience::kReply + time_for(command.verb)});
  follow_stick(now, command);
  if (is_steering_mode(command)) mode_changed_ = now;
  if (!is_answered(command.verb)) end(now, requests_.end() - 1, Ending::kDone);
  return id;
}

Result<std::optional<RequestId>> Drive::cancel(Instant now) {
  const auto current = under_way();
  if (!current) return std::nullopt;
  const auto ender = current->verb == Verb::kRunObjective
                         ? Command{.verb = Verb::kSetJoystickMode, .mode = Mode::kNoMode}
                         : Command{.verb = Verb::kEStop};
  const auto id = begin(now, ender);
  if (!id) return tl::unexpected{id.error()};
  return *id;
}

Instant Drive::not_before(const Command& command) const noexcept {
  return is_steering_mode(command) && mode_changed_ ? *mode_changed_ + patience::kModeChange
                                                    : Instant{};
}

void Drive::withdraw(RequestId request) {
  std::erase_if(requests_, [request](const Request& each) { return each.id == request; });
}

void Drive::follow_stick(Instant now, const Command& command) noexcept {
  if (command.verb != Verb::kMoveJoystick) return;
  stick_renewed_ = is_stick_at_rest(command) ? std::nullopt : std::optional{now};
}

/// A documented server says nothing when it accepts a command that has an event. What it did not
/// reject at once it has accepted, and the next reply belongs to a later command.
void Drive::take_for_granted(Instant now) noexcept {
  if (options_.profile == Profile::kFirmware) return;
  for (auto& request : requests_) {
    if (!needs_reply(request) && now - request.sent >= patience::kOvertakenReply) {
      request.is_accepted = true;
    }
  }
}

/// Whether `Accepted` will come for it, if it is not rejected.
bool Drive::needs_reply(const Request& request) const noexcept {
  return options_.profile == Profile::kFirmware || !event_of(request.command.verb);
}

bool Drive::awaits_reply() const noexcept {
  return std::ranges::any_of(requests_, [this](const Request& request) {
    return needs_reply(request) && !request.is_accepted;
  });
}

std::optional<Command> Drive::under_way() const noexcept {
  const auto found = std::ranges::find_if(requests_, [](const Request& request) {
    return event_of(request.command.verb) && !request.has_event;
  });
  return found == requests_.end() ? std::nullopt : std::optional{found->command};
}

void Drive::receive(Instant now, Bytes bytes) {
  for_each_step(splitter_, bytes, [&](const LineSplitter::Step& step) {
    if (step.found == LineSplitter::Found::kLine) take_line(now, step.line);
    if (step.found == LineSplitter::Found::kPieceOfLine) {
      add_event({.kind = DriveEvent::Kind::kUnreadable, .time = now});
    }
  });
}

void Drive::take_line(Instant now, std::string_view line) {
  const auto message = decode_message(line);
  if (!message) return add_event({.kind = DriveEvent::Kind::kUnreadable, .time = now});
  if (const auto* const beat = std::get_if<Heartbeat>(&*message)) return take_beat(now, *beat);
  const auto event = std::get<Event>(*message);
  const bool is_reply = event == Event::kAccepted || event == Event::kRejected;
  is_reply ? take_reply(now, event) : take_event(now, event);
}

void Drive::take_reply(Instant now, Event reply) {
  const auto request = std::ranges::find_if(requests_, [&](const Request& each) {
    return !each.is_accepted && (reply == Event::kRejected || needs_reply(each));
  });
  if (request == requests_.end()) {
    return add_event({.kind = DriveEvent::Kind::kUnasked, .time = now, .said = reply});
  }
  if (reply == Event::kRejected) return end(now, request, Ending::kRejected);
  accept(now, request);
}

void Drive::accept(Instant now, Place request) {
  const auto id = request->id;
  request->is_accepted = true;
  if (request->command.verb != Verb::kMoveJoystick) stick_renewed_.reset();
  if (request->command.verb == Verb::kEStop) has_stopped_it_ = true;
  while (requests_.front().id != id) end(now, requests_.begin(), Ending::kInterrupted);
  const auto& front = requests_.front();
  if (!event_of(front.command.verb) || front.has_event) {
    end(now, requests_.begin(), Ending::kDone);
  }
}

void Drive::take_event(Instant now, Event event) {
  const auto request = std::ranges::find_if(requests_, [event](const Request& each) {
    return event_of(each.command.verb) == event && !each.has_event;
  });
  if (request == requests_.end()) {
    return add_event({.kind = DriveEvent::Kind::kUnasked, .time = now, .said = event});
  }
  request->has_event = true;
  if (!needs_reply(*request)) return accept(now, request);
  if (request->is_accepted) return end(now, request, Ending::kDone);
  request->reply_due = std::min(request->reply_due, now + patience::kOvertakenReply);
}

void Drive::take_beat(Instant now, Heartbeat beat) {
  const auto is_stopped = [](Heartbeat each) { return (each.flags & beat::kEmergencyStop) != 0; };
  if (std::exchange(is_silent_, false)) {
    add_event({.kind = DriveEvent::Kind::kBack, .time = now});
  }
  const bool is_ours = std::ranges::any_of(
      requests_, [](const Request& each) { return each.command.verb == Verb::kEStop; });
  if (!is_stopped(beat) || is_ours) {  // a beat may be before the reply, and after the state
    has_stopped_it_ = is_ours;
  } else if (!std::exchange(has_stopped_it_, true)) {
    add_event({.kind = DriveEvent::Kind::kArmStopped, .time = now});
  }
  beat_ = beat;
  heard_ = now;
  ++beats_;
}

void Drive::tick(Instant now) {
  const auto is_late = [&](const Request& each) {
    return now >= (each.is_accepted || !needs_reply(each) ? each.event_due : each.reply_due);
  };
  for (;;) {
    const auto late = std::ranges::find_if(requests_, is_late);
    if (late == requests_.end()) break;
    if (late->has_event) {
      accept(now, late);
    } else {
      const bool is_accepted = late->is_accepted || !needs_reply(*late);
      end(now, late, is_accepted ? Ending::kNoEvent : Ending::kNoReply);
    }
  }
  if (!is_connected_) return;
  if (options_.stick_watchdog > Duration{} && stick_renewed_ &&
      now - *stick_renewed_ >= options_.stick_watchdog) {
    add_event({.kind = DriveEvent::Kind::kStickReleased, .time = now});
    (void)begin(now, {.verb = Verb::kMoveJoystick});
  }
  if (!is_silent_ && now - heard_ >= patience::kBeat) {
    is_silent_ = true;
    add_event({.kind = DriveEvent::Kind::kSilent, .time = now});
  }
}

std::optional<Instant> Drive::due() const noexcept {
  std::optional<Instant> first;
  const auto consider = [&first](Instant time) { first = first ? std::min(*first, time) : time; };
  for (const auto& each : requests_) {
    consider(each.is_accepted || !needs_reply(each) ? each.event_due : each.reply_due);
  }
  if (!is_connected_) return first;
  if (!is_silent_) consider(heard_ + patience::kBeat);
  if (stick_renewed_ && options_.stick_watchdog > Duration{}) {
    consider(*stick_renewed_ + options_.stick_watchdog);
  }
  return first;
}

void Drive::end(Instant now, Place request, Ending ending) {
  add_event({.kind = DriveEvent::Kind::kEnded,
             .time = now,
             .request = request->id,
             .command = request->command,
             .ending = ending});
  requests_.erase(request);
}

std::string Drive::take_outgoing() { return std::exchange(outgoing_, {}); }
std::vector<DriveEvent> Drive::take_events() { return std::exchange(events_, {}); }

}  // namespace armjig::kinovazed::drive
