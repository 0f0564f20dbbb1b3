// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/capture.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/capture/capture_formats.hpp"
#include "harness/capture/pcapng.hpp"
#include "harness/core/nesting.hpp"

namespace armjig {

using Json = nlohmann::ordered_json;

std::string_view to_string(LinkKind kind) noexcept {
  constexpr std::array<std::string_view, 5> kNames{"stream", "session", "bus", "can", "events"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::uint64_t lost_before(const CaptureRecord& record) noexcept {
  constexpr std::string_view kLost = R"("lost":)";
  std::uint64_t lost = 0;
  if (record.link->kind == LinkKind::kEvents || !record.details.starts_with(kLost)) return lost;
  const auto number = record.details.substr(kLost.size());
  (void)std::from_chars(number.data(), number.data() + number.size(), lost);
  return lost;
}

Outcome<CaptureHeader> CaptureHeader::parse(std::string_view line, const std::string& where) {
  const auto malformed = [&where](std::string_view what) {
    return problem(ErrorCode::kMalformed, where, std::string{what});
  };
  if (is_too_deep(line)) return malformed(kTooDeep);
  const auto json = Json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("format", Json{}) != "golden-trace/1") {
    return malformed(R"(the first line is not a "golden-trace/1" header)");
  }
  const auto device = json.value("device", Json{});
  if (!device.is_string() || device.get<std::string>().empty()) {
    return malformed("\"device\" is missing");
  }
  CaptureHeader header{std::string{line}, device.get<std::string>()};
  const auto epoch = json.value("epoch_ns", Json(0));
  if (!epoch.is_number_integer() || epoch < 0 || epoch > INT64_MAX) {
    return malformed("\"epoch_ns\" is not a whole number in range");
  }
  header.epoch_ns = epoch.get<std::int64_t>();
  return header;
}

CaptureHeader CaptureHeader::redacted() const {
  auto left = Json::parse(json);
  for (const char* const key : {"target", "user", "host", "serial", "command", "comment"}) {
    left.erase(key);
  }
  return {left.dump(), device, epoch_ns};
}

Outcome<CaptureFormat> capture_format_of(const std::string& path) {
  const auto ending = std::filesystem::path{path}.extension();
  if (ending == ".pcapng") return CaptureFormat::kPcapng;
  if (ending.empty() || ending == ".jsonl") return CaptureFormat::kLines;
  return problem(ErrorCode::kBadValue, path,
                 "name it .pcapng, for Wireshark, or .jsonl, a text of lines");
}

Outcome<std::unique_ptr<CaptureReader>> CaptureReader::open(UserFile file,
                                                            const std::string& path) {
  if (file.starts_with(pcapng::kMagic)) return open_packets(std::move(file), path);
  return open_lines(std::move(file), path);
}

const CaptureLink& CaptureReader::link(std::string_view name, std::string_view device,
                                       LinkKind kind) {
  const auto found = std::ranges::find_if(links_, [&](const CaptureLink& link) {
    return link.kind == kind && link.name == name && link.device == device;
  });
  if (found != links_.end()) return *found;
  return links_.emplace_back(std::string{name}, std::string{device}, kind);
}

std::string json_string(std::string_view text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::unique_ptr<CaptureWriter> make_capture_writer(CaptureFormat format) {
  return format == CaptureFormat::kPcapng ? make_packet_writer() : make_line_writer();
}

}  // namespace armjig
