// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/script.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "harness/capture/capture.hpp"
#include "harness/core/hex.hpp"
#include "harness/core/version.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig::campaign {
namespace {

std::string event_of(const KeptRecord& record) {
  auto name = text_in(record, "dir");
  return name.empty() ? text_in(record, "op") : name;
}

bool is_border(std::string_view event) { return event == "connect" || event == "disconnect"; }

/// Whether the host does it.
bool is_done_by_host(const KeptRecord& record) {
  switch (record.kind) {
    case LinkKind::kStream:
    case LinkKind::kSession:
      return record.direction == Direction::kToDevice;
    case LinkKind::kBus:
      return true;
    case LinkKind::kCan:
      return false;
    case LinkKind::kEvents:
      break;
  }
  return !text_in(record, "text").starts_with("device-") && event_of(record) != "note";
}

/// Without the time as its recording wrote it, which would be written again whatever the record's
/// own becomes.
std::string without_time(std::string details) {
  if (!details.starts_with(R"("t_ms":)")) return details;
  const auto end = details.find(',');
  return end == std::string::npos ? std::string{} : details.substr(end + 1);
}

/// What the host does in it: of a read how much is wanted, and nothing of what came.
KeptRecord as_done(KeptRecord record) {
  record.time =
      Instant{std::chrono::floor<std::chrono::microseconds>(record.time.time_since_epoch())};
  record.details = without_time(std::move(record.details));
  if (record.kind == LinkKind::kEvents) record.direction = Direction::kToDevice;
  if (record.kind != LinkKind::kBus) return record;
  const bool goes_on = record.details.find(R"("stop":false)") != std::string::npos;
  const bool is_read = record.direction == Direction::kFromDevice;
  const auto wanted = std::max<std::int64_t>(std::ssize(record.bytes), number_in(record, "n", 0));
  record.details = is_read ? fmt::format(R"("n":{},"ack":"")", wanted) : R"("ack":"")";
  if (goes_on) record.details += R"(,"stop":false)";
  if (is_read) record.bytes.clear();
  return record;
}

/// The message by its name and by its code, as a command has.
std::string choice_in(const Message& message) {
  const auto* const code = code_in(message);
  if (code == nullptr) return std::string{message.name};
  const auto* const named = name_of_code(message);
  const auto word =
      named == nullptr ? std::to_string(field_value(*code, message.raw)) : std::string{named->name};
  return word == message.name ? word : fmt::format("{} {}", message.name, word);
}

/// The events of both sides as those of one recording: what is answered comes after what was asked.
std::vector<KeptRecord> merged(const Script& script, const std::vector<KeptRecord>& answers) {
  std::vector<KeptRecord> all;
  // A transaction, and how a connection began, are among the answers.
  std::ranges::copy_if(script, std::back_inserter(all), [](const KeptRecord& one) {
    return one.kind != LinkKind::kBus && event_of(one) != "connect";
  });
  std::ranges::copy(answers, std::back_inserter(all));
  std::ranges::stable_sort(all, {}, &KeptRecord::time);
  return all;
}

}  // namespace

Script script_of(const std::vector<KeptRecord>& recording) {
  Script script;
  for (const auto& record : recording) {
    if (is_done_by_host(record)) script.push_back(as_done(record));
  }
  const auto begin = script.empty() ? Instant{} : script.front().time;
  for (auto& record : script) record.time -= begin.time_since_epoch();
  return script;
}

Outcome<Script> read_script(std::string_view recording, const std::string& where) {
  const auto reader = CaptureReader::open(UserFile::of_text(recording, where), where);
  if (!reader) return tl::unexpected{reader.error()};
  std::vector<KeptRecord> records;
  return for_each_record(
             **reader,
             [&](const CaptureRecord& record) { records.push_back(KeptRecord::from(record)); })
      .map([&] { return script_of(records); });
}

Duration length_of(const Script& script) noexcept {
  return script.empty() ? Duration{} : script.back().time.time_since_epoch();
}

void add(Script& script, KeptRecord record, Duration pause) {
  record.time = script.empty() ? Instant{} : script.back().time + pause;
  script.push_back(std::move(record));
}
void add(Script& script, const Script& more) {
  for (const auto& record : more) add(script, record);
}

Script to(std::uint32_t address, Script script) {
  for (auto& record : script) record.id = address;
  return script;
}

Script joined(Script script, const Script& more, Duration pause) {
  const auto begin = script.empty() ? Duration{} : length_of(script) + pause;
  for (auto record : more) {
    record.time += begin;
    script.push_back(std::move(record));
  }
  return script;
}

KeptRecord border(std::string_view dir, std::uint32_t connection, std::string_view how) {
  return {.kind = LinkKind::kEvents,
          .direction = Direction::kToDevice,
          .details = fmt::format(R"("dir":"{}","conn":{},"text":"{}")", dir, connection, how)};
}

bool is_end(const KeptRecord& record) {
  return record.kind == LinkKind::kEvents && event_of(record) == "disconnect";
}

