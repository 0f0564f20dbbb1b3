// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/trace.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/capture/capture.hpp"
#include "harness/capture/pcapng.hpp"
#include "harness/core/hex.hpp"
#include "harness/core/nesting.hpp"
#include "harness/core/overhearer.hpp"
#include "harness/files/user_file.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;

/// Numbers in traces are whole; this keeps sums with them inside 64 bits.
constexpr std::int64_t kLatestMicroseconds = INT64_C(9'000'000'000'000'000);

constexpr std::int64_t kLastBusAddress = 0x7F;

/// The value of an optional key, in the type that the format gives it. What has another type makes
/// `ok` false.
class LineReader {
 public:
  explicit LineReader(const Json& line) : line_{line} {}

  std::int64_t integer(const char* key, std::int64_t least, std::int64_t most) {
    const auto found = line_.find(key);
    if (found == line_.end()) return 0;
    const bool fits = found->is_number_integer() && !is_too_large(*found);
    const auto value = fits ? found->get<std::int64_t>() : 0;
    if (fits && value >= least && value <= most) return value;
    complain(key, "is not a whole number in range");
    return 0;
  }

  std::string text(const char* key) {
    const auto found = line_.find(key);
    if (found == line_.end()) return {};
    if (!found->is_string()) {
      complain(key, "is not a string");
      return {};
    }
    return found->get<std::string>();
  }

  std::vector<std::byte> bytes(const char* key) {
    auto bytes = from_hex(text(key));
    if (bytes) return *std::move(bytes);
    complain(key, describe(bytes.error().code));
    return {};
  }

  void require(const char* key) {
    if (!line_.contains(key)) complain(key, "is missing");
  }

  /// What is wrong with the line; empty if nothing is.
  [[nodiscard]] const std::string& complaint() const noexcept { return complaint_; }

 private:
  static bool is_too_large(const Json& number) {
    return number.is_number_unsigned() && number.get<std::uint64_t>() > INT64_MAX;
  }
  void complain(const char* key, std::string_view what) {
    if (complaint_.empty()) complaint_ = fmt::format("\"{}\" {}", key, what);
  }

  const Json& line_;
  std::string complaint_;
};

auto malformed(const std::string& path, std::size_t line, std::string what) {
  return problem(ErrorCode::kMalformed, fmt::format("{}:{}", path, line), std::move(what));
}

Json parse_object(std::string_view line) {
  auto json = Json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return {};
  return json;
}

/// What a time has besides its microseconds; none where that is no such number.
Duration rest_of_time(const Json& json) {
  constexpr std::int64_t kOneMicrosecond = 1000;
  const auto ns = json.value("ns", Json{});
  if (!ns.is_number_unsigned() || ns >= kOneMicrosecond) return {};
  return Duration{ns.get<std::int64_t>()};
}

Outcome<TraceEvent> parse_event(const std::string& path, std::size_t number,
                                std::string_view line) {
  if (is_too_deep(line)) return malformed(path, number, std::string{kTooDeep});
  const auto json = parse_object(line);
  if (json.is_null()) return malformed(path, number, "the line is not a JSON object");
  LineReader reader{json};
  const bool is_in_milliseconds = json.contains("t_ms");
  if (!is_in_milliseconds) reader.require("t_us");
  const char* const dir = json.contains("op") ? "op" : "dir";
  reader.require(dir);
  TraceEvent event;
  event.line = number;
  event.time =
      at(is_in_milliseconds
             ? Duration{std::chrono::milliseconds{
                   reader.integer("t_ms", 0, kLatestMicroseconds / 1000)}}
             : Duration{std::chrono::microseconds{reader.integer("t_us", 0, kLatestMicroseconds)}} +
                   rest_of_time(json));
  event.dir = reader.text(dir);
  event.bytes = reader.bytes("hex");
  if (json.contains("addr")) {
    event.id = static_cast<std::uint32_t>(reader.integer("addr", 0, kLastBusAddress));
    event.text = reader.text("ack");
  } else {
    const auto* const id = json.contains("conn") ? "conn" : "id";
    event.id = static_cast<std::uint32_t>(reader.integer(id, 0, UINT32_MAX));
  }
  event.name = reader.text("name");
  if (json.contains("value") && json["value"].is_number_integer()) {
    event.value = reader.integer("value", INT64_MIN, INT64_MAX);
  }
  event.json = line;
  if (!reader.complaint().empty()) return malformed(path, number, reader.complaint());
  return event;
}

/// Grows by one line after the other.
class TraceBuilder {
 public:
  explicit TraceBuilder(std::string path) : lines_{path} { trace_.path = std::move(path); }

  Outcome<void> take(std::string_view line) {
    TraceEvent event;
    const auto taken = lines_.take(line, event);
    if (!taken) return tl::unexpected{taken.error()};
    if (*taken) trace_.events.push_back(std::move(event));
    return {};
  }

  [[nodiscard]] Trace trace() && {
    trace_.device = lines_.header().device;
    trace_.header = lines_.header().json;
    return std::move(trace_);
  }

 private:
  TraceLines lines_;
  Trace trace_;
};

/// Cuts lines off the front of a text; a carriage return before the line end goes with it.
std::string_view next_line(std::string_view& rest) {
  const auto end = rest.find('\n');
  auto line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// A recording that is no text, as if it were.
Outcome<Trace> trace_of_capture(UserFile file, const std::string& path) {
  auto reader = CaptureReader::open(std::move(file), path);
  if (!reader) return tl::unexpected{std::move(reader.error())};
  TraceBuilder builder{path};
  const auto writer = make_capture_writer(CaptureFormat::kLines);
  std::string line;
  CaptureRecord record;
  auto written = writer->begin((*reader)->header(), line);
  while (written) {
    std::string_view rest = line;
    written = builder.take(next_line(rest));
    if (!written) break;
    const auto has_record = (*reader)->next(record);
    if (!has_record) return tl::unexpected{has_record.error()};
    if (!*has_record) return std::move(builder).trace();
    line.clear();
    written = writer->add(record, {}, line);
  }
  return tl::unexpected{std::move(written.error())};
}

bool is_same(const TraceEvent& a, const TraceEvent& b) {
  return a.dir == b.dir && a.time == b.time && a.id == b.id && a.bytes == b.bytes &&
         a.text == b.text;
}

std::string describe_event(const std::optional<TraceEvent>& event) {
  if (!event) return "nothing";
  const auto id = event->dir.starts_with("can_") ? fmt::format(" id {:03X}", event->id) : "";
  const auto text = event->text.empty() ? "" : event->text + " ";
  return fmt::format("{:>10} us {}{} {}{}", microseconds(event->time), event->dir, id, text,
                     to_hex_dump(event->bytes));
}

/// The only message in the bytes that a device sent, if they are just one.
std::optional<Message> sole_message(MakeDissector make_dissector, const TraceEvent& event) {
  if (make_dissector == nullptr || event.dir != "from_device") return std::nullopt;
  std::vector<Message> messages;
  const auto dissector = make_dissector();
  dissector->feed(Direction::kFromDevice, event.time, event.bytes, messages);
  dissector->finish(messages);
  if (messages.size() != 1) return std::nullopt;
  return std::move(messages.front());
}

}  // namespace

Outcome<bool> TraceLines::take(std::string_view line, TraceEvent& event) {
  ++number_;
  if (number_ == 1) {
    auto header = CaptureHeader::parse(line, fmt::format("{}:1", path_));
    if (!header) return tl::unexpected{std::move(header.error())};
    header_ = *std::move(header);
    return false;
  }
  if (line.empty()) return false;
  auto parsed = parse_event(path_, number_, line);
  if (!parsed) return tl::unexpected{std::move(parsed).error()};
  event = *std::move(parsed);
  if (event.time < last_) return malformed(path_, number_, "the time runs backwards");
  last_ = event.time;
  return true;
}

Outcome<Trace> parse_trace(std::string path, std::string_view text) {
  TraceBuilder builder{std::move(path)};
  do {
    if (auto taken = builder.take(next_line(text)); !taken) {
      return tl::unexpected{std::move(taken.error())};
    }
  } while (!text.empty());
  return std::move(builder).trace();
}

Outcome<Trace> read_trace(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) && !error) {
    return problem(ErrorCode::kNotFound, path, "check the path");
  }
  return UserFile::open(path).and_then(
      [&path](UserFile file) { return read_trace(std::move(file), path); });
}

