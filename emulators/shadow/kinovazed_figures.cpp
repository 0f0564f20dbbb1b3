// SPDX-License-Identifier: Apache-2.0
#include "emulators/shadow/kinovazed_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <vector>

#include "harness/core/median.hpp"
#include "harness/wire/kinovazed/vocabulary.hpp"

namespace armjig::kinovazed::shadow {
namespace {

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

/// A heartbeat comes one second after the one before, on the server's clock, unless a command keeps
/// the arm busy just then; so most are right.
Outcome<FigureAnswer> clock(const FitTalk& talk, const DeviceOptions& /*so_far*/) {
  constexpr double kMostOff = 0.11;
  constexpr std::size_t kFewest = 5;
  std::map<std::uint32_t, Instant> last;
  std::vector<double> periods;
  for (const auto& [id, message] : talk.said) {
    if (message.name != kHeartbeatName) continue;
    const auto [before, is_first] = last.try_emplace(id, message.time);
    const auto period = Seconds{message.time - before->second}.count();
    if (!is_first && std::abs(period - 1) < kMostOff) periods.push_back(period);
    before->second = message.time;
  }
  if (periods.size() < kFewest) {
    return FigureAnswer{.estimates = {},
                        .basis = fmt::format("{} heartbeats follow another one; {} are needed",
                                             periods.size(), kFewest)};
  }
  const auto period = median_of(periods);
  std::vector<double> off;
  for (const auto one : periods) off.push_back(std::abs(one - period));
  constexpr double kStamps = 1e-6;
  const auto noise = 1.5 * median_of(off);
  const auto error = 3 * (noise + kStamps) / std::sqrt(static_cast<double>(periods.size())) * 100;
  const auto percent = (1 / period - 1) * 100;
  return answer_within(percent, error,
                       fmt::format("{} heartbeats, noise {:.0f} us", periods.size(), noise * 1e6));
}

Outcome<FigureAnswer> plant(const FitTalk& talk, const DeviceOptions& so_far) {
  static constexpr std::array<std::string_view, 2> kPlants{"jaco", "bench"};
  return choose_word(talk, so_far, "plant", kPlants, 20ms);
}

/// How much earlier or later all answers to commands come, in seconds. One that takes long is the
/// arm's motion, and says little of calls.
double lateness(const TalkReplay& replay) {
  constexpr double kMotion = 0.25;
  double sum = 0;
  for_each_pair(replay, [&](const RecordedMessage& one, const RecordedMessage& other) {
    if (one.message.name == kHeartbeatName) return;
    sum += std::min(kMotion, std::abs(Seconds{one.message.time - other.message.time}.count()));
  });
  return sum;
}

/// Each command waits for the arm and calls it a certain number of times, so its answers are late
/// by that.
Outcome<FigureAnswer> call_time(const FitTalk& talk, const DeviceOptions& so_far) {
  const ValleySearch search{.least = 50, .most = 50'000, .resolution = 1, .is_geometric = true};
  const auto valley = search.find([&](double microseconds) {
    return talk.play(with(so_far, "call-us", fmt::format("{:.0f}", microseconds))).map(lateness);
  });
  if (!valley) return tl::unexpected{valley.error()};
  const auto middle = std::round((valley->least + valley->most) / 2);
  FigureAnswer answer{.estimates = {{"", middle, valley->least, valley->most}},
                      .basis = fmt::format("answers are {:.3f} s early or late in sum, up to "
                                           "{:.3f} s with others",
                                           valley->score, valley->worst_score)};
  if (valley->worst_score > valley->score * 1.5 && valley->most <= valley->least * 1.1) {
    answer.value = fmt::format("{:.0f}", middle);
  } else {
    answer.basis += ": too little depends on it";
  }
  return answer;
}

constexpr std::array kFigures{
    FitFigure{"clock", "%", clock},
    FitFigure{"call-us", "us", call_time},
    FitFigure{"plant", "", plant},
};

}  // namespace

std::span<const FitFigure> figures() noexcept { return kFigures; }

}  // namespace armjig::kinovazed::shadow
