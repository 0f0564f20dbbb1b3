// SPDX-License-Identifier: Apache-2.0
#include "emulators/shadow/kinovazed_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/wire/kinovazed/vocabulary.hpp"

namespace armjig::kinovazed::shadow {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr auto kAll = std::numeric_limits<std::size_t>::max();
constexpr double kLeastCall = 50;
constexpr double kMostCall = 50'000;

/// Between heartbeats that follow one another, in seconds, in order of size.
std::vector<double> periods_in(const FitTalk& talk) {
  constexpr double kMostOff = 0.11;
  std::map<std::uint32_t, Instant> last;
  std::vector<double> periods;
  for (const auto& [id, message] : talk.said) {
    if (message.name != kHeartbeatName) continue;
    const auto [before, is_first] = last.try_emplace(id, message.time);
    const auto period = Seconds{message.time - before->second}.count();
    if (!is_first && std::abs(period - 1) < kMostOff) periods.push_back(period);
    before->second = message.time;
  }
  std::ranges::sort(periods);
  return periods;
}

/// Those of sorted numbers that lie closest together, a few or a quarter.
std::span<const double> closest_of(std::span<const double> sorted) {
  constexpr std::size_t kFew = 2;
  const auto count = std::min(sorted.size(), std::max(kFew, sorted.size() / 4));
  auto best = sorted.first(count);
  for (std::size_t i = 1; i + count <= sorted.size(); ++i) {
    const auto here = sorted.subspan(i, count);
    if (here.back() - here.front() < best.back() - best.front()) best = here;
  }
  return best;
}

/// How much earlier or later messages come, in seconds, the first `count` of them, but for those
/// that are passed over. One that takes long is the arm's motion, and says little of calls.
double lateness(const TalkReplay& replay, std::size_t count, std::string_view passed_over) {
  constexpr double kMotion = 0.25;
  double sum = 0;
  std::size_t paired = 0;
  const auto unpaired = for_each_pair(
      replay,
      [&](const RecordedMessage& one, const RecordedMessage& other) {
        if (paired++ >= count) return;
        const Seconds apart = one.message.time - other.message.time;
        sum += std::min(kMotion, std::abs(apart.count()));
      },
      passed_over);
  const auto missing = std::min(paired + unpaired, count) - std::min(paired, count);
  return sum + kMotion * static_cast<double>(missing);
}

DeviceOptions with_call(const DeviceOptions& options, double call) {
  return with(options, "call-us", fmt::format("{:.0f}", call));
}

/// Each command calls the arm a certain number of times, and waits for its turn before that. So
/// answers are late by the calls, up to what they waited.
Outcome<Valley> calls_roughly(const FitTalk& talk, const DeviceOptions& options) {
  const ValleySearch search{
      .least = kLeastCall, .most = kMostCall, .resolution = 1, .is_geometric = true};
  return search.find([&](double call) {
    return talk.play(with_call(options, call)).map([](const TalkReplay& replay) {
      return lateness(replay, kAll, kHeartbeatName);
    });
  });
}

bool depends_on_calls(const Valley& roughly) { return roughly.worst_score > roughly.score * 1.5; }

/// Times of a call, in microseconds.
using CallTimes = std::set<double>;

/// Between least and most, each by `share` longer than the one before.
void add_between(CallTimes& times, double least, double most, double share) {
  for (auto time = least; time <= most; time *= 1 + share) times.insert(std::round(time));
}

/// The time of a call with which all messages come as recorded. `options_with` are those for one.
/// The arm is looked at all the time, so what a command waits for depends on all calls before, and
/// no slope leads to the right one. But the first messages come after a few calls only: those with
/// which these are nearly right are looked at more closely, with more messages, and so on.
Outcome<Valley> calls_exactly(const FitTalk& talk,
                              const std::function<DeviceOptions(double call)>& options_with) {
  struct Look {
    double share;  ///< how far apart
    std::size_t messages;
  };
  static constexpr std::array kLooks{Look{0.01, 4}, Look{0.002, 8}, Look{0.0004, 16},
                                     Look{0.0001, kAll}};
  constexpr std::size_t kKept = 40;
  CallTimes times;
  add_between(times, kLeastCall, kMostCall, kLooks.front().share);
  std::vector<std::pair<double, double>> scores;
  for (std::size_t i = 0; i < kLooks.size(); ++i) {
    scores.clear();
    for (const auto time : times) {
      const auto replay = talk.play(options_with(time));
      if (!replay) return tl::unexpected{replay.error()};
      scores.emplace_back(lateness(*replay, kLooks.at(i).messages, {}), time);
    }
    std::ranges::sort(scores);
    scores.resize(std::min(scores.size(), kKept));
    if (i + 1 == kLooks.size()) break;
    times.clear();
    for (const auto& [score, time] : scores) {
      const auto apart = kLooks.at(i).share;
      add_between(times, time * (1 - apart), time * (1 + apart), kLooks.at(i + 1).share);
    }
  }
  const auto [least_score, best] = scores.front();
  Valley valley{.least = best, .most = best, .score = least_score};
  for (const auto& [score, time] : scores) {
    valley.worst_score = score;
    if (score > least_score) continue;
    valley.least = std::min(valley.least, time);
    valley.most = std::max(valley.most, time);
  }
  return valley;
}

/// How far a message is early or late in the mean, in seconds.
constexpr double kLikeALink = 0.3e-3;  ///< no more than a link adds
constexpr double kExactly = 20e-6;

double in_the_mean(double score, const FitTalk& talk) {
  const auto count = std::ranges::count_if(talk.said, [](const FitTalk::Said& one) {
    return one.message.direction == Direction::kFromDevice;
  });
  return score / static_cast<double>(std::max<std::ptrdiff_t>(count, 1));
}

/// The arm with which answers come as recorded, whatever its calls take.
Outcome<FigureAnswer> plant(const FitTalk& talk, const DeviceOptions& so_far) {
  constexpr double kClearly = 1.2;
  FigureAnswer answer{.estimates = {}, .basis = {}};
  auto least = std::numeric_limits<double>::max();
  auto next = least;
  for (const std::string_view name : {"jaco", "bench"}) {
    const auto calls = calls_roughly(talk, with(so_far, "plant", std::string{name}));
    if (!calls) return tl::unexpected{calls.error()};
    answer.basis += fmt::format("{}answers are {:.3f} s early or late in sum with {}",
                                answer.basis.empty() ? "" : ", ", calls->score, name);
    next = std::min(next, std::max(least, calls->score));
    if (calls->score < least) answer.value = name;
    least = std::min(least, calls->score);
  }
  if (next <= least * kClearly) answer.value.clear();
  return answer;
}

/// A clock, in percent, and the time of a call on it.
struct Pace {
  double percent{};
  double call{};
  double score = std::numeric_limits<double>::max();

