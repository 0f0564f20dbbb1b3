// SPDX-License-Identifier: Apache-2.0
#include "harness/summary/session_summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/capture/trace.hpp"

namespace armjig {
namespace {

/// So many of each are told; the rest is counted. It is a screen, and memory has an end.
constexpr std::size_t kMostMessages = 64;
constexpr std::size_t kMostFindings = 8;
constexpr std::size_t kMostValues = 64;
constexpr std::size_t kMostChanges = 12;
constexpr std::size_t kMostTalks = 1024;

double seconds(Duration duration) noexcept {
  return std::chrono::duration<double>{duration}.count();
}

double milliseconds(Duration duration) noexcept { return 1e3 * seconds(duration); }

std::size_t index_of(Direction direction) noexcept {
  return direction == Direction::kToDevice ? 0 : 1;
}

/// How often something happened in a second, from the first to the last time.
double rate(std::uint64_t count, Instant first, Instant last) noexcept {
  return count < 2 || last <= first ? 0 : static_cast<double>(count - 1) / seconds(last - first);
}

}  // namespace

/// What is said on one stream, connection or bus.
struct SessionSummary::Talk {
  CaptureLink link;
  std::uint32_t id{};                    ///< of the last record
  std::unique_ptr<Dissector> dissector;  ///< none: nobody knows the device
  std::optional<Instant> asked;          ///< and no answer yet
};

SessionSummary::SessionSummary(FindDissector find_dissector, HearMessage hear)
    : find_dissector_{std::move(find_dissector)}, hear_{std::move(hear)} {}

SessionSummary::~SessionSummary() = default;

SessionSummary::Talk& SessionSummary::talk_of(const CaptureRecord& record) {
  const auto id = record.link->kind == LinkKind::kSession ? record.id : 0;
  auto& talk = talks_[{record.link->name, id}];
  if (talk == nullptr) {
    ++conversations_;
    talk = std::make_unique<Talk>();
    talk->link = *record.link;
    const auto make_dissector = find_dissector_(record.link->device);
    if (make_dissector != nullptr) talk->dissector = make_dissector();
    if (talks_.size() > kMostTalks) {  // a connection that is over, or it will be a new one
      auto oldest = talks_.begin();
      if (oldest->second == talk) ++oldest;
      std::vector<Message> rest;
      if (oldest->second->dissector) oldest->second->dissector->finish(rest);
      for (const auto& message : rest) take(*oldest->second, message);
      talks_.erase(oldest);
    }
  }
  talk->id = record.id;
  return *talk;
}

void SessionSummary::add(const CaptureRecord& record) {
  ++records_;
  end_ = std::max(end_, record.time);
  const auto& link = *record.link;
  if (link.kind == LinkKind::kEvents) {
    ++events_;
    return;
  }
  auto& count = links_[link.kind == LinkKind::kCan ? link.name + " can" : link.name];
  count.device = link.device;
  count.kind = link.kind;
  auto& lane = count.lanes[index_of(record.direction)];
  if (lane.first && record.time - lane.last > lane.longest_gap) {
    lane.longest_gap = record.time - lane.last;
    lane.gap_begin = lane.last;
  }
  if (!lane.first) lane.first = record.time;
  lane.last = record.time;
  ++lane.records;
  lane.bytes += record.bytes.size();
  if (link.kind == LinkKind::kCan) return;

  auto& talk = talk_of(record);
  if (record.direction == Direction::kToDevice) {
    if (!talk.asked) talk.asked = record.time;
  } else if (talk.asked) {
    count.round_trips.record(record.time - *talk.asked);
    talk.asked.reset();
  }
  if (!talk.dissector) return;
  std::vector<Message> messages;
  if (lost_before(record) > 0) {
    talk.dissector->finish(messages);
    talk.dissector = find_dissector_(link.device)();
  }
  if (link.kind == LinkKind::kBus) {
    const auto bytes = bus_message_of(record);
    if (!bytes.empty()) talk.dissector->feed(record.direction, record.time, bytes, messages);
  } else {
    talk.dissector->feed(record.direction, record.time, record.bytes, messages);
  }
  for (const auto& message : messages) take(talk, message);
}

void SessionSummary::finish() {
  for (const auto& [key, talk] : talks_) {
    std::vector<Message> rest;
    if (talk->dissector) talk->dissector->finish(rest);
    for (const auto& message : rest) take(*talk, message);
  }
  talks_.clear();
}

void SessionSummary::take(const Talk& talk, const Message& message) {
  if (hear_) hear_(talk.link, talk.id, message);
  if (!message.fault.empty()) return take_finding(message);
  NameOf name{message.direction, message.name};
  if (messages_.size() < kMostMessages || messages_.contains(name)) {
    auto& count = messages_[std::move(name)];
    if (count.count++ == 0) count.first = message.time;
    count.last = message.time;
  }
  if (message.direction == Direction::kFromDevice) take_values(message);
}

void SessionSummary::take_finding(const Message& message) {
  auto text = fmt::format("{}: {}", to_string(message.direction), message.fault);
  if (findings_.size() < kMostFindings || findings_.contains(text)) {
    ++findings_[std::move(text)];
  } else {
    ++other_findings_;
  }
}

void SessionSummary::take_values(const Message& message) {
  for (const auto& field : message.fields) {
    const bool is_number = is_state(field) || !field.unit.empty();
    if (!is_number || field.encoding == Encoding::kLiteral) continue;
    const auto name = fmt::format("{} {}", message.name, field.name);
    const auto now = field_value(field, message.raw);
    const auto found = values_.find(name);
    if (found == values_.end()) {
      if (values_.size() < kMostValues) values_[name] = {&field, now, now, now, now, 0};
      continue;
    }
    auto& value = found->second;
    if (now == value.last) continue;
    ++value.changes;
    if (is_state(field)) {
      if (changes_.size() < kMostChanges) {
        changes_.push_back(
            {message.time, fmt::format("{}: {} -> {}", name, field_text(field, value.last),
                                       field_text(field, now))});
      } else {
        ++other_changes_;
      }
    }
    value.last = now;
    const auto number = number_of(field, now);
    if (number < number_of(field, value.least)) value.least = now;
    if (number > number_of(field, value.most)) value.most = now;
  }
}

std::string SessionSummary::to_text() const {
  auto text = fmt::format("length       {:.3f} s, {} records, {} events, {} conversations\n",
                          seconds(end_.time_since_epoch()), records_, events_, conversations_);
  for (const auto& [name, link] : links_) {
    text += fmt::format("link         {} ({}{}{})\n", name, to_string(link.kind),
                        link.device.empty() ? "" : ", device ", link.device);
    for (const auto direction : {Direction::kToDevice, Direction::kFromDevice}) {
      const auto& lane = link.lanes[index_of(direction)];
      text += fmt::format("  {:<11}  {} records, {} bytes, {:.1f} a second", to_string(direction),
                          lane.records, lane.bytes,
                          rate(lane.records, lane.first.value_or(Instant{}), lane.last));
      if (lane.longest_gap > Duration::zero()) {
        text += fmt::format("; longest gap {:.1f} ms at {:.3f} s", milliseconds(lane.longest_gap),
                            seconds(lane.gap_begin.time_since_epoch()));
      }
      text += '\n';
    }
    const auto& trips = link.round_trips;
    if (trips.count() > 0) {
      text += fmt::format("  round trips  {}: {} at 50 %, 99 % and the most\n", trips.count(),
                          trips.summary());
    }
  }
  for (const auto direction : {Direction::kToDevice, Direction::kFromDevice}) {
    const char* title = direction == Direction::kToDevice ? "commands" : "messages";
    for (const auto& [name, count] : messages_) {
      if (name.first != direction) continue;
      text += fmt::format("{:<12} {} x {}", std::exchange(title, ""), count.count, name.second);
      const auto often = rate(count.count, count.first, count.last);
      text += often > 0 ? fmt::format(", {:.1f} a second\n", often) : "\n";
    }
  }
  const char* title = "moved";
  for (const auto& [name, value] : values_) {
    if (is_state(*value.field) || value.changes == 0) continue;
    text += fmt::format("{:<12} {}: {} to {}, last {}\n", std::exchange(title, ""), name,
                        field_text(*value.field, value.least), field_text(*value.field, value.most),
                        field_text(*value.field, value.last));
  }
  title = "states";
  for (const auto& change : changes_) {
    text += fmt::format("{:<12} {:.3f} s {}\n", std::exchange(title, ""),
                        seconds(change.time.time_since_epoch()), change.text);
  }
  if (other_changes_ > 0) text += fmt::format("{:<12} {} more changes\n", "", other_changes_);
  title = "findings";
  for (const auto& [what, count] : findings_) {
    text += fmt::format("{:<12} {} x {}\n", std::exchange(title, ""), count, what);
  }
  if (other_findings_ > 0) text += fmt::format("{:<12} {} others\n", "", other_findings_);
  if (findings_.empty()) text += fmt::format("{:<12} none\n", title);
  return text;
}

std::string SessionSummary::to_json() const {
  using Members = nlohmann::ordered_json;
  Members json{{"schema", "armjig.session/1"},
               {"seconds", seconds(end_.time_since_epoch())},
               {"records", records_},
               {"events", events_},
               {"conversations", conversations_}};
  json["links"] = Members::array();
  for (const auto& [name, link] : links_) {
    Members entry{{"name", name}, {"device", link.device}, {"kind", to_string(link.kind)}};
    for (const auto direction : {Direction::kToDevice, Direction::kFromDevice}) {
      const auto& lane = link.lanes[index_of(direction)];
      entry[std::string{to_string(direction)}] = {
          {"records", lane.records},
          {"bytes", lane.bytes},
          {"longest_gap_ms", milliseconds(lane.longest_gap)}};
    }
    const auto& trips = link.round_trips;
    entry["round_trips"] = {{"count", trips.count()},
                            {"median_ms", milliseconds(trips.percentile(50))},
                            {"p99_ms", milliseconds(trips.percentile(99))},
                            {"max_ms", milliseconds(trips.max())}};
    json["links"].push_back(std::move(entry));
  }
  json["messages"] = Members::array();
  for (const auto& [name, count] : messages_) {
    json["messages"].push_back(
        {{"direction", to_string(name.first)}, {"name", name.second}, {"count", count.count}});
  }
  json["moved"] = Members::array();
  for (const auto& [name, value] : values_) {
    if (is_state(*value.field) || value.changes == 0) continue;
    json["moved"].push_back({{"field", name},
                             {"unit", value.field->unit},
                             {"first", number_of(*value.field, value.first)},
                             {"last", number_of(*value.field, value.last)},
                             {"least", number_of(*value.field, value.least)},
                             {"most", number_of(*value.field, value.most)}});
  }
  json["states"] = Members::array();
  for (const auto& change : changes_) {
    json["states"].push_back({{"t_us", microseconds(change.time)}, {"change", change.text}});
  }
  json["findings"] = Members::array();
  for (const auto& [what, count] : findings_) {
    json["findings"].push_back({{"what", what}, {"count", count}});
  }
  return json.dump();
}

}  // namespace armjig
