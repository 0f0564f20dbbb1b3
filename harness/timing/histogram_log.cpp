// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/histogram_log.hpp"

#include <fmt/chrono.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace armjig {
namespace {

// Everything is big-endian. The second encoding and words of eight bytes are in the cookies.
constexpr std::uint32_t kCookie = 0x1C849313;
constexpr std::uint32_t kCompressedCookie = 0x1C849314;
constexpr std::size_t kHeaderSize = 40;
constexpr std::size_t kMostBytes = std::size_t{1} << 22;  ///< of what is inflated; ours has 0.3 MB

constexpr std::string_view kLetters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string to_base64(std::string_view bytes) {
  std::string text;
  for (; !bytes.empty(); bytes.remove_prefix(std::min<std::size_t>(3, bytes.size()))) {
    const auto byte = [&bytes](std::size_t i) {
      return i < bytes.size() ? static_cast<std::uint8_t>(bytes[i]) : 0U;
    };
    const auto three = byte(0) << 16U | byte(1) << 8U | byte(2);
    for (std::size_t i = 0; i < 4; ++i) {
      text += i <= bytes.size() ? kLetters[three >> (18 - 6 * i) & 0x3FU] : '=';
    }
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  std::string bytes;
  std::uint32_t held = 0;
  unsigned bits = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char letter : text) {
    const auto value = kLetters.find(letter);
    if (value == std::string_view::npos) return std::nullopt;
    held = held << 6U | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 0xFFU);
  }
  return bytes;
}

template <class Number>
void put(std::string& out, Number number) {
  for (unsigned i = sizeof(Number); i-- > 0;) {
    out += static_cast<char>(number >> (8 * i) & 0xFFU);
  }
}

template <class Number>
Number get(std::string_view in, std::size_t place) {
  Number number = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    number = number << 8U | static_cast<std::uint8_t>(in[place + i]);
  }
  return number;
}

/// Small numbers of either sign in few bytes: seven bits each, the ninth has all eight.
void put_varying(std::string& out, std::int64_t number) {
  auto rest = static_cast<std::uint64_t>(number) << 1U ^ static_cast<std::uint64_t>(number >> 63U);
  for (int i = 0; i < 8 && rest > 0x7F; ++i, rest >>= 7U) {
    out += static_cast<char>((rest & 0x7FU) | 0x80U);
  }
  out += static_cast<char>(rest);
}

std::optional<std::int64_t> take_varying(std::string_view& in) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < 9; ++i) {
    if (in.empty()) return std::nullopt;
    const auto byte = static_cast<std::uint8_t>(in.front());
    in.remove_prefix(1);
    const bool is_last = i == 8 || byte < 0x80;
    value |= std::uint64_t{is_last ? byte : byte & 0x7FU} << (7 * i);
    if (is_last) break;
  }
  return static_cast<std::int64_t>(value >> 1U ^ -(value & 1U));
}

std::string encode(const LatencyHistogram& histogram) {
  auto counts = histogram.counts();
  while (!counts.empty() && counts.back() == 0) counts = counts.first(counts.size() - 1);
  std::string payload;
  for (std::size_t i = 0; i < counts.size();) {
    const auto next = std::find_if(counts.begin() + static_cast<std::ptrdiff_t>(i), counts.end(),
                                   [](std::uint64_t count) { return count != 0; });
    const auto zeros = static_cast<std::size_t>(next - counts.begin()) - i;
    if (zeros > 0) {
      put_varying(payload, -static_cast<std::int64_t>(zeros));
      i += zeros;
    } else {
      put_varying(payload, static_cast<std::int64_t>(counts[i++]));
    }
  }
  std::string bytes;
  put(bytes, kCookie);
  put(bytes, static_cast<std::uint32_t>(payload.size()));
  put(bytes, std::uint32_t{0});  // the buckets are not shifted
  put(bytes, std::uint32_t{LatencyHistogram::kDigits});
  put(bytes, std::uint64_t{1});  // the least value that is told from 0
  put(bytes, static_cast<std::uint64_t>(LatencyHistogram::kLongest.count()));
  put(bytes, std::bit_cast<std::uint64_t>(1.0));  // values are whole
  return bytes + payload;
}

