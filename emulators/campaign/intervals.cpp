// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/intervals.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "emulators/campaign/talk.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

using Seconds = std::chrono::duration<double>;

struct Bounds {
  Seconds least{};
  Seconds most{};
};

/// Of one lane, all of them with as many answers.
class Lane {
 public:
  Lane(const ToldInterval& told, MessagesInOrder target, std::vector<MessagesInOrder> models)
      : told_{told}, target_{std::move(target)}, models_{std::move(models)} {}

  /// What is told with that answer, which is not the first, if it cannot be.
  [[nodiscard]] std::optional<RecordingDifference> difference_at(std::size_t place) const {
    const auto keeps_to_it = [&](const MessagesInOrder& model) {
      return is_possible(model, place);
    };
    if (is_possible(target_, place) || !std::ranges::all_of(models_, keeps_to_it)) {
      return std::nullopt;
    }
    const auto bounds = bounds_of(target_, place);
    const auto ticks = [&](Seconds time) {
      return std::lround(time.count() * told_.ticks_per_second);
    };
    RecordingDifference difference{Change::kChanged, {}, models_.front()[place], target_[place]};
    difference.what = {fmt::format("{}: {} to {} ticks, modulo {:.0f}, {} ticks", told_.field,
                                   ticks(bounds.least), ticks(bounds.most), values(),
                                   value_of(*target_[place]))};
    return difference;
  }

 private:
  [[nodiscard]] const Field& field_of(const RecordedMessage& answer) const {
    return *find_field(answer.message.fields, told_.field);
  }
  [[nodiscard]] std::int64_t value_of(const RecordedMessage& answer) const {
    return field_value(field_of(answer), answer.message.raw);
  }
  [[nodiscard]] double values() const {
    constexpr int kBitsOfAByte = 8;
    return std::ldexp(1, kBitsOfAByte * field_of(*target_.front()).width);
  }

  /// Before that no model has what this is the answer to.
  [[nodiscard]] Instant earliest(std::size_t place) const {
    auto first = Instant::max();
    for (const auto& model : models_) first = std::min(first, model[place]->message.time);
    return first;
  }

  [[nodiscard]] Bounds bounds_of(const MessagesInOrder& said, std::size_t place) const {
    constexpr Seconds kSlack = 1ms;
    constexpr double kOfClock = 0.02;
    const Seconds least = earliest(place) - said[place - 1]->message.time;
    const Seconds most = said[place]->message.time - earliest(place - 1);
    const auto slack = kSlack + kOfClock * most;
    return {std::max(Seconds{}, least - slack), most + slack};
  }

  [[nodiscard]] bool is_possible(const MessagesInOrder& said, std::size_t place) const {
    const auto bounds = bounds_of(said, place);
    const Seconds all{values() / told_.ticks_per_second};
    const Seconds value{static_cast<double>(value_of(*said[place])) / told_.ticks_per_second};
    const auto rounds = std::max(0.0, std::ceil((bounds.least - value) / all));
    return value + rounds * all <= bounds.most;
  }

  const ToldInterval& told_;
  MessagesInOrder target_;
  std::vector<MessagesInOrder> models_;
};

}  // namespace

std::vector<RecordingDifference> false_intervals(const ToldInterval& told,
                                                 const std::vector<RecordedMessages>& models,
                                                 const RecordedMessages& target) {
  std::vector<RecordingDifference> all;
  for (const auto& [name, messages] : target.lanes()) {
    auto said = all_named(told.message, {}, name, target);
    const auto count = said.size();
    std::vector<MessagesInOrder> expected;
    for (const auto& model : models) expected.push_back(all_named(told.message, {}, name, model));
    const auto is_as_many = [&](const MessagesInOrder& some) { return some.size() == count; };
    if (expected.empty() || !std::ranges::all_of(expected, is_as_many)) continue;
    const Lane lane{told, std::move(said), std::move(expected)};
    for (std::size_t place = 1; place < count; ++place) {
      auto found = lane.difference_at(place);
      if (!found) continue;
      found->lane = name;
      all.push_back(*std::move(found));
    }
  }
  return all;
}

}  // namespace armjig::campaign
