// SPDX-License-Identifier: Apache-2.0
// Recordings as `golden-trace/1` lines.
#include <fmt/core.h>
#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/capture/capture_formats.hpp"
#include "harness/capture/message_json.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostCanBytes = 8;
constexpr std::int64_t kNsPerUs = 1000;

bool is_text(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string();
}

/// What kind of link says a line on its own, without help of details.
LinkKind kind_of(const TraceEvent& event, const Json& json) {
  if (!is_text(json, "hex") || json["hex"] != to_hex(event.bytes)) return LinkKind::kEvents;
  if (json.contains("op")) {
    const bool is_transfer = event.dir == "write" || event.dir == "read";
    return is_transfer && json.contains("addr") ? LinkKind::kBus : LinkKind::kEvents;
  }
  if (json.contains("addr")) return LinkKind::kEvents;
  if (event.dir == "to_device" || event.dir == "from_device") {
    return json.contains("conn") ? LinkKind::kSession : LinkKind::kStream;
  }
  const bool is_can = event.dir == "can_to_device" || event.dir == "can_from_device";
  const bool is_frame = event.id <= kLastCanId && event.bytes.size() <= kMostCanBytes &&
                        json.contains("id") && !json.contains("conn");
  return is_can && is_frame ? LinkKind::kCan : LinkKind::kEvents;
}

const char* key_of_id(LinkKind kind) noexcept {
  switch (kind) {
    case LinkKind::kSession:
      return "conn";
    case LinkKind::kBus:
      return "addr";
    case LinkKind::kCan:
      return "id";
    case LinkKind::kStream:
    case LinkKind::kEvents:
      break;
  }
  return nullptr;
}

class LineCaptureReader final : public CaptureReader {
 public:
  LineCaptureReader(UserFile file, const std::string& path)
      : file_{std::move(file)}, lines_{path} {}

  Outcome<void> read_header() {
    const auto line = file_.next_line();
    if (!line) return tl::unexpected{line.error()};
    const auto taken = lines_.take(line->value_or(""), event_);
    if (!taken) return tl::unexpected{taken.error()};
    header_ = lines_.header();
    return {};
  }

  [[nodiscard]] std::string_view format() const noexcept override { return "golden-trace/1"; }

  Outcome<bool> next(CaptureRecord& record) override {
    while (true) {
      const auto line = file_.next_line();
      if (!line) return tl::unexpected{line.error()};
      if (!*line) return false;
      auto taken = lines_.take(**line, event_);
      if (!taken) return taken;
      if (!*taken) continue;
      take(record);
      return true;
    }
  }

 private:
  void take(CaptureRecord& record) {
    auto json = Json::parse(event_.json);
    const auto kind = kind_of(event_, json);
    record = {.time = event_.time,
              .link = &link_of(json, kind),
              .direction = event_.dir == "to_device" || event_.dir == "can_to_device" ||
                                   event_.dir == "write"
                               ? Direction::kToDevice
                               : Direction::kFromDevice,
              .id = 0,
              .bytes = {},
              .details = {}};
    details_.clear();
    if (json.contains("t_ms")) {
      add_detail("t_ms", json["t_ms"]);
      json.erase("t_ms");
    } else {
      json.erase("t_us");
      if (record.time.time_since_epoch().count() % kNsPerUs != 0) json.erase("ns");
    }
    const char* const dir = json.contains("op") ? "op" : "dir";
    if (kind == LinkKind::kEvents) {
      add_detail(dir, json[dir]);
    } else {
      record.bytes = event_.bytes;
      json.erase("hex");
      if (const char* const key = key_of_id(kind)) {
        record.id = event_.id;
        json.erase(key);
      }
    }
    json.erase(dir);
    for (const auto& [key, value] : json.items()) add_detail(key, value);
    record.details = details_;
  }

  /// Of a recording of several links, lines say which one if it is not the header's.
  const CaptureLink& link_of(Json& json, LinkKind kind) {
    if (!is_text(json, "link") || json["link"] == header_.device) {
      return link(header_.device, header_.device, kind);
    }
    const auto name = json["link"].get<std::string>();
    auto device = header_.device;
    if (is_text(json, "device") && json["device"] != device) {
      device = json["device"];
      json.erase("device");
    }
    json.erase("link");
    return link(name, device, kind);
  }

  void add_detail(const std::string& key, const Json& value) {
    if (!details_.empty()) details_ += ',';
    details_ += json_string(key);
    details_ += ':';
    details_ += value.dump();
  }

  UserFile file_;
  TraceLines lines_;
  TraceEvent event_;
  std::string details_;
};

class LineCaptureWriter final : public CaptureWriter {
 public:
  Outcome<void> begin(const CaptureHeader& header, std::string& out) override {
    device_ = header.device;
    out += header.json;
    out += '\n';
    return {};
  }

  Outcome<void> add(const CaptureRecord& record, std::span<const Message> messages,
                    std::string& out) override {
    const auto& link = *record.link;
    const auto into = std::back_inserter(out);
    out += '{';
    if (!record.details.starts_with(R"("t_ms":)")) {
      fmt::format_to(into, R"("t_us":{},)", microseconds(record.time));
      const auto ns = record.time.time_since_epoch().count() % kNsPerUs;
      if (ns > 0) fmt::format_to(into, R"("ns":{},)", ns);
    }
    if (link.name != device_) fmt::format_to(into, R"("link":{},)", json_string(link.name));
    if (link.name != device_ && link.device != device_) {
      fmt::format_to(into, R"("device":{},)", json_string(link.device));
    }
    add_bytes(record, out);
    if (link.kind != LinkKind::kEvents && !record.details.empty()) out += ',';
    out += record.details;
    const char* separator = ",\"messages\":[";
    for (const auto& message : messages) {
      out += separator;
      out += to_json(message);
      separator = ",";
    }
    out += messages.empty() ? "}\n" : "]}\n";
    return {};
  }

 private:
  static void add_bytes(const CaptureRecord& record, std::string& out) {
    const auto into = std::back_inserter(out);
    const auto kind = record.link->kind;
    if (kind == LinkKind::kEvents) return;
    if (kind == LinkKind::kBus) {
      out += record.direction == Direction::kToDevice ? R"("op":"write")" : R"("op":"read")";
    } else {
      const char* const prefix = kind == LinkKind::kCan ? "can_" : "";
      fmt::format_to(into, R"("dir":"{}{}")", prefix, to_string(record.direction));
    }
    if (const char* const key = key_of_id(kind)) {
      fmt::format_to(into, R"(,"{}":{})", key, record.id);
    }
    fmt::format_to(into, R"(,"hex":"{}")", to_hex(record.bytes));
  }

  std::string device_;
};

}  // namespace

Outcome<std::unique_ptr<CaptureReader>> open_lines(UserFile file, const std::string& path) {
  return begin_reading<LineCaptureReader>(std::move(file), path);
}

std::unique_ptr<CaptureWriter> make_line_writer() { return std::make_unique<LineCaptureWriter>(); }

}  // namespace armjig
