// SPDX-License-Identifier: Apache-2.0
#include "emulators/shadow/parol6_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "harness/wire/parol6/joints.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::shadow {
namespace {

using namespace std::chrono_literals;
using Micros = std::chrono::duration<double, std::micro>;

/// The board's timer wraps after 93.2 ms, and its clock may be some percent off.
constexpr Duration kLongestInterval = 85ms;
constexpr std::size_t kFewest = 10;

std::int64_t value_of(const Message& message, std::string_view name) {
  const auto* const field = find_field(message.fields, name);
  return field == nullptr ? 0 : field_value(*field, message.raw);
}

bool is_command(const Message& message) {
  return message.direction == Direction::kToDevice && message.fault.empty();
}
bool is_telemetry(const Message& message) {
  return message.direction == Direction::kFromDevice && message.fault.empty();
}

/// Two answers, one after the other, to two frames that came alone.
struct Interval {
  Duration host{};       ///< between the answers
  Duration board{};      ///< between the frames, as the board counted
  Duration latency{};    ///< of the second
  bool goes_on = false;  ///< where the interval before it ended
};

std::vector<Interval> intervals_in(const FitTalk& talk) {
  std::vector<Interval> intervals;
  std::optional<Instant> before;
  std::optional<Instant> asked;
  int commands = 0;
  bool goes_on = false;
  for (const auto& [id, message] : talk.said) {
    if (is_command(message)) {
      asked = message.time;
      ++commands;
      continue;
    }
    if (!is_telemetry(message)) continue;
    const bool is_alone = std::exchange(commands, 0) == 1;
    const auto host = before ? message.time - *before : Duration{};
    const bool is_usable = before && is_alone && host > Duration{} && host < kLongestInterval;
    if (is_usable) {
      const auto timing = static_cast<std::uint16_t>(value_of(message, "timing"));
      intervals.push_back({host, interval_of(timing), message.time - *asked, goes_on});
    }
    goes_on = is_usable;
    before = message.time;
  }
  return intervals;
}

/// What one says with too few of them.
FigureAnswer too_few(std::size_t count) {
  return {.estimates = {},
          .basis = fmt::format("{} answers come within {} ms of the one before; {} are needed",
                               count, kLongestInterval / 1ms, kFewest)};
}

/// The board counts the time between frames: its seconds in one of the recorder's. What a link adds
/// goes away in the sum but for the ends.
Outcome<FigureAnswer> clock(const FitTalk& talk, const DeviceOptions& /*so_far*/) {
  const auto intervals = intervals_in(talk);
  if (intervals.size() < kFewest) return too_few(intervals.size());
  constexpr double kTick = 1e6 / kTicksPerSecond;
  double board = 0;
  double host = 0;
  int chains = 0;
  for (const auto& one : intervals) {
    board += Micros{one.board}.count();
    host += Micros{one.host}.count();
    if (!one.goes_on) ++chains;
  }
  const auto rate = board / host;
  double squares = 0;
  for (const auto& one : intervals) {
    const auto off = Micros{one.board}.count() - rate * Micros{one.host}.count();
    squares += off * off;
  }
  const auto noise = std::sqrt(squares / static_cast<double>(intervals.size()));
  const auto error = (3 * noise * std::sqrt(chains) + chains * kTick) / host * 100;
  const auto percent = (rate - 1) * 100;
  return answer_within(percent, error,
                       fmt::format("{} intervals that the board counted, {:.1f} s, noise {:.1f} us",
                                   intervals.size(), host / 1e6, noise));
}

double rate_of(const DeviceOptions& options) {
  const auto found = options.find("clock");
  return found == options.end() ? 1 : 1 + std::stod(found->second) / 100;
}

/// How far all times between frames, as boards count them, are from those of the recording, in
/// ticks.
double apart_in_timing(const TalkReplay& replay) {
  constexpr double kMost = 100;
  double sum = 0;
  const auto unpaired =
      for_each_pair(replay, [&](const RecordedMessage& one, const RecordedMessage& other) {
        const auto ticks = value_of(one.message, "timing") - value_of(other.message, "timing");
        sum += std::min(kMost, std::abs(static_cast<double>(ticks)));
      });
  return sum + kMost * static_cast<double>(unpaired);
}

/// Those of a few lengths of a pass whose board counts the times of the recording best.
Outcome<std::vector<double>> best_passes(const FitTalk& talk, const DeviceOptions& so_far,
                                         const std::vector<double>& passes) {
  std::vector<double> best;
  auto least = std::numeric_limits<double>::max();
  for (const auto pass : passes) {
    const auto apart =
        talk.play(with(so_far, "pass-us", fmt::format("{:.0f}", pass))).map(apart_in_timing);
    if (!apart) return tl::unexpected{apart.error()};
    if (*apart < least) best.clear();
    least = std::min(least, *apart);
    if (*apart == least) best.push_back(pass);
  }
  return best;
}

/// A frame is answered in the pass that reads it. So answers are whole passes apart, and none takes
/// longer than a pass. Of the few that may be left, one counts time as recorded.
Outcome<FigureAnswer> pass_time(const FitTalk& talk, const DeviceOptions& so_far) {
  constexpr double kLongestPass = 1000;
  constexpr double kStamps = 1.2;  ///< of both ends, in whole microseconds
  constexpr double kShortestPass = 4 * kStamps;
  constexpr std::size_t kFew = 50;
  const auto intervals = intervals_in(talk);
  if (intervals.size() < kFewest) return too_few(intervals.size());
  const auto rate = rate_of(so_far);
  double longest = 0;
  for (const auto& one : intervals) longest = std::max(longest, Micros{one.latency}.count() * rate);
  const auto fits = [&](double pass) {
    return std::ranges::all_of(intervals, [&](const Interval& one) {
      const auto apart = Micros{one.host}.count() * rate;
      return std::abs(apart - std::round(apart / pass) * pass) <= kStamps;
    });
  };
  std::vector<double> passes;
  for (auto pass = std::max(1.0, std::ceil(longest - kStamps)); pass <= kLongestPass; ++pass) {
    if (fits(pass)) passes.push_back(pass);
  }
  if (passes.empty() || passes.back() < kShortestPass) {
    return FigureAnswer{
        .estimates = {},
        .basis = fmt::format("answers take up to {:.0f} us, and their times are no multiple of "
                             "anything: the link is noisier than a pass is long",
                             longest)};
  }
  if (passes.size() > 1 && passes.size() <= kFew) {
    auto best = best_passes(talk, so_far, passes);
    if (!best) return tl::unexpected{best.error()};
    passes = *std::move(best);
  }
  const auto least = passes.front();
  const auto most = passes.back();
  const bool is_told = most <= least * 1.04;
  FigureAnswer answer{.estimates = {{"", (least + most) / 2, least, most}},
                      .basis = fmt::format("{} answers after {:.0f} us at most, whole passes apart",
                                           intervals.size(), longest)};
  if (is_told) {
    answer.value = fmt::format("{:.0f}", (least + most) / 2);
  } else {
    answer.basis += "; the host's frames came at too steady a pace to tell more";
  }
  return answer;
}

/// A joint that came to its switch between two answers.
struct Contact {
  std::size_t joint{};
  std::size_t answer{};  ///< the first after it, counted from 0
  double least{};        ///< steps from where it stood
  double most{};
};

constexpr std::size_t kBaseJoints = 3;  ///< home together
constexpr double kSlack = 5;            ///< in steps, for times that are not exact

/// The first time that its seek ends: it has another speed then, or is not where it would be.
std::optional<Contact> contact_in(const std::vector<const Message*>& answers,
                                  std::size_t first_homing, std::size_t joint) {
  const auto number = fmt::format(".j{}", joint + 1);
  const auto speed = [&](std::size_t i) { return value_of(*answers[i], "speed" + number); };
  const auto place = [&](std::size_t i) { return value_of(*answers[i], "position" + number); };
  std::int64_t seek = 0;
  for (auto i = first_homing + 1; i < answers.size(); ++i) {
    if (seek == 0 || place(i - 1) == place(first_homing)) {
      seek = speed(i);  // it waits for its turn
      continue;
    }
    const auto gap = Micros{answers[i]->time - answers[i - 1]->time}.count() / 1e6;
    const auto step = static_cast<double>(seek) * gap;
    const auto off = std::abs(static_cast<double>(place(i) - place(i - 1)) - step);
    if (speed(i) == seek && off < std::abs(step) / 2 + kSlack) continue;
    const auto way = std::abs(static_cast<double>(place(i - 1) - place(0)));
    return Contact{joint, i, way, way + std::abs(step) * 1.1 + 2};
  }
  return std::nullopt;
}

/// In the order in which each can be told from those before it: of the base joints the last one
/// ends the wait of the others.
std::vector<Contact> contacts_in(const FitTalk& talk) {
  std::vector<const Message*> answers;
  std::optional<std::size_t> first_homing;
  for (const auto& [id, message] : talk.said) {
    if (is_telemetry(message)) answers.push_back(&message);
    const bool homes = is_command(message) &&
                       value_of(message, "command") == static_cast<std::int64_t>(Command::kHome);
    if (homes && !first_homing) first_homing = answers.size();
  }
  std::vector<Contact> contacts;
  for (std::size_t joint = 0; first_homing && joint < kJointCount; ++joint) {
    if (const auto contact = contact_in(answers, *first_homing, joint)) {
      contacts.push_back(*contact);
    }
  }
  std::ranges::sort(contacts, [](const Contact& one, const Contact& other) {
    const bool is_base = one.joint < kBaseJoints;
    if (is_base != (other.joint < kBaseJoints)) return is_base;
    return is_base ? one.answer > other.answer : one.answer < other.answer;
  });
  return contacts;
}

std::string list_of(const std::vector<FigureEstimate>& estimates) {
  std::string list;
  for (const auto& one : estimates) {
    list += fmt::format("{}{:.0f}", list.empty() ? "" : ",", one.value);
  }
  return list;
}

/// How many answers around a contact have another place or speed of the joint.
double differing(const TalkReplay& replay, const Contact& contact) {
  constexpr std::size_t kBefore = 2;
  constexpr std::size_t kAfter = 60;
  const auto number = fmt::format(".j{}", contact.joint + 1);
  std::size_t index = 0;
  double count = 0;
  for_each_pair(replay, [&](const RecordedMessage& one, const RecordedMessage& other) {
    const auto i = index++;
    if (i + kBefore < contact.answer || i > contact.answer + kAfter) return;
    for (const auto* const name : {"position", "speed"}) {
      if (value_of(one.message, name + number) != value_of(other.message, name + number)) ++count;
    }
  });
  // Who says nothing there is no better.
  return count + (index <= contact.answer ? kAfter * 2.0 : 0);
}

/// The steps that a joint makes from where it stands to its switch when it homes; between two
/// answers it may have made any number, so boards are homed that differ in that.
Outcome<FigureAnswer> to_switch(const FitTalk& talk, const DeviceOptions& so_far) {
  const auto contacts = contacts_in(talk);
  FigureAnswer answer{.estimates = std::vector<FigureEstimate>(kJointCount), .basis = {}};
  std::size_t known = 0;
  for (const auto& contact : contacts) {
    answer.estimates[contact.joint] = {fmt::format("j{}", contact.joint + 1),
                                       std::round((contact.least + contact.most) / 2),
                                       contact.least, contact.most};
  }
  while (known < kJointCount && !answer.estimates[known].part.empty()) ++known;
  answer.estimates.resize(known);
  if (known == 0) {
    answer.basis = "nothing homes from its beginning to joint 1's switch in there";
    return answer;
  }
  for (const auto& contact : contacts) {
    if (contact.joint >= known) continue;
    auto& estimate = answer.estimates[contact.joint];
    const ValleySearch search{.least = contact.least, .most = contact.most};
    const auto valley = search.find([&](double steps) -> Outcome<double> {
      auto tried = answer.estimates;
      tried[contact.joint].value = steps;
      return talk.play(with(so_far, "to-switch", list_of(tried)))
          .map([&](const TalkReplay& replay) { return differing(replay, contact); });
    });
    if (!valley) return tl::unexpected{valley.error()};
    estimate.least = valley->least;
    estimate.most = valley->most;
    estimate.value = std::round((valley->least + valley->most) / 2);
  }
  answer.value = list_of(answer.estimates);
  answer.basis = fmt::format("{} joints that came to their switches", known);
  return answer;
}

constexpr std::array kFigures{
    FitFigure{"clock", "%", clock},
    FitFigure{"pass-us", "us", pass_time},
    FitFigure{"to-switch", "steps", to_switch},
};

}  // namespace

std::span<const FitFigure> figures() noexcept { return kFigures; }

}  // namespace armjig::parol6::shadow
