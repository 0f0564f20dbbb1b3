// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "conformance/program_checker.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/state.hpp"

namespace armjig::kinovazed::programs {

/// Judges when the client that is served says what, given what the server has told it. Whether an
/// answer is missing for ever or belongs to a documented server, which accepts some commands
/// without a word, is not asked: half a second after a command nothing is held against a client
/// that does not wait any more.
class Conduct {
 public:
  explicit Conduct(Duration noise) noexcept : noise_{noise} {}

  /// A client is served from now on.
  void begin(Instant time) noexcept;
  /// It leaves of its own will.
  void leave(Instant time, const Complain& complain);
  /// Nobody is served any more.
  void end() noexcept;

  void command(Instant time, const Command& command, const Complain& complain);
  void message(Instant time, const ServerMessage& message);
  /// Time has passed.
  void tick(Instant time, const Complain& complain);

 private:
  struct Request {
    Command command;
    Instant sent{};
  };

  void give_up_waiting(Instant time);
  void enter(Instant time, std::optional<State> state) noexcept;
  void accept_first(Instant time);
  void take_reply(Instant time, Event reply);
  void take_event(Instant time, Event event);
  void take_beat(Instant time, Heartbeat beat) noexcept;
  [[nodiscard]] bool is_silent(Instant time) const noexcept;
  [[nodiscard]] bool may_overtake(const Command& command) const noexcept;
  [[nodiscard]] bool is_allowed(Instant time, Verb verb) const noexcept;

  void note_occasions(Instant time, const Command& command, const Complain& complain) const;
  void judge_turn(const Command& command, const Complain& complain) const;
  void judge_state(Instant time, const Command& command, const Complain& complain) const;
  void judge_joystick(Instant time, const Command& command, const Complain& complain);
  void judge_objective(const Command& command, const Complain& complain);

  Duration noise_;
  Instant heard_{};  ///< the last message, or the beginning
  bool has_looked_ = false;
  bool is_silence_told_ = false;
  std::deque<Request> requests_;      ///< without an answer, oldest first
  std::optional<Instant> overtaken_;  ///< when an event came whose Accepted did not come yet

  std::optional<State> state_;  ///< as the client can know it
  Instant entered_{};
  std::optional<State> before_;  ///< for a client that has not read of the change yet
  Instant before_until_{};
  std::optional<Verb> led_here_;
  bool is_stop_unasked_ = false;
  Mode mode_{};  ///< that was asked for last
  bool is_deflected_ = false;
  bool is_objective_chosen_ = false;
  bool is_patience_told_ = false;
  std::optional<Instant> mode_set_;  ///< when one that steers was asked for
  std::deque<Instant> moves_;        ///< the last ones of the joystick
};

}  // namespace armjig::kinovazed::programs
