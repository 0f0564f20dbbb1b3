// SPDX-License-Identifier: Apache-2.0
#include "emulators/shadow/fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <utility>

namespace armjig {
namespace {

constexpr int kGrid = 24;
constexpr int kAround = 2;  ///< so many values on both sides are looked at more closely
constexpr int kMostDecimals = 6;

/// The values of one grid, its ends among them.
class Grid {
 public:
  Grid(double least, double most, double resolution, bool is_geometric)
      : least_{least}, most_{most}, is_geometric_{is_geometric} {
    const auto steps = std::floor((most - least) / resolution + 0.5);
    // A last grid has each value once.
    count_ = static_cast<int>(std::clamp(steps, 1.0, double{kGrid}));
    is_last_ = steps <= kGrid;
    resolution_ = resolution;
  }

  [[nodiscard]] int size() const noexcept { return count_ + 1; }
  [[nodiscard]] bool is_last() const noexcept { return is_last_; }
  [[nodiscard]] double at(int i) const {
    const auto share = static_cast<double>(std::clamp(i, 0, count_)) / count_;
    const auto value = is_geometric_ && !is_last_ ? least_ * std::pow(most_ / least_, share)
                                                  : least_ + (most_ - least_) * share;
    return std::round(value / resolution_) * resolution_;
  }

 private:
  double least_;
  double most_;
  double resolution_{};
  bool is_geometric_;
  bool is_last_ = false;
  int count_{};
};

}  // namespace

Outcome<Fit> fit(std::span<const FitFigure> figures, const FitTalk& talk) {
  Fit all;
  for (const auto& figure : figures) {
    FigureAnswer answer{.estimates = {}, .basis = std::string{figure.untold}};
    if (figure.estimate != nullptr) {
      auto told = figure.estimate(talk, all.options);
      if (!told) return tl::unexpected{told.error()};
      answer = *std::move(told);
    }
    if (!answer.value.empty()) all.options.emplace(figure.option, answer.value);
    all.figures.push_back({figure, std::move(answer)});
  }
  return all;
}

std::string roundest(double least, double most) {
  const auto middle = (least + most) / 2;
  for (int decimals = 0; decimals < kMostDecimals; ++decimals) {
    const auto factor = std::pow(10, decimals);
    const auto rounded = std::round(middle * factor) / factor;
    // Without a sign before zero.
    if (rounded >= least && rounded <= most) return fmt::format("{:.{}f}", rounded + 0.0, decimals);
  }
  return fmt::format("{:.{}f}", middle, kMostDecimals);
}

FigureAnswer answer_within(double value, double error, std::string basis) {
  return {.value = roundest(value - error, value + error),
          .estimates = {{"", value, value - error, value + error}},
          .basis = std::move(basis)};
}

DeviceOptions with(DeviceOptions options, std::string_view name, std::string value) {
  options.insert_or_assign(std::string{name}, std::move(value));
  return options;
}

Outcome<Valley> ValleySearch::find(
    const std::function<Outcome<double>(double value)>& score) const {
  std::map<double, double> scores;
  auto from = least;
  auto to = most;
  for (;;) {
    const Grid grid{from, to, resolution, is_geometric};
    std::vector<double> here;
    for (int i = 0; i < grid.size(); ++i) {
      const auto value = grid.at(i);
      if (!scores.contains(value)) {
        const auto one = score(value);
        if (!one) return tl::unexpected{one.error()};
        scores.emplace(value, *one);
      }
      here.push_back(scores.at(value));
    }
    const auto [best, worst] = std::ranges::minmax_element(here);
    // A plateau is looked at from its beginning to its end.
    const auto first = static_cast<int>(best - here.begin());
    auto last = first;
    while (last + 1 < grid.size() && here[static_cast<std::size_t>(last) + 1] <= *best) ++last;
    if (grid.is_last()) {
      const auto all =
          std::ranges::max_element(scores, {}, [](const auto& entry) { return entry.second; });
      return Valley{grid.at(first), grid.at(last), *best, all->second};
    }
    const auto next_from = grid.at(first - kAround);
    const auto next_to = grid.at(last + kAround);
    if (next_from == from && next_to == to) {  // nothing depends on it
      return Valley{from, to, *best, *worst};
    }
    from = next_from;
    to = next_to;
  }
}

Outcome<FigureAnswer> choose_word(const FitTalk& talk, const DeviceOptions& so_far,
                                  std::string_view option, std::span<const std::string_view> words,
                                  Duration tolerance) {
  FigureAnswer answer{.estimates = {}, .basis = {}};
  ComparisonRules rules;
  rules.time_tolerance = tolerance;
  auto least = std::numeric_limits<std::size_t>::max();
  bool is_told = false;
  for (const auto word : words) {
    const auto replay = talk.play(with(so_far, option, std::string{word}));
    if (!replay) return tl::unexpected{replay.error()};
    const auto count = diff(replay->recorded, replay->emulated, rules).size();
    answer.basis +=
        fmt::format("{}{} of {} messages differ with {}", answer.basis.empty() ? "" : ", ", count,
                    replay->recorded.count(), word);
    is_told = is_told || (!answer.value.empty() && count != least);
    if (count < least) {
      least = count;
      answer.value = word;
    }
  }
  if (!is_told) answer.value.clear();
  return answer;
}

std::size_t for_each_pair(const TalkReplay& replay,
                          const std::function<void(const RecordedMessage& recorded,
                                                   const RecordedMessage& emulated)>& use,
                          std::string_view passed_over) {
  const auto counts = [&](const RecordedMessage& one) {
    return one.message.direction == Direction::kFromDevice && one.message.name != passed_over;
  };
  std::size_t unpaired = 0;
  for (const auto& [lane, messages] : replay.recorded.lanes()) {
    auto recorded = std::views::filter(messages, counts);
    const auto found = replay.emulated.lanes().find(lane);
    static const std::vector<RecordedMessage> kNone;
    auto emulated =
        std::views::filter(found == replay.emulated.lanes().end() ? kNone : found->second, counts);
    auto one = recorded.begin();
    auto other = emulated.begin();
    for (; one != recorded.end() && other != emulated.end(); ++one, ++other) {
      if (one->message.name != other->message.name) break;
      use(*one, *other);
    }
    unpaired += static_cast<std::size_t>(std::ranges::distance(one, recorded.end()));
  }
  return unpaired;
}

}  // namespace armjig
