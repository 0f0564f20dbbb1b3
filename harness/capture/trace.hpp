// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

class UserFile;

/// One line of a `golden-trace/1` file behind the header. Keys that a line does not have stay at
/// their defaults; keys that nobody knows are passed over.
struct TraceEvent {
  std::size_t line{};  ///< in the file, from 1
  Instant time{};
  std::string dir;  ///< `to_device`, `from_device`, `write`, ...: what happened
  std::vector<std::byte> bytes;
  std::uint32_t id{};  ///< of a CAN frame, the number of a connection, or the address on a bus
  std::string name;    ///< of an input
  std::int64_t value{};
  std::string text;  ///< what bytes do not say, for comparison: acknowledgements, lamps
  std::string json;  ///< the line as it stands there, for keys that only one device has
};

/// A recording as text: JSON Lines, first a header, then events in order of time.
struct Trace {
  std::string path;
  std::string device;
  std::string header;  ///< the first line, JSON
  std::vector<TraceEvent> events;
};

/// Reads the lines of a recording one by one. Problems name `path:line`.
class TraceLines {
 public:
  /// `path` is for messages.
  explicit TraceLines(std::string path) : path_{std::move(path)} {}

  /// The next line, without its end; the first one is the header. Answers whether it is an event.
  [[nodiscard]] Outcome<bool> take(std::string_view line, TraceEvent& event);

  [[nodiscard]] const CaptureHeader& header() const noexcept { return header_; }

 private:
  std::string path_;
  CaptureHeader header_;
  std::size_t number_ = 0;
  Instant last_{};
};

/// Reads a recording, a text or a pcapng file. Problems name `path:line`.
[[nodiscard]] Outcome<Trace> read_trace(const std::string& path);

/// The same from a file that is open; `path` is for messages.
[[nodiscard]] Outcome<Trace> read_trace(UserFile file, const std::string& path);

/// The same from text in memory; `path` is for messages.
[[nodiscard]] Outcome<Trace> parse_trace(std::string path, std::string_view text);

/// The files named `*.jsonl` or `*.pcapng` under each of `paths`, sorted within each; a path that
/// is a file is taken whatever its name.
[[nodiscard]] Outcome<std::vector<std::string>> find_traces(const std::vector<std::string>& paths);

/// What was acknowledged of a `write` or `read` on a bus: the byte with address and direction, then
/// the data bytes. Empty if the address was not, and for any other event.
[[nodiscard]] std::vector<std::byte> bus_message_of(const TraceEvent& event);

/// The same of a record on a bus. Where nobody says what was acknowledged, all was.
[[nodiscard]] std::vector<std::byte> bus_message_of(const CaptureRecord& record);

/// Where what an emulator did first departs from what was recorded.
struct TraceDifference {
  std::optional<TraceEvent> expected;  ///< none: the emulator sent something extra
  std::optional<TraceEvent> actual;    ///< none: the emulator sent nothing more
};

/// Compares events one by one: kind, time, identifier and bytes.
[[nodiscard]] std::optional<TraceDifference> first_difference(
    const std::vector<TraceEvent>& expected, const std::vector<TraceEvent>& actual);

/// The difference for people: line, time, bytes both ways, the fields that differ. Several lines,
/// indented. The dissector is that of the trace's device; nullptr: no fields are told.
[[nodiscard]] std::string describe(const TraceDifference& difference, const Trace& trace,
                                   MakeDissector make_dissector);

}  // namespace armjig
