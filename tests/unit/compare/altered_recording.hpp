// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/replay/kept_record.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/capture/capture.hpp"
#include "harness/capture/trace.hpp"
#include "harness/compare/recording_diff.hpp"
#include "harness/core/hex.hpp"
#include "harness/files/user_file.hpp"
#include "tests/portable/recorded_devices.hpp"

/// One place of a recording, or of what an emulator answers, is changed at random, and who compares
/// has to find it and to say where it is.
namespace armjig::test {

/// The same numbers on every machine.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_{seed} {}
  /// 0 to `count - 1`; `count > 0`.
  [[nodiscard]] std::size_t below(std::size_t count) { return engine_() % count; }
  [[nodiscard]] std::byte change() { return static_cast<std::byte>(1 + below(255)); }
  [[nodiscard]] bool flip() { return below(2) == 0; }

 private:
  std::mt19937_64 engine_;
};

enum class Altered : std::uint8_t { kByte, kLength, kTime, kAcknowledge };
inline constexpr std::array kAlterations{Altered::kByte, Altered::kLength, Altered::kTime,
                                         Altered::kAcknowledge};

[[nodiscard]] inline std::string_view to_string(Altered what) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"byte", "length", "time", "acknowledge"};
  return kNames.at(static_cast<std::size_t>(what));
}

using Records = std::vector<KeptRecord>;

/// All of a file. Links of one kind are one, as in captures/.
struct ReadRecording {
  std::map<LinkKind, CaptureLink> links;
  Records records;
};

[[nodiscard]] inline Outcome<ReadRecording> read_recording(const std::string& path) {
  auto file = UserFile::open(path);
  if (!file) return tl::unexpected{file.error()};
  const auto reader = CaptureReader::open(*std::move(file), path);
  if (!reader) return tl::unexpected{reader.error()};
  ReadRecording recording;
  return for_each_record(**reader,
                         [&](const CaptureRecord& record) -> Outcome<void> {
                           recording.links.emplace(record.link->kind, *record.link);
                           recording.records.push_back(KeptRecord::from(record));
                           return {};
                         })
      .map([&] { return std::move(recording); });
}

// What is changed of bytes, of a record or an event. Each answers whether there was anything.

[[nodiscard]] inline bool alter_byte(std::vector<std::byte>& bytes, Chance& chance) {
  if (bytes.empty()) return false;
  bytes[chance.below(bytes.size())] ^= chance.change();
  return true;
}

/// One more, or one less.
[[nodiscard]] inline bool alter_length(std::vector<std::byte>& bytes, Chance& chance) {
  if (bytes.empty()) return false;
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(chance.below(bytes.size()));
  chance.flip() ? bytes.erase(place) : bytes.insert(place, chance.change());
  return true;
}

/// One letter of `AAN` between two places of a text.
[[nodiscard]] inline bool alter_acknowledge(std::string& text, std::size_t begin, std::size_t end,
                                            Chance& chance) {
  if (begin >= end) return false;
  auto& letter = text[begin + chance.below(end - begin)];
  letter = letter == 'A' ? 'N' : 'A';
  return true;
}

/// As far as the records before and after it let it.
[[nodiscard]] inline bool alter_time(Records& records, std::size_t i, Chance& chance) {
  using Micros = std::chrono::microseconds;
  constexpr Duration kBehindTheLast = std::chrono::seconds{1};
  auto& time = records[i].time;
  const auto least = i == 0 ? Instant{} : records[i - 1].time;
  const auto most = i + 1 == records.size() ? time + kBehindTheLast : records[i + 1].time;
  const auto room = std::chrono::duration_cast<Micros>(most - least).count();
  const auto altered = least + Micros{chance.below(static_cast<std::size_t>(room) + 1)};
  return std::exchange(time, altered) != altered;
}

[[nodiscard]] inline bool alter(Records& records, std::size_t i, Altered what, Chance& chance) {
  auto& [time, kind, direction, id, bytes, details] = records[i];
  if (what == Altered::kByte) return alter_byte(bytes, chance);
  if (what == Altered::kLength) return alter_length(bytes, chance);
  if (what == Altered::kTime) return alter_time(records, i, chance);
  constexpr std::string_view kKey = R"("ack":")";
  const auto key = details.find(kKey);
  if (key == std::string::npos) return false;
  const auto begin = key + kKey.size();
  return alter_acknowledge(details, begin, details.find('"', begin), chance);
}

/// What is to be found, and where.
struct AlteredRecords {
  Records records;
  std::size_t place{};
  Altered what{};
};

[[nodiscard]] inline AlteredRecords altered(const Records& records, Chance& chance) {
  for (;;) {
    AlteredRecords altered{records, chance.below(records.size()),
                           kAlterations.at(chance.below(kAlterations.size()))};
    if (alter(altered.records, altered.place, altered.what, chance)) return altered;
  }
}

