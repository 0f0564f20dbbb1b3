// SPDX-License-Identifier: Apache-2.0
#include "harness/summary/session_timeline.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "harness/wire/append_text.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMostSampled = 2000;
constexpr std::size_t kMostMarks = 1000;  // of a lane
constexpr std::int64_t kMostBins = 2000;  // more than a screen has columns there
constexpr std::size_t kMostCurves = 96;
constexpr std::size_t kMostStates = 1024;
constexpr std::size_t kMostCharts = 6;
constexpr std::size_t kMostLetters = 600;  // of a message
/// Equal commands that come faster than this are one that goes on.
constexpr Duration kPause = 500ms;

/// Whether the number says how much of something there is.
bool is_quantity(const Field& field) noexcept {
  switch (field.encoding) {
    case Encoding::kSigned:
    case Encoding::kFloatLittle:
      return true;
    case Encoding::kUnsigned:
    case Encoding::kUnsignedLittle:
      return !field.unit.empty();
    default:
      return false;
  }
}

/// What is asked for: the name, and the words in the message that are no part of something.
std::string command_text(const Message& message) {
  std::string text{message.name};
  for (const auto& field : message.fields) {
    if (field.encoding != Encoding::kCode || field.name.find('.') != std::string_view::npos)
      continue;
    const auto value = field_value(field, message.raw);
    const auto named = std::ranges::find(field.values, value, &NamedValue::value);
    if (named == field.values.end()) {
      text += fmt::format(" {}", value);
    } else if (named->name != message.name) {
      text += fmt::format(" {}", named->name);
    }
  }
  return text;
}

/// Two neighbours become one.
template <class Item, class Join>
void halve(std::vector<Item>& items, Join join) {
  for (std::size_t i = 0; i < items.size(); i += 2) {
    auto item = std::move(items[i]);
    if (i + 1 < items.size()) join(item, items[i + 1]);
    items[i / 2] = std::move(item);
  }
  items.resize((items.size() + 1) / 2);
}

}  // namespace

std::string SessionTimeline::who(const CaptureLink& link, std::uint32_t id) {
  if (first_link_.empty()) first_link_ = link.name;
  std::string text;
  if (link.name != first_link_) text = link.name + ' ';
  if (link.kind == LinkKind::kBus) text += fmt::format("0x{:02X} ", id);
  if (link.kind == LinkKind::kSession && id > 0) text += fmt::format("#{} ", id);
  return text;
}

TimelineMessage SessionTimeline::keep(Instant time, std::string direction, std::string text,
                                      bool is_bad) {
  if (text.size() > kMostLetters) text = text.substr(0, kMostLetters) + " ...";
  TimelineMessage message{count_++, seconds(time), std::move(direction), std::move(text), is_bad};
  if (message.number % every_ != 0) return message;
  sample_.push_back(message);
  if (sample_.size() > kMostSampled) {
    every_ *= 2;
    std::erase_if(sample_, [this](const auto& kept) { return kept.number % every_ != 0; });
  }
  return message;
}

void SessionTimeline::mark(LaneName lane, Instant time, std::string text,
                           const TimelineMessage& message) {
  auto& marks = lanes_[lane];
  if (lane == kCommands && !marks.empty() && marks.back().text == text &&
      time - marks.back().end <= kPause) {
    marks.back().end = time;
    ++marks.back().count;
    return;
  }
  marks.push_back({time, time, 1, std::move(text), message});
  if (marks.size() <= kMostMarks) return;
  has_merged_ = true;
  halve(marks, [](Mark& one, const Mark& other) {
    one.end = other.end;
    one.count += other.count;
  });
}

void SessionTimeline::add(const CaptureLink& link, std::uint32_t id, const Message& message) {
  const auto from = who(link, id);
  auto text = from;
  const bool is_bad = !message.fault.empty();
  append_content(text, message);
  const bool is_command = message.direction == Direction::kToDevice;
  const auto kept =
      keep(message.time, is_command ? "to device" : "from device", std::move(text), is_bad);
  if (is_bad) return mark(kFindings, message.time, from + message.fault, kept);
  take_curves(from, message);
  if (is_command) return mark(kCommands, message.time, from + command_text(message), kept);
  const bool is_answer = std::ranges::all_of(message.fields, [](const Field& field) {
    return field.encoding == Encoding::kCode || field.encoding == Encoding::kLiteral;
  });
  if (is_answer) return mark(kAnswers, message.time, from + std::string{message.name}, kept);
  take_states(from, message, kept);
}

void SessionTimeline::add_event(const CaptureRecord& record) {
  const std::string details{record.details.substr(0, kMostLetters)};
  mark(kEvents, record.time, details, keep(record.time, "event", details, false));
}

void SessionTimeline::take_states(const std::string& who, const Message& message,
                                  const TimelineMessage& kept) {
  for (const auto& field : message.fields) {
    if (!is_state(field)) continue;
    const auto now = field_value(field, message.raw);
    const std::pair key{who + std::string{message.name}, &field};
    const auto known = states_.find(key);
    if (known == states_.end()) {
      if (states_.size() < kMostStates) states_[key] = now;
      continue;
    }
    const auto before = std::exchange(known->second, now);
    if (before == now) continue;
    mark(kStates, message.time,
         fmt::format("{}{}: {} -> {}", who, field.name, field_text(field, before),
                     field_text(field, now)),
         kept);
  }
}

