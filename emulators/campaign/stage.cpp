// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/stage.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <span>
#include <thread>
#include <utility>

#include "emulators/sessions/dice.hpp"
#include "harness/link/transaction_bus.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

void rest(StreamPort& port, Duration time) {
  std::array<std::byte, 4096> buffer;
  const auto end = port.now() + time;
  for (;;) {
    const auto size = port.read(buffer, end);
    if (!size || *size == 0) return;
  }
}
void rest(SessionSource& server, Duration time) { server.pause(time); }
void rest(BusPort& port, Duration time) { port.wait_until(port.now() + time); }

/// To who watches over a target, without waiting and without taking what came from it.
void show_life(StreamPort& port) { (void)port.read({}, port.now()); }
void show_life(SessionSource& server) { server.pause(1us); }
void show_life(BusPort& port) { port.wait_until(port.now()); }

/// Whether it is there: a server is when it takes a client, which leaves as a system tells it. One
/// that begins to listen only when it is woken has a while for that, as each host gives it.
bool greet(SessionSource& server) {
  constexpr auto kPatience = 100ms;
  constexpr auto kBetween = 10ms;
  const auto port = server.make_port();
  const auto deadline = port->now() + kPatience;
  while (!port->connect(deadline)) {
    if (port->now() >= deadline) return false;
    rest(server, kBetween);
  }
  port->half_close();
  rest(server, kPatience);
  return true;
}
bool greet(Endpoint& /*port*/) { return true; }

/// A bus as it is reached through an operating system.
class WholeTransactions final : public TransactionBus {
 public:
  explicit WholeTransactions(BusPort& inner) : inner_{inner} {}
  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    return inner_.transfer(messages);
  }
  void wait_until(Instant time) override { inner_.wait_until(time); }
  [[nodiscard]] Instant now() const override { return inner_.now(); }

 private:
  BusPort& inner_;
};

/// A port as that of a live target is.
StreamPort& as_live(StreamPort& port) { return port; }
SessionSource& as_live(SessionSource& server) { return server; }
WholeTransactions as_live(BusPort& port) { return WholeTransactions{port}; }

Duration lateness_of(const Script& script, const std::vector<Instant>& passed) {
  Duration latest{};
  for (std::size_t i = 0; i < std::min(script.size(), passed.size()); ++i) {
    if (is_sent(script[i])) latest = std::max(latest, passed[i] - script[i].time);
  }
  return latest;
}

/// When a live device may have got each record, given when it left and what was answered: then;
/// when it should have left; what left within a short time, together; all a little later; when the
/// device said something next, as one that had no time reads all at once that came meanwhile. Of a
/// client that has left, the system tells a server no more at first than that nothing comes any
/// more.
using Guess = Script (*)(const Script& script, const Played& played);

Script as_left(const Script& script, const Played& played) {
  auto guessed = script;
  for (std::size_t i = 0; i < std::min(script.size(), played.passed.size()); ++i) {
    guessed[i].time = std::max(script[i].time, played.passed[i]);
  }
  return guessed;
}

Script as_meant(const Script& script, const Played& /*played*/) { return script; }

Script in_bundles(const Script& script, const Played& played) {
  constexpr Duration kNear = 1ms;
  auto guessed = as_left(script, played);
  for (std::size_t i = 1; i < guessed.size(); ++i) {
    if (guessed[i].time - guessed[i - 1].time < kNear) guessed[i].time = guessed[i - 1].time;
  }
  return guessed;
}

Script a_little_late(const Script& script, const Played& played) {
  auto guessed = as_left(script, played);
  for (auto& record : guessed) record.time += 1ms;
  return guessed;
}

Script as_answered(const Script& script, const Played& played) {
  constexpr Duration kLong = 20ms;
  auto guessed = as_left(script, played);
  auto next = played.actual.begin();
  for (auto& record : guessed) {
    next = std::ranges::find_if(next, played.actual.end(),
                                [&](const KeptRecord& said) { return said.time >= record.time; });
    if (next == played.actual.end()) break;
    if (next->time - record.time <= kLong) record.time = next->time;
  }
  return guessed;
}

Script as_far_as_seen(const Script& script, const Played& played) {
  auto guessed = as_left(script, played);
  for (auto& record : guessed) leave_half_open(record);
  return guessed;
}

constexpr std::array<Guess, 6> kGuesses{as_left,       as_meant,    in_bundles,
                                        a_little_late, as_answered, as_far_as_seen};

/// Nor does anybody know where in its tick a live device is, and what comes close together may come
/// in one tick or in two. So there are models that began later. No multiple of the step is that of
/// a whole number of milliseconds, so ticks of 5 and of 10 ms are looked at from sixteen sides.
constexpr std::size_t kPhases = 16;
constexpr Duration kPhaseStep = 610us;

Duration delay_up_to(Duration most, sessions::Dice& dice) {
  return Duration{dice.between(Duration{}.count(), most.count())};
}

/// As it comes over a link in real time: all of it a little later, which nobody sees who sends it.
Script unevenly(Script script, const std::function<Duration()>& delay) {
  Instant last{};
  for (auto& record : script) record.time = last = std::max(last, record.time + delay());
  return script;
}

/// The models beside a live target: each guess in the target's own phase, then the plain one in
/// others, and in others yet unevenly, so that what depends on how far apart two came is no thing
/// that all agree on.
constexpr std::size_t kUneven = 8;
constexpr std::size_t kEven = kGuesses.size() + kPhases - 1;
constexpr std::size_t kLiveModels = kEven + kUneven;