[[nodiscard]] inline RecordedMessages first_messages(const ReadRecording& recording,
                                                     const Records& records, std::size_t count) {
  RecordedMessages messages{[](std::string_view name) {
    Trace trace;
    trace.device = name;
    const auto* const device = recorded_device(trace);
    return device == nullptr ? nullptr : device->make_dissector;
  }};
  for (const auto& record : records | std::views::take(count)) {
    (void)messages.add(record.on(recording.links.at(record.kind)));
  }
  return messages;
}

/// The messages of a lane that a record may have a part in: those that end in it, and the next.
class Place {
 public:
  Place(const ReadRecording& recording, std::size_t place) {
    const auto& record = recording.records[place];
    const bool is_event = record.kind == LinkKind::kEvents;
    lane_ = is_event ? fmt::format(" {} ", armjig::to_string(record.kind))
                     : fmt::format(" {} {} {}", armjig::to_string(record.kind), record.id,
                                   armjig::to_string(record.direction));
    first_ = size_of(first_messages(recording, recording.records, place));
    last_ = size_of(first_messages(recording, recording.records, place + 1));
  }

  [[nodiscard]] bool has(const RecordingDifference& one, const RecordedMessages& before,
                         const RecordedMessages& after) const {
    if (one.lane.find(lane_) == std::string::npos) return false;
    const auto* const said = one.before != nullptr ? one.before : one.after;
    const auto& messages = (one.before != nullptr ? before : after).lanes().at(one.lane);
    const auto index = static_cast<std::size_t>(said - messages.data());
    return index >= first_ && index <= last_;
  }

 private:
  [[nodiscard]] std::size_t size_of(const RecordedMessages& messages) const {
    for (const auto& [name, said] : messages.lanes()) {
      if (name.find(lane_) != std::string::npos) return said.size();
    }
    return 0;
  }

  std::string lane_;
  std::size_t first_{};
  std::size_t last_{};
};

/// The field that alone differs; empty if there is none.
[[nodiscard]] inline std::string_view only_field_of(const Message& before, const Message& after) {
  if (before.raw.size() != after.raw.size() || before.fields.data() != after.fields.data()) {
    return {};
  }
  const auto place = static_cast<std::size_t>(std::ranges::mismatch(before.raw, after.raw).in1 -
                                              before.raw.begin());
  const auto field = std::ranges::find_if(before.fields, [place](const Field& one) {
    return one.place == armjig::Place::kBytes && place >= one.offset &&
           place < std::size_t{one.offset} + one.width;
  });
  return field == before.fields.end() ? std::string_view{} : field->name;
}

/// Whether the difference says what was altered. What is missing or extra names all of itself.
[[nodiscard]] inline bool names(const RecordingDifference& one, Altered what) {
  if (one.change != Change::kChanged) return true;
  const auto has = [&one](std::string_view begin) {
    return std::ranges::any_of(
        one.what, [begin](const std::string& said) { return said.starts_with(begin); });
  };
  if (what == Altered::kTime) return has("time: ");
  if (what == Altered::kAcknowledge) return has("note: ");
  const auto field = only_field_of(one.before->message, one.after->message);
  return field.empty() ? has("bytes: ") || has("rest: ") || !one.what.empty()
                       : has(fmt::format("{}: ", field));
}

/// What is wrong with what `diff` says of one place that is altered; empty if nothing is.
[[nodiscard]] inline std::string complaint_about_diff(const ReadRecording& recording,
                                                      Chance& chance) {
  const auto altered = test::altered(recording.records, chance);
  auto before = first_messages(recording, recording.records, recording.records.size());
  auto after = first_messages(recording, altered.records, altered.records.size());
  before.finish();
  after.finish();
  const auto found = diff(before, after, {});
  const Place place{recording, altered.place};
  const auto about =
      fmt::format("{} of record {}", to_string(altered.what), altered.place);  // from 0
  if (found.empty()) return about + " is not found";
  const auto named = std::ranges::find_if(
      found, [&](const RecordingDifference& one) { return place.has(one, before, after); });
  if (named == found.end()) return about + " is found elsewhere, first in " + found.front().lane;
  return names(*named, altered.what) ? "" : about + " is not named";
}

/// Whether the recordings' own rules leave it free (captures/kinovazed/README.md): when a server
/// beats, and what it says then beside a change; a last beat may be one that only one side has.
[[nodiscard]] inline bool is_free(const std::vector<TraceEvent>& events, std::size_t k,
                                  Altered what) {
  constexpr Duration kNear = std::chrono::milliseconds{120};
  constexpr Duration kBeat = std::chrono::seconds{1};
  const auto is_beat = [](const TraceEvent& event) {
    return as_text(event.bytes).starts_with("Heartbeat:");
  };
  const auto& beat = events[k];
  if (!is_beat(beat)) return false;
  const bool is_last = std::ranges::none_of(events, [&](const TraceEvent& other) {
    return is_beat(other) && other.id == beat.id && other.time > beat.time;
  });
  const auto from = beat.time - kNear - (is_last ? kBeat : Duration{});
  return what == Altered::kTime || std::ranges::any_of(events, [&](const TraceEvent& other) {
           return other.dir != "end" && !is_beat(other) && other.time >= from &&
                  other.time <= beat.time + kNear;
         });
}