void SessionTimeline::take_curves(const std::string& who, const Message& message) {
  for (const auto& field : message.fields) {
    if (!is_quantity(field)) continue;
    const auto value = number_of(field, field_value(field, message.raw));
    if (!std::isfinite(value)) continue;
    const auto dot = field.name.rfind('.');
    const bool has_dot = dot != std::string_view::npos;
    auto& chart =
        charts_[{message.direction, std::string{message.name},
                 std::string{has_dot ? field.name.substr(0, dot) : ""}, std::string{field.unit}}];
    if (chart.curves.empty()) chart.order = curves_;
    const auto name = who + std::string{has_dot ? field.name.substr(dot + 1) : field.name};
    auto found = chart.curves.find(name);
    if (found == chart.curves.end()) {
      if (curves_ >= kMostCurves) continue;
      found = chart.curves.emplace(name, Curve{curves_++, {}}).first;
    }
    while (message.time.time_since_epoch() / width_ >= kMostBins) widen();
    const auto number = message.time.time_since_epoch() / width_;
    auto& bins = found->second.bins;
    if (bins.empty() || bins.back().number != number) {
      bins.push_back({number, value, value});
    } else {
      bins.back().least = std::min(bins.back().least, value);
      bins.back().most = std::max(bins.back().most, value);
    }
  }
}

/// Stretches of twice the length.
void SessionTimeline::widen() {
  width_ *= 2;
  for (auto& [key, chart] : charts_) {
    for (auto& [name, curve] : chart.curves) {
      std::vector<Bin> wider;
      for (auto bin : curve.bins) {
        bin.number /= 2;
        if (wider.empty() || wider.back().number != bin.number) {
          wider.push_back(bin);
          continue;
        }
        wider.back().least = std::min(wider.back().least, bin.least);
        wider.back().most = std::max(wider.back().most, bin.most);
      }
      curve.bins = std::move(wider);
    }
  }
}

Timeline SessionTimeline::timeline(std::string title, Instant end) const {
  Timeline line{.title = std::move(title), .seconds = seconds(end)};

  // What stays as it was is not worth a curve, and most curves together come first.
  std::vector<std::pair<const ChartKey*, const Chart*>> charts;
  for (const auto& [key, chart] : charts_) {
    const bool moves = std::ranges::any_of(chart.curves, [](const auto& named) {
      const auto& bins = named.second.bins;
      return std::ranges::any_of(bins, [&bins](const Bin& bin) {
        return bin.least != bins.front().least || bin.most != bins.front().least;
      });
    });
    if (moves) charts.emplace_back(&key, &chart);
  }
  std::ranges::stable_sort(charts, [](const auto& one, const auto& other) {
    const auto rank = [](const auto& named) {
      return std::tuple{-static_cast<int>(named.second->curves.size()),
                        std::get<0>(*named.first) == Direction::kToDevice, named.second->order};
    };
    return rank(one) < rank(other);
  });
  for (const auto& [key, chart] : charts) {
    const auto& [direction, message, group, unit] = *key;
    const auto name =
        message + (group.empty() ? "" : ' ' + group) + (unit.empty() ? "" : " / " + unit);
    if (line.charts.size() >= kMostCharts) {
      line.left_out += fmt::format("{} {}", line.left_out.empty() ? "Not drawn:" : ",", name);
      continue;
    }
    TimelineChart drawn{name, {}};
    std::vector<std::pair<std::size_t, TimelineCurve>> curves;
    for (const auto& [curve_name, curve] : chart->curves) {
      TimelineCurve points{curve_name, {}};
      for (const auto& bin : curve.bins) {
        const auto middle = at(width_ * bin.number + width_ / 2);
        points.stretches.push_back({std::min(seconds(middle), line.seconds), bin.least, bin.most});
      }
      curves.emplace_back(curve.order, std::move(points));
    }
    std::ranges::sort(curves, {}, [](const auto& curve) { return curve.first; });
    for (auto& [order, curve] : curves) drawn.curves.push_back(std::move(curve));
    line.charts.push_back(std::move(drawn));
  }
  if (!line.left_out.empty()) line.left_out += ". ";

  constexpr std::string_view kTitles[] = {"commands", "answers", "states", "events", "findings"};
  line.messages = sample_;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (lanes_[lane].empty()) continue;
    TimelineLane shown{std::string{kTitles[lane]}, lane == kFindings, {}};
    for (const auto& mark : lanes_[lane]) {
      auto text = mark.text;
      if (mark.count > 1) text += fmt::format(" and {} more", mark.count - 1);
      shown.marks.push_back(
          {seconds(mark.begin), seconds(mark.end), std::move(text), mark.message.number});
      line.messages.push_back(mark.message);
    }
    line.lanes.push_back(std::move(shown));
  }
  std::ranges::sort(line.messages, {}, &TimelineMessage::number);
  const auto same = std::ranges::unique(line.messages, {}, &TimelineMessage::number);
  line.messages.erase(same.begin(), same.end());
  if (line.messages.size() < count_) {
    line.left_out += fmt::format(
        "{} of {} messages are listed: those that a mark names, and one in {} of the others. "
        "'armjig "
        "decode' has all. ",
        line.messages.size(), count_, every_);
  }
  if (has_merged_)
    line.left_out += "Where marks were too many, one stands for several neighbours. ";
  if (width_ > 1ms) {
    line.left_out += fmt::format("Curves show least and most of each {:.3g} ms.",
                                 1e3 * std::chrono::duration<double>{width_}.count());
  }
  return line;
}

}  // namespace armjig
