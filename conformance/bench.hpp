// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <type_traits>
#include <utility>

#include "conformance/requirement.hpp"
#include "conformance/wording.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// What a case found. `expected` and `actual` are sentences; `actual` is also the reason why
/// something was skipped or showed nothing.
struct Judgement {
  Verdict verdict = Verdict::kPass;
  std::string expected{};
  std::string actual{};
  bool is_silence = false;  ///< nothing was wrong but that an ordinary answer did not come
  /// Where in the device's message it was seen, in bytes from its beginning; none if `actual` names
  /// a field, or is about something else.
  std::optional<std::size_t> byte{};
  bool is_left_out = false;  ///< skipped because link or hands do not reach as far
  bool is_timing = false;    ///< about when something came, which link and machine have a part in
  bool is_race = false;      ///< behind `Bench::begin_race`
  std::string margin{};      ///< what was measured nearest to a bound, and its bounds
};

/// `expected A, got B`; without the former if nothing was expected.
[[nodiscard]] std::string wording_of(const Judgement& judgement);

/// What was measured, and its bounds.
struct InBounds {
  double value{};
  double least{};
  double most{};
  std::string_view unit;
};

/// Somebody or something beside the device that sets its inputs, such as a board of relays.
struct Hand {
  /// Whether there is something to set an input with; nothing is done.
  std::function<bool(std::string_view input)> has = [](std::string_view /*input*/) {
    return false;
  };
  /// Sets it. False: nobody could.
  std::function<bool(std::string_view input, std::int64_t value)> set =
      [](std::string_view /*input*/, std::int64_t /*value*/) { return false; };
};

/// Plays so many sessions, drawn from a seed, to the device and to a reference beside it. In what
/// they differ first, as a sentence; none: in nothing. Problems: those of opening either.
using PlaySessions =
    std::function<Outcome<std::optional<std::string>>(std::uint64_t seed, std::uint64_t count)>;

/// What a case works on: a conversation with one device, on whatever link that has. Each suite has
/// its own kind, with the vocabulary of its protocol; this is what the engine needs of all.
///
/// The first finding decides a case. From then on everything that the body does is without effect,
/// so that bodies are straight lines without a way out in the middle.
class Bench {
 public:
  Bench() = default;
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  virtual ~Bench() = default;

  /// Asks for a sign of life and leaves nothing half said behind. False: there is none.
  [[nodiscard]] virtual bool is_alive() = 0;

  /// Brings the device to the state `start` of its suite. Does nothing if it is there already.
  /// What stands in the way is a finding of its own.
  virtual void bring_to(std::size_t start) = 0;

  /// Learns how much later than needed answers come here. Called once, before the first case.
  virtual void measure_noise() = 0;
  /// The most that was seen then, the device's own time in it.
  [[nodiscard]] Duration heard_noise() const noexcept { return heard_; }
  /// The same, but no more than a device that obeys may take, and the link.
  [[nodiscard]] Duration noise() const noexcept;
  /// What link and machine have added to it at most, without the device.
  [[nodiscard]] Duration link_noise() const noexcept;
  /// So late come answers of an emulated device on a link of the same kind; none: nobody knows.
  void know_link(std::optional<Duration> noise) noexcept { link_ = noise; }

  /// How sessions are played beside a reference; nobody can, unless this is called.
  void know_sessions(PlaySessions play) { play_sessions_ = std::move(play); }

  /// For what neither link nor emulated device offers.
  void set_hand(Hand hand) { hand_ = std::move(hand); }
  /// Whether a device whose program a case has ended or hung can be put right again.
  [[nodiscard]] virtual bool can_restart() { return true; }
  /// Starts one that gives no sign of life again. False: nobody can, or it gives none then either.
  [[nodiscard]] virtual bool revive() { return false; }

  /// Whether the device was stopped because nothing came from this process for a while, which a
  /// link that is held up does to it, too. It does not move any more until `resume`.
  [[nodiscard]] virtual bool is_stopped() { return false; }
  /// Lets it move again.
  virtual void resume() {}

  /// The link's own clock, virtual or real.
  [[nodiscard]] virtual Instant now() const = 0;
  /// Why the link is gone; none as long as it is there.
  [[nodiscard]] const std::optional<Error>& error() const noexcept { return error_; }
  /// The last few messages both ways, oldest first, decoded; none from before `begin`.
  [[nodiscard]] virtual std::string last_exchange() const = 0;