/// What the device decides of one thing that it said. Answers whether there was anything.
[[nodiscard]] inline bool alter(TraceEvent& event, Altered what, bool has_tolerance,
                                Chance& chance) {
  if (what == Altered::kByte) {
    if (event.bytes.empty() && !event.name.empty()) {
      event.name[chance.below(event.name.size())] ^= 1;
      return true;
    }
    return alter_byte(event.bytes, chance);
  }
  if (what == Altered::kLength) return alter_length(event.bytes, chance);
  if (what == Altered::kAcknowledge) {
    constexpr std::string_view kKey = "ack ";
    return event.text.starts_with(kKey) &&
           alter_acknowledge(event.text, kKey.size(), event.text.size(), chance);
  }
  // Of a bus the master decides it.
  if (!event.dir.ends_with("from_device") && event.dir != "disconnect") return false;
  const auto least =
      has_tolerance ? 100'000 + event.value / 20 : std::int64_t{1};  // 3 % or 60 ms are allowed
  const auto by = least + static_cast<std::int64_t>(chance.below(1'000'000));
  const bool is_later = by > event.value || by > microseconds(event.time) || chance.flip();
  const auto signed_by = is_later ? by : -by;
  event.time += std::chrono::microseconds{signed_by};
  event.value += signed_by;
  return true;
}

[[nodiscard]] inline bool is_same(const std::optional<TraceEvent>& one, const TraceEvent& other) {
  return one && one->line == other.line && one->time == other.time && one->dir == other.dir &&
         one->id == other.id && one->bytes == other.bytes && one->text == other.text &&
         one->name == other.name;
}

/// Whether either may come first (captures/kinovazed/README.md), so that the pair is what differs.
[[nodiscard]] inline bool are_in_a_race(const TraceEvent& one, const TraceEvent& other) {
  constexpr Duration kSameTime = std::chrono::milliseconds{60};
  return one.id == other.id && std::chrono::abs(one.time - other.time) <= kSameTime;
}

/// What is wrong with what `trace verify` says of one answer that is altered, of the recorded
/// device or the emulated one; empty if nothing is. `replayed` has no difference.
[[nodiscard]] inline std::string complaint_about_verify(const Replay& replay, Replayed replayed,
                                                        Chance& chance) {
  const bool has_tolerance = replay.compare != first_difference;
  const bool is_recorded = chance.flip();
  auto& events = is_recorded ? replayed.recorded : replayed.actual;
  for (;;) {
    const auto k = chance.below(events.size());
    const auto what = kAlterations.at(chance.below(kAlterations.size()));
    if (has_tolerance && is_free(events, k, what)) continue;
    const auto before = events[k];
    if (!alter(events[k], what, has_tolerance, chance)) continue;
    const auto altered = events[k];
    const auto found = replay.compare(replayed.recorded, replayed.actual);
    const auto about =
        fmt::format("{} of {} answer {} ({}, {} at {} us)", to_string(what),
                    is_recorded ? "the recorded" : "the emulator's", k, altered.dir + altered.name,
                    to_hex(altered.bytes), microseconds(altered.time));
    if (!found) return about + " is not found";
    const auto& named = is_recorded ? found->expected : found->actual;
    const bool is_named =
        is_same(named, altered) || (has_tolerance && named && are_in_a_race(*named, altered));
    return is_named ? "" : about + " is found elsewhere";
  }
}

/// The recordings of one device, each read when it is asked for first.
class AlteredCorpus {
 public:
  explicit AlteredCorpus(const std::string& folder)
      : files_{find_traces({folder}).value_or(std::vector<std::string>{})} {}

  [[nodiscard]] bool is_empty() const noexcept { return files_.empty(); }

  /// One place of one recording, and one answer of another; empty if both are found and named.
  [[nodiscard]] std::string complaint(std::uint64_t seed) {
    Chance chance{seed};
    const auto& file = files_[chance.below(files_.size())];
    const auto recording = read_recording(file);
    if (!recording) return describe(recording.error());
    auto complaint = complaint_about_diff(*recording, chance);
    const auto& other = files_[chance.below(files_.size())];
    auto second = complaint_about_answer(other, chance);
    if (!complaint.empty()) complaint = fmt::format("seed {}: {}: {}\n", seed, file, complaint);
    if (!second.empty()) complaint += fmt::format("seed {}: {}: {}\n", seed, other, second);
    return complaint;
  }

 private:
  [[nodiscard]] static std::string complaint_about_answer(const std::string& file, Chance& chance) {
    const auto trace = read_trace(file);
    if (!trace) return describe(trace.error());
    const auto& replay = recorded_device(*trace)->replay;
    auto replayed = replay.run(*trace);
    if (!replayed) return describe(replayed.error());
    return replayed->recorded.empty()
               ? ""
               : complaint_about_verify(replay, *std::move(replayed), chance);
  }

  std::vector<std::string> files_;
};

}  // namespace armjig::test
