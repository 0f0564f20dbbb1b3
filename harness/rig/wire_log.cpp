// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/wire_log.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/core/version.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;
using Keys = WireLog::Keys;

/// What reads such a file (`CaptureRecord::details`).
std::string details_of(const Keys& keys) {
  Json json = Json::object();
  for (const auto& [name, value] : keys) {
    std::visit([&, key = std::string{name}](const auto& one) { json[key] = one; }, value);
  }
  const auto text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.substr(1, text.size() - 2);
}

CaptureHeader header_of(const CaptureSubject& subject, bool is_redacted) {
  Json json{{"format", "golden-trace/1"},
            {"device", subject.device},
            {"title", "capture"},
            {"source", fmt::format("armjig {}", kVersion)}};
  if (!subject.target.empty()) json["target"] = subject.target;
  if (subject.epoch_ns > 0) json["epoch_ns"] = subject.epoch_ns;
  const CaptureHeader header{json.dump(-1, ' ', false, Json::error_handler_t::replace),
                             std::string{subject.device}, subject.epoch_ns};
  return is_redacted ? header.redacted() : header;
}

constexpr std::string_view kind_key(LinkKind kind) noexcept {
  return kind == LinkKind::kBus ? "op" : "dir";
}

}  // namespace

std::int64_t epoch_of(Instant since_start) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return (std::chrono::duration_cast<Duration>(now) - since_start.time_since_epoch()).count();
}

Outcome<std::shared_ptr<WireLog>> WireLog::create(const CaptureFile& file,
                                                  const CaptureSubject& subject) {
  std::shared_ptr<WireLog> log{new WireLog{file, subject}};
  auto begun = log->writer_->begin(log->header_, log->text_);
  if (begun && log->file_.file) begun = log->file_.file->put(log->text_);
  if (!begun) return tl::unexpected{std::move(begun.error())};
  log->size_ = log->least_size_ = log->text_.size();
  return log;
}

WireLog::WireLog(const CaptureFile& file, const CaptureSubject& subject)
    : file_{file},
      header_{header_of(subject, file.is_redacted)},
      make_dissector_{subject.make_dissector},
      writer_{make_capture_writer(file.format)} {
  for (const auto kind :
       {LinkKind::kStream, LinkKind::kSession, LinkKind::kBus, LinkKind::kCan, LinkKind::kEvents}) {
    links_.push_back({header_.device, header_.device, kind});
  }
}

const CaptureLink* WireLog::link_of(LinkKind kind) const noexcept {
  return &links_[static_cast<std::size_t>(kind)];
}

bool WireLog::is_full() const noexcept {
  return file_.rotation && size_ > least_size_ && size_ + text_.size() > file_.rotation->bytes;
}

void WireLog::add(CaptureRecord record, std::span<const Message> messages) {
  last_ = std::max(last_, record.time);
  record.time = last_;
  if (file_.listener) file_.listener(record);
  if (!file_.file) return;
  text_.clear();
  // No port hands over what a format could not hold.
  if (!writer_->add(record, messages, text_)) return;
  if (is_full()) {
    if (!file_.file->rotate(file_.rotation->files)) return;
    text_.clear();
    (void)writer_->begin(header_, text_);
    (void)writer_->add(record, messages, text_);
    size_ = 0;
  }
  (void)file_.file->put(text_);  // whoever opened it asks for its failure
  size_ += text_.size();
}

void WireLog::add_event(Instant time, const Keys& keys) {
  const auto details = details_of(keys);
  add({.time = time,
       .link = link_of(LinkKind::kEvents),
       .direction = {},
       .id = 0,
       .bytes = {},
       .details = details},
      {});
}

void WireLog::add_input(Instant time, std::string_view kind, std::string_view name,
                        std::int64_t value) {
  add_event(time, {{kind, "input"}, {"name", std::string{name}}, {"value", value}});
}

void WireLog::add_border(Instant time, std::uint32_t connection, std::string_view direction,
                         std::string_view how) {
  add_event(time, {{"dir", std::string{direction}},
                   {"conn", std::int64_t{connection}},
                   {"text", std::string{how}}});
}