void leave_half_open(KeptRecord& record) {
  if (!is_end(record) || text_in(record, "text") != "client-close") return;
  record.details = fmt::format(R"("dir":"disconnect","conn":{},"text":"client-half-close")",
                               number_in(record, "conn", 0));
}

Script with_ends(Script script) {
  std::set<std::int64_t> open;
  for (const auto& record : script) {
    if (record.kind == LinkKind::kSession) open.insert(record.id);
    if (record.kind != LinkKind::kEvents) continue;
    const auto id = number_in(record, "conn", 0);
    const auto event = event_of(record);
    if (event == "connect") open.insert(id);
    if (event == "disconnect" && text_in(record, "text") != "client-half-close") open.erase(id);
  }
  const auto end = Instant{length_of(script)};
  for (const auto id : open) {
    auto last = border("disconnect", static_cast<std::uint32_t>(id), "client-close");
    last.time = end;
    script.push_back(std::move(last));
  }
  return script;
}

void shift_from(Script& script, std::size_t place, Duration by) {
  if (place >= script.size()) return;
  const auto before = place == 0 ? Instant{} : script[place - 1].time;
  const auto shift = std::max(by, before - script[place].time);
  for (auto i = place; i < script.size(); ++i) script[i].time += shift;
}

Script spaced(Script script, const Spacing& spacing) {
  const auto least_between = [&spacing](const KeptRecord& one, const KeptRecord& next) {
    const bool has_work = spacing.works_on != nullptr && is_sent(one);
    return std::max({spacing.least, has_work ? spacing.works_on(one.bytes) : Duration{},
                     is_end(one) || is_end(next) ? spacing.around_ends : Duration{}});
  };
  for (std::size_t i = 1; i < script.size(); ++i) {
    const auto missing =
        least_between(script[i - 1], script[i]) - (script[i].time - script[i - 1].time);
    if (missing > Duration{}) shift_from(script, i, missing);
  }
  return script;
}

bool is_sent(const KeptRecord& record) noexcept {
  return record.kind != LinkKind::kEvents && record.direction == Direction::kToDevice;
}

bool is_by_hand(const KeptRecord& record) {
  return record.kind == LinkKind::kEvents && !is_border(event_of(record)) &&
         event_of(record) != "recover";
}

std::vector<Message> messages_in(const KeptRecord& record, Dissector& dissector) {
  std::vector<Message> messages;
  if (!is_sent(record)) return messages;
  auto bytes = record.bytes;
  if (record.kind == LinkKind::kBus) {
    const BusAddress address{static_cast<std::uint8_t>(record.id)};
    bytes.insert(bytes.begin(), head_of(write_to(address, {})));
  }
  dissector.feed(Direction::kToDevice, record.time, bytes, messages);
  return messages;
}

const Field* code_in(const Message& message) {
  const auto found = std::ranges::find_if(message.fields, [](const Field& field) {
    return field.encoding == Encoding::kCode && !field.values.empty();
  });
  return found == message.fields.end() ? nullptr : &*found;
}

const NamedValue* name_of_code(const Message& message) {
  const auto* const code = code_in(message);
  if (code == nullptr) return nullptr;
  const auto named =
      std::ranges::find(code->values, field_value(*code, message.raw), &NamedValue::value);
  return named == code->values.end() ? nullptr : &*named;
}

std::string words_of(const KeptRecord& record, MakeDissector make_dissector) {
  if (record.kind == LinkKind::kEvents) {
    auto words = event_of(record);
    for (const auto* const key : {"name", "event", "call", "text"}) {
      if (const auto more = text_in(record, key); !more.empty() && more != "ok")
        words += " " + more;
    }
    return words;
  }
  if (!is_sent(record)) return fmt::format("read of {} bytes", number_in(record, "n", 0));
  const auto dissector = make_dissector();
  auto messages = messages_in(record, *dissector);
  if (messages.empty()) dissector->finish(messages);
  if (messages.empty()) return fmt::format("{} bytes", record.bytes.size());
  const auto& last = messages.back();
  const auto word = last.fault.empty() ? choice_in(last) : "noise";
  return messages.size() == 1
             ? word
             : fmt::format("{} messages at once, the last {}", messages.size(), word);
}

std::string to_recording(const RecordingFacts& facts, const Script& script,
                         const std::vector<KeptRecord>& answers) {
  // What says "capture" is like what --capture wrote: all that is needed for it is in the header.
  const nlohmann::ordered_json header{{"format", "golden-trace/1"},
                                      {"device", facts.device},
                                      {"title", "capture"},
                                      {"source", facts.source},
                                      {"target", facts.target}};
  const auto writer = make_capture_writer(CaptureFormat::kLines);
  std::string text;
  const CaptureHeader head{header.dump(), facts.device, 0};
  if (!writer->begin(head, text)) return {};
  for (const auto& record : merged(script, answers)) {
    const CaptureLink link{facts.device, facts.device, record.kind};
    (void)writer->add(record.on(link), {}, text);  // lines hold whatever there is
  }
  return text;
}

}  // namespace armjig::campaign