  /// Begins a case or what comes before one.
  void begin(Profile profile, std::uint64_t seed);
  [[nodiscard]] const Judgement& judgement() const noexcept { return judgement_; }

  /// Whether it is decided already.
  [[nodiscard]] bool is_over() const noexcept { return is_over_; }
  [[nodiscard]] Profile profile() const noexcept { return profile_; }
  /// For bytes that may be any. The same for the same seed and case, whichever others ran before.
  [[nodiscard]] std::uint32_t random() { return static_cast<std::uint32_t>(random_()); }

  void fail(std::string expected, std::string actual);
  /// The same for that byte of the device's newest message.
  void fail_at(std::size_t byte, std::string expected, std::string actual);
  void fail_by_silence(std::string expected, std::string actual);
  void skip(std::string reason);     ///< what it needs, link or hands do not offer
  void give_up(std::string reason);  ///< skips it for what does not lie in that
  void blame_rig(std::string reason);
  void leave_open(std::string reason);  ///< inconclusive

  /// What comes next is about this: it stands after every expectation until it is said again.
  void about(std::string what) { about_ = std::move(what); }
  void expect_true(bool is_so, std::string_view wanted, std::string_view otherwise);
  /// The same of a moment or a pace: tried again before it counts, where time is real.
  void expect_in_time(const InBounds& measured, std::string_view wanted,
                      std::string_view otherwise);
  /// From here on things have to come within moments of each other: what is found is about that, as
  /// with `expect_in_time`.
  void begin_race() noexcept { is_race_ = true; }
  /// In so many sessions drawn at random it does what a reference beside it does. Skips the case
  /// where there is none.
  void expect_as_reference(std::uint64_t sessions);

 protected:
  virtual void forget_exchange() = 0;

  /// Nothing passes on the link any more, and no time goes by.
  [[nodiscard]] bool is_deaf() const noexcept { return error_ || is_over_; }
  /// An expectation, with what it is about.
  [[nodiscard]] std::string in_context(std::string_view text) const;
  [[nodiscard]] const std::string& subject() const noexcept { return about_; }
  void lose_link(const Error& error) { error_ = error; }
  [[nodiscard]] const Hand& hand() const noexcept { return hand_; }
  void hear_noise(Duration noise) { heard_ = std::max(heard_, noise); }
  /// What the requirements leave a device for its answer.
  [[nodiscard]] virtual Duration longest_answer() const noexcept { return Duration::max(); }

 private:
  void decide(Judgement judgement);

  Profile profile_{};
  Judgement judgement_;
  std::string about_;
  std::optional<Error> error_;
  Duration heard_{};
  std::optional<Duration> link_;
  Hand hand_;
  PlaySessions play_sessions_;
  bool is_over_ = false;
  bool is_race_ = false;
  double room_{};  ///< from the margin to its bound, as a share of the way between the bounds
  std::mt19937 random_;
};

/// The body of a case, as the engine calls it: a lambda without captures, or `on<function>`, whose
/// parameter is the bench of its device. The suite that has the case also made the bench, so its
/// kind is known.
class CaseBody {
 public:
  constexpr CaseBody() = default;
  constexpr CaseBody(void (*function)(Bench&)) noexcept : run_{function} {}  // NOLINT(*-explicit-*)
  template <class Lambda>
    requires std::is_empty_v<Lambda>
  constexpr CaseBody(Lambda /*body*/) noexcept  // NOLINT(*-explicit-*)
      : run_{run<Lambda>} {}

  void operator()(Bench& bench) const { run_(bench); }

 private:
  // By its type: GCC 12 takes members of two files' lambdas, as arguments of a template, for one.
  template <class Lambda>
  static void run(Bench& bench) {
    call(bench, Lambda{}, &Lambda::operator());
  }
  template <class Lambda, class Kind>
  static void call(Bench& bench, Lambda lambda, void (Lambda::* /*body*/)(Kind&) const) {
    lambda(static_cast<Kind&>(bench));
  }

  void (*run_)(Bench&) = nullptr;
};

template <auto function>
struct OnBench;
template <class Kind, void (*function)(Kind&)>
struct OnBench<function> {
  static void run(Bench& bench) { function(static_cast<Kind&>(bench)); }
};
template <auto function>
inline constexpr CaseBody on{OnBench<function>::run};

}  // namespace armjig