Result<LatencyHistogram> decode(std::string_view bytes) {
  if (bytes.size() < kHeaderSize || get<std::uint32_t>(bytes, 0) != kCookie ||
      get<std::uint32_t>(bytes, 8) != 0 ||
      get<std::uint32_t>(bytes, 12) != LatencyHistogram::kDigits ||
      get<std::uint64_t>(bytes, 16) != 1) {
    return fail(ErrorCode::kMalformed);
  }
  LatencyHistogram histogram;
  const auto buckets = histogram.counts().size();
  auto payload = bytes.substr(kHeaderSize);
  const std::size_t said = get<std::uint32_t>(bytes, 4);
  if (said > payload.size()) return fail(ErrorCode::kMalformed);
  payload = payload.substr(0, said);
  for (std::size_t i = 0; !payload.empty();) {
    const auto number = take_varying(payload);
    if (!number) return fail(ErrorCode::kMalformed);
    if (*number <= 0) {
      i += static_cast<std::size_t>(std::max<std::uint64_t>(
          1, std::min<std::uint64_t>(-static_cast<std::uint64_t>(*number), kMostBytes)));
    } else {
      histogram.record_bucket(std::min(i++, buckets - 1), static_cast<std::uint64_t>(*number));
    }
  }
  return histogram;
}

std::optional<std::string> inflated(std::string_view deflated) {
  std::string bytes(kMostBytes, '\0');
  auto size = static_cast<uLongf>(bytes.size());
  const auto done = ::uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                                 reinterpret_cast<const Bytef*>(deflated.data()),
                                 static_cast<uLong>(deflated.size()));
  if (done != Z_OK) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

std::string deflated(std::string_view bytes) {
  auto size = ::compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  // Into as much room as it may need it cannot fail.
  (void)::compress(reinterpret_cast<Bytef*>(out.data()), &size,
                   reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  out.resize(size);
  return out;
}

/// The next of the words of a line, which have commas between.
std::string_view take_word(std::string_view& line) {
  const auto comma = line.find(',');
  const auto word = line.substr(0, comma);
  line = comma == std::string_view::npos ? std::string_view{} : line.substr(comma + 1);
  return word;
}

std::optional<std::chrono::duration<double>> seconds_of(std::string_view text) {
  double seconds{};
  const auto* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seconds);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return std::chrono::duration<double>{seconds};
}

std::optional<HistogramInterval> interval_of(std::string_view line) {
  HistogramInterval interval;
  constexpr std::string_view kTag = "Tag=";
  if (line.starts_with(kTag)) interval.tag = take_word(line).substr(kTag.size());
  const auto start = seconds_of(take_word(line));
  const auto length = seconds_of(take_word(line));
  (void)take_word(line);  // the largest, which the histogram has, too
  auto histogram = parse_hdr_text(line);
  if (!start || !length || !histogram) return std::nullopt;
  interval.start = *start;
  interval.length = *length;
  interval.histogram = *std::move(histogram);
  return interval;
}

}  // namespace

std::string to_hdr_text(const LatencyHistogram& histogram) {
  const auto content = deflated(encode(histogram));
  std::string bytes;
  put(bytes, kCompressedCookie);
  put(bytes, static_cast<std::uint32_t>(content.size()));
  return to_base64(bytes + content);
}

Result<LatencyHistogram> parse_hdr_text(std::string_view text) {
  const auto bytes = from_base64(text);
  if (!bytes || bytes->size() < 8 || get<std::uint32_t>(*bytes, 0) != kCompressedCookie) {
    return fail(ErrorCode::kMalformed);
  }
  const auto content = inflated(std::string_view{*bytes}.substr(8, get<std::uint32_t>(*bytes, 4)));
  if (!content) return fail(ErrorCode::kMalformed);
  return decode(*content);
}

std::string to_histogram_log(std::chrono::sys_seconds started,
                             const std::vector<HistogramInterval>& intervals) {
  auto log = fmt::format(
      "#[Logged by armjig; values in nanoseconds]\n"
      "#[Histogram log format version 1.3]\n"
      "#[StartTime: {}.000 (seconds since epoch), {:%Y-%m-%dT%H:%M:%SZ}]\n"
      "\"StartTimestamp\",\"Interval_Length\",\"Interval_Max\",\"Interval_Compressed_Histogram\"\n",
      started.time_since_epoch().count(), started);
  for (const auto& interval : intervals) {
    const std::chrono::duration<double, std::milli> most = interval.histogram.max();
    log += fmt::format("{}{}{:.3f},{:.3f},{:.3f},{}\n", interval.tag.empty() ? "" : "Tag=",
                       interval.tag.empty() ? "" : interval.tag + ",", interval.start.count(),
                       interval.length.count(), most.count(), to_hdr_text(interval.histogram));
  }
  return log;
}

Result<std::vector<HistogramInterval>> parse_histogram_log(std::string_view text) {
  std::vector<HistogramInterval> intervals;
  for (std::int32_t number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    auto line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.starts_with('#') || line.starts_with('"')) continue;
    auto interval = interval_of(line);
    if (!interval) return fail(ErrorCode::kMalformed, number);
    intervals.push_back(*std::move(interval));
  }
  return intervals;
}

}  // namespace armjig