WireLog::Talk::Talk(std::shared_ptr<WireLog> log, LinkKind kind, std::uint32_t id)
    : log_{std::move(log)}, link_{log_->link_of(kind)}, id_{id} {
  // Only a text says what was meant.
  if (log_->file_.format == CaptureFormat::kLines) dissector_ = log_->make_dissector_();
}

void WireLog::Talk::add(CaptureRecord record, Bytes dissected) {
  record.link = link_;
  messages_.clear();
  if (dissector_ && !dissected.empty()) {
    dissector_->feed(record.direction, record.time, dissected, messages_);
  }
  log_->add(record, messages_);
}

void WireLog::Talk::add(Instant time, Direction direction, Bytes bytes) {
  add({.time = time,
       .link = nullptr,
       .direction = direction,
       .id = id_,
       .bytes = bytes,
       .details = {}},
      bytes);
}

void WireLog::Talk::add(const BusPart& part, const Keys& more) {
  Keys keys{{"ack", std::string{part.acks}}};
  keys.insert(keys.end(), more.begin(), more.end());
  if (part.error) keys.push_back({"error", std::string{describe(*part.error)}});
  if (part.ending == BusPart::Ending::kNextStart) keys.push_back({"stop", false});
  const auto details = details_of(keys);
  add({.time = part.begin,
       .link = nullptr,
       .direction = part.is_read ? Direction::kFromDevice : Direction::kToDevice,
       .id = part.address,
       .bytes = part.bytes,
       .details = details},
      acknowledged(part));
}

namespace {

class LogOfOverheard final : public Overhearer {
 public:
  LogOfOverheard(std::shared_ptr<WireLog> log, LinkKind kind)
      : log_{log}, kind_{kind}, talk_{std::move(log), kind} {}

  void to_device(Instant time, Bytes bytes) override {
    talk_.add(time, Direction::kToDevice, bytes);
  }

  void from_device(Instant time, Bytes bytes) override {
    talk_.add(time, Direction::kFromDevice, bytes);
  }

  void on_connection(const ConnectionEvent& event) override {
    const auto id = event.connection;
    const auto end = [&](std::string_view how) {
      log_->add_border(event.time, id, "disconnect", how);
      connections_.erase(id);
    };
    const auto talk = connections_.try_emplace(id, log_, LinkKind::kSession, id).first;
    switch (event.kind) {
      case ConnectionEvent::Kind::kBegun:
        return log_->add_border(event.time, id, "connect", "ok");
      case ConnectionEvent::Kind::kToServer:
        return talk->second.add(event.time, Direction::kToDevice, event.bytes);
      case ConnectionEvent::Kind::kFromServer:
        return talk->second.add(event.time, Direction::kFromDevice, event.bytes);
      case ConnectionEvent::Kind::kHalfClosed:
        return log_->add_border(event.time, id, "disconnect", "client-half-close");
      case ConnectionEvent::Kind::kClosed:
        return end("client-close");
      case ConnectionEvent::Kind::kReset:
        return end("client-reset");
      case ConnectionEvent::Kind::kDropped:
        return end("device-eof");
    }
  }

  void on_bus(const BusPart& part) override { talk_.add(part); }

  void on_input(Instant time, std::string_view name, std::int64_t value) override {
    log_->add_input(time, kind_key(kind_), name, value);
  }

  void overlook(Instant from, Instant to) override {
    log_->add_event(to, {{kind_key(kind_), "overlooked"},
                         {"since_us", microseconds(from)},
                         {"text", "armjig was late itself"}});
  }

 private:
  std::shared_ptr<WireLog> log_;
  LinkKind kind_;
  WireLog::Talk talk_;  ///< unless it is a server
  std::map<std::uint32_t, WireLog::Talk> connections_;
};

}  // namespace

std::unique_ptr<Overhearer> write_overheard(std::shared_ptr<WireLog> log, LinkKind kind) {
  return std::make_unique<LogOfOverheard>(std::move(log), kind);
}

}  // namespace armjig