Script guess_of(std::size_t model, const Script& script, const Played& played) {
  if (model < kGuesses.size()) return kGuesses[model](script, played);
  auto guess = as_left(script, played);
  if (model < kEven) return guess;
  sessions::Dice dice{model};
  return unevenly(guess, [&] { return delay_up_to(1ms, dice); });
}
Duration phase_of(std::size_t model) {
  if (model < kGuesses.size()) return {};
  return static_cast<Duration::rep>(model - kGuesses.size() + 1) * kPhaseStep;
}

std::vector<Instant> times_of(const Script& script) {
  std::vector<Instant> times;
  for (const auto& record : script) times.push_back(record.time);
  return times;
}

Outcome<Played> in_order(Outcome<Played> played) {
  if (played) std::ranges::stable_sort(played->actual, {}, &KeptRecord::time);
  return played;
}

Heard heard(Outcome<Played> played) {
  if (!played) return {{}, played.error()};
  return {std::move(played->actual), std::nullopt};
}

}  // namespace

template <class Port>
Outcome<Rig<Port>> StageOn<Port>::make_model() const {
  return setup_.make_model().map([](Rig<Port> model) {
    (void)greet(model.port());
    return model;
  });
}

template <class Port>
Outcome<std::vector<Rig<Port>>> StageOn<Port>::make_models() const {
  Models models;
  const auto count = setup_.is_emulated ? 1 : kLiveModels;
  for (std::size_t i = 0; setup_.make_model && i < count; ++i) {
    auto model = make_model();
    if (!model) return tl::unexpected{model.error()};
    models.push_back(*std::move(model));
    if (const auto phase = phase_of(i); phase > Duration{}) rest(models.back().port(), phase);
  }
  return models;
}

template <class Port>
Outcome<void> StageOn<Port>::renew_models() {
  auto models = make_models();
  if (!models) return tl::unexpected{models.error()};
  models_ = *std::move(models);
  last_end_ = target_->port().now();
  return {};
}

template <class Port>
Outcome<void> StageOn<Port>::watch_over() {
  if (!target_->is_unsupervised()) return {};
  if (auto resumed = target_->resume(); !resumed) {
    return problem(resumed.error().code, "--target", "it cannot be watched over any more");
  }
  return problem(ErrorCode::kForbidden, "--target",
                 "this program had no time for it, and its supervisor stopped it");
}

template <class Port>
Outcome<BothHeard> StageOn<Port>::play(const Script& script) {
  if (auto watched = watch_over(); !watched) return tl::unexpected{watched.error()};
  const auto idle = target_->port().now() - last_end_;
  auto played = in_order(play_host(target_->port(), script, setup_.how));
  if (!played && played.error().code == ErrorCode::kForbidden) {
    auto refused = std::move(played).error();
    if (auto why = target_->last_refusal()) refused.hint = std::move(why->reason);
    return tl::unexpected{std::move(refused)};
  }
  if (auto watched = watch_over(); !watched) return tl::unexpected{watched.error()};
  last_end_ = target_->port().now();
  for (auto& model : models_) {
    if (idle > Duration{}) rest(model.port(), idle);
  }
  return beside(models_, script, std::move(played));
}

template <class Port>
BothHeard StageOn<Port>::beside(Models& models, const Script& script, Outcome<Played> played) {
  const auto known = played.value_or(Played{});
  BothHeard both{heard(std::move(played)), {}, lateness_of(script, known.passed)};
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (target_ && target_->is_guarded()) show_life(target_->port());
    const auto guessed = setup_.is_emulated ? script : guess_of(i, script, known);
    both.models.push_back(heard(in_order(play_host(models[i].port(), guessed, setup_.how))));
  }
  return both;
}

template <class Port>
Outcome<BothHeard> StageOn<Port>::play_to_stand_in(const Script& script, std::uint64_t seed) {
  constexpr Duration kMostPhase = 20ms;
  constexpr std::int64_t kFewAre = 20;
  if (!setup_.make_model) return BothHeard{};
  auto models = make_models();
  if (!models) return tl::unexpected{models.error()};
  auto stand_in = make_model();
  if (!stand_in) return tl::unexpected{stand_in.error()};
  sessions::Dice dice{seed};
  rest(stand_in->port(), delay_up_to(kMostPhase, dice));
  const auto delay = [&] { return delay_up_to(dice.one_in(kFewAre) ? 5ms : 1ms, dice); };
  auto&& live = as_live(stand_in->port());
  auto played = in_order(play_host(live, unevenly(script, delay), setup_.how));
  if (played) played->passed = times_of(script);
  return beside(*models, script, std::move(played));
}

template <class Port>
Outcome<void> StageOn<Port>::make_target() {
  constexpr auto kBetween = 20ms;
  target_.reset();
  if (was_open_ && setup_.restart && !setup_.restart()) {
    return problem(ErrorCode::kNotFound, "--restart", "the command failed");
  }
  const auto begun = std::chrono::steady_clock::now();
  for (;;) {
    auto opened = setup_.make_target();
    if (opened && greet(opened->port())) {
      target_ = *std::move(opened);
      was_open_ = true;
      return {};
    }
    const bool may_come = was_open_ && std::chrono::steady_clock::now() - begun < setup_.patience;
    if (!may_come && !opened) return tl::unexpected{opened.error()};
    if (!may_come) return problem(ErrorCode::kRefused, "--target", "it takes no client; start it");
    std::this_thread::sleep_for(kBetween);
  }
}

template class StageOn<StreamPort>;
template class StageOn<SessionSource>;
template class StageOn<BusPort>;

}  // namespace armjig::campaign