Outcome<Trace> read_trace(UserFile file, const std::string& path) {
  if (file.starts_with(pcapng::kMagic)) return trace_of_capture(std::move(file), path);
  TraceBuilder builder{path};
  while (true) {
    const auto line = file.next_line();
    if (!line) return tl::unexpected{line.error()};
    if (!*line && file.line_number() > 1) return std::move(builder).trace();
    if (auto taken = builder.take(line->value_or("")); !taken) {
      return tl::unexpected{std::move(taken.error())};
    }
  }
}

Outcome<std::vector<std::string>> find_traces(const std::vector<std::string>& paths) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  for (const auto& path : paths) {
    std::error_code error;
    if (!fs::exists(path, error)) return problem(ErrorCode::kNotFound, path, "check the path");
    if (!fs::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    const auto first = static_cast<std::ptrdiff_t>(files.size());
    for (fs::recursive_directory_iterator it{path, error}, end; !error && it != end;
         it.increment(error)) {
      std::error_code ignored;
      const auto extension = it->path().extension();
      const bool is_recording = extension == ".jsonl" || extension == ".pcapng";
      if (is_recording && it->is_regular_file(ignored)) {
        files.push_back(it->path().string());
      }
    }
    if (error) return problem(error_from_errno(error.value()).code, path, "check its permissions");
    std::sort(files.begin() + first, files.end());
  }
  return files;
}