  [[nodiscard]] DeviceOptions on(const DeviceOptions& options) const {
    return with(with_call(options, call), "clock", fmt::format("{:.6f}", percent));
  }
  /// Of the recorder's clock. Answers tell it closely.
  [[nodiscard]] double call_outside() const { return call / (1 + percent / 100); }
};

constexpr double kMostPercent = 10;  ///< as the option takes it

/// Most heartbeats come one second after the one before and a number of calls, all on the server's
/// clock: for each number and each time of a call there is one clock with which they do.
Outcome<Pace> pace_by_beats(const FitTalk& talk, const DeviceOptions& options, double period) {
  constexpr int kMostCalls = 4;
  Pace best;
  for (int calls = 0; calls <= kMostCalls && in_the_mean(best.score, talk) > kExactly; ++calls) {
    const auto pace_with = [&](double call) {
      const auto percent = ((1 + calls * call / 1e6) / period - 1) * 100;
      return Pace{std::clamp(percent, -kMostPercent, kMostPercent), call};
    };
    const auto exactly =
        calls_exactly(talk, [&](double call) { return pace_with(call).on(options); });
    if (!exactly) return tl::unexpected{exactly.error()};
    if (exactly->score >= best.score) continue;
    best = pace_with(exactly->least);
    best.score = exactly->score;
  }
  return best;
}

/// Where calls take long most beats wait for something else. How long a call takes outside is known
/// by then, so the clocks around the best one are tried.
Outcome<Pace> pace_nearby(const FitTalk& talk, const DeviceOptions& options, const Pace& known) {
  constexpr double kOff = 2;
  constexpr int kCallsOff = 1;
  auto best = known;
  const auto try_one = [&](double percent, int off) -> Outcome<void> {
    Pace pace{percent, std::round(known.call_outside() * (1 + percent / 100)) + off};
    const auto replay = talk.play(pace.on(options));
    if (!replay) return tl::unexpected{replay.error()};
    pace.score = lateness(*replay, kAll, {});
    if (pace.score < best.score) best = pace;
    return {};
  };
  for (const auto& [around, step] : {std::pair{kOff, 0.001}, std::pair{0.0015, 0.0001}}) {
    const auto middle = around == kOff ? known.percent : best.percent;
    for (auto off = -around; off <= around; off += step) {
      const auto percent = std::clamp(middle + off, -kMostPercent, kMostPercent);
      for (int calls = -kCallsOff; calls <= kCallsOff; ++calls) {
        if (const auto tried = try_one(percent, calls); !tried) {
          return tl::unexpected{tried.error()};
        }
      }
    }
  }
  return best;
}

Outcome<FigureAnswer> clock(const FitTalk& talk, const DeviceOptions& so_far) {
  constexpr std::size_t kFewest = 4;
  constexpr double kStamps = 1e-6;
  constexpr double kOtherClocks = 0.3;  ///< so far apart are those that nearly explain it
  const auto periods = periods_in(talk);
  if (periods.size() < kFewest) {
    return FigureAnswer{.estimates = {},
                        .basis = fmt::format("{} heartbeats follow another one; {} are needed",
                                             periods.size(), kFewest)};
  }
  const auto closest = closest_of(periods);
  const auto period = (closest.front() + closest.back()) / 2;
  const auto noise = closest.back() - closest.front();
  auto basis = fmt::format("{} heartbeats, of which {} are as long up to {:.0f} us", periods.size(),
                           closest.size(), noise * 1e6);
  const auto roughly = calls_roughly(talk, so_far);
  if (!roughly) return tl::unexpected{roughly.error()};
  if (!depends_on_calls(*roughly)) {
    return answer_within((1 / period - 1) * 100, (noise + kStamps) * 100, std::move(basis));
  }
  auto pace = pace_by_beats(talk, so_far, period);
  if (pace && in_the_mean(pace->score, talk) > kExactly) pace = pace_nearby(talk, so_far, *pace);
  if (!pace) return tl::unexpected{pace.error()};
  const auto apart = in_the_mean(pace->score, talk);
  if (apart <= kLikeALink) {
    const auto error = apart <= kExactly ? (noise + kStamps) * 100 : kOtherClocks;
    return answer_within(pace->percent, error, std::move(basis));
  }
  return FigureAnswer{
      .estimates = {},
      .basis = std::move(basis) + "; with no clock and no time of calls do answers come like that"};
}

Outcome<FigureAnswer> call_time(const FitTalk& talk, const DeviceOptions& so_far) {
  const auto roughly = calls_roughly(talk, so_far);
  if (!roughly) return tl::unexpected{roughly.error()};
  const auto depends = depends_on_calls(*roughly);
  const auto valley =
      depends ? calls_exactly(talk, [&](double call) { return with_call(so_far, call); }) : roughly;
  if (!valley) return tl::unexpected{valley.error()};
  const auto middle = std::round((valley->least + valley->most) / 2);
  FigureAnswer answer{.estimates = {{"", middle, valley->least, valley->most}},
                      .basis = fmt::format("messages are {:.3f} s early or late in sum, up to "
                                           "{:.3f} s with others",
                                           valley->score, valley->worst_score)};
  if (!depends || valley->most > valley->least * 1.1) {
    answer.basis += ": too little depends on it";
  } else if (in_the_mean(valley->score, talk) > kLikeALink) {
    answer.basis += ": that explains too little";
  } else {
    answer.value = fmt::format("{:.0f}", middle);
  }
  return answer;
}

constexpr std::array kFigures{
    FitFigure{"plant", "", plant},
    FitFigure{"clock", "%", clock},
    FitFigure{"call-us", "us", call_time},
};

}  // namespace

std::span<const FitFigure> figures() noexcept { return kFigures; }

}  // namespace armjig::kinovazed::shadow