std::vector<std::byte> bus_message_of(const TraceEvent& event) {
  const bool is_read = event.dir == "read";
  if (!is_read && event.dir != "write") return {};
  return acknowledged({.address = static_cast<std::uint8_t>(event.id),
                       .is_read = is_read,
                       .bytes = event.bytes,
                       .acks = event.text});
}

std::vector<std::byte> bus_message_of(const CaptureRecord& record) {
  constexpr std::string_view kAck = R"("ack":")";
  TraceEvent event;
  event.dir = record.direction == Direction::kToDevice ? "write" : "read";
  event.bytes.assign(record.bytes.begin(), record.bytes.end());
  event.id = record.id;
  const auto begin = record.details.find(kAck);
  if (begin == std::string_view::npos) {
    event.text.assign(1 + event.bytes.size(), 'A');
  } else {
    const auto letters = record.details.substr(begin + kAck.size());
    event.text = letters.substr(0, letters.find('"'));
  }
  return bus_message_of(event);
}

std::optional<TraceDifference> first_difference(const std::vector<TraceEvent>& expected,
                                                const std::vector<TraceEvent>& actual) {
  const auto [e, a] = std::ranges::mismatch(expected, actual, is_same);
  if (e == expected.end() && a == actual.end()) return std::nullopt;
  TraceDifference difference;
  if (e != expected.end()) difference.expected = *e;
  if (a != actual.end()) difference.actual = *a;
  return difference;
}

std::string describe(const TraceDifference& difference, const Trace& trace,
                     MakeDissector make_dissector) {
  const auto& [expected, actual] = difference;
  auto text = expected ? fmt::format("  {}:{}: differs at {} us\n", trace.path, expected->line,
                                     microseconds(expected->time))
                       : fmt::format("  {}: behind the last recorded event\n", trace.path);
  text += fmt::format("  expected {}\n", describe_event(expected));
  text += fmt::format("  actual   {}\n", describe_event(actual));
  if (!expected || !actual) return text;
  if (expected->time != actual->time) {
    text += fmt::format("  time: expected {} us, got {} us\n", microseconds(expected->time),
                        microseconds(actual->time));
  }
  const auto wanted = sole_message(make_dissector, *expected);
  const auto got = sole_message(make_dissector, *actual);
  if (!wanted || !got) return text;
  for (const auto& field : field_differences(wanted->fields, wanted->raw, got->raw)) {
    text += fmt::format("  {}\n", field);
  }
  return text;
}

}  // namespace armjig
