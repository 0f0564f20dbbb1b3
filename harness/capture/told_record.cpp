// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/told_record.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "harness/core/text_member.hpp"

namespace armjig {
namespace {

using Details = nlohmann::json;
using Happened = ConnectionEvent::Kind;

std::optional<Happened> border_of(const Details& event) {
  const auto how = text_member(event, "text");
  const auto what = text_member(event, "dir");
  if (what == "connect") return how == "ok" ? std::optional{Happened::kBegun} : std::nullopt;
  if (what != "disconnect") return std::nullopt;
  if (how == "client-half-close") return Happened::kHalfClosed;
  if (how == "client-reset") return Happened::kReset;
  return how.starts_with("device-") ? Happened::kDropped : Happened::kClosed;
}

void tell_event(const CaptureRecord& record, const Details& event, Overhearer& overhearer) {
  if (const auto border = border_of(event)) {
    const auto id = event.value("conn", Details{});
    const auto number = id.is_number_unsigned() ? id.get<std::uint32_t>() : 0;
    return overhearer.on_connection({record.time, number, *border, {}});
  }
  const auto value = event.value("value", Details{});
  const bool is_input = text_member(event, "dir") == "input" || text_member(event, "op") == "input";
  if (is_input && value.is_number_integer()) {
    overhearer.on_input(record.time, text_member(event, "name"), value.get<std::int64_t>());
  }
}

void tell_part(const CaptureRecord& record, const Details& details, Overhearer& overhearer) {
  const bool is_read = record.direction == Direction::kFromDevice;
  auto acks = text_member(details, "ack");
  if (acks.empty()) acks.assign(is_read ? 1 : 1 + record.bytes.size(), 'A');
  const bool has_stop = details.value("stop", Details{}) != false;
  overhearer.on_bus({.begin = record.time,
                     .end = record.time,
                     .address = static_cast<std::uint8_t>(record.id),
                     .is_read = is_read,
                     .bytes = record.bytes,
                     .acks = acks,
                     .ending = has_stop ? BusPart::Ending::kStop : BusPart::Ending::kNextStart,
                     .error = {}});
}

}  // namespace

void tell(const CaptureRecord& record, Overhearer& overhearer) {
  const bool is_to_device = record.direction == Direction::kToDevice;
  const auto details = [&record] {
    const auto json = Details::parse('{' + std::string{record.details} + '}', nullptr,
                                     /*allow_exceptions=*/false);
    return json.is_object() ? json : Details::object();
  };
  switch (record.link->kind) {
    case LinkKind::kStream:
      return is_to_device ? overhearer.to_device(record.time, record.bytes)
                          : overhearer.from_device(record.time, record.bytes);
    case LinkKind::kSession:
      return overhearer.on_connection({record.time, record.id,
                                       is_to_device ? Happened::kToServer : Happened::kFromServer,
                                       record.bytes});
    case LinkKind::kBus:
      return tell_part(record, details(), overhearer);
    case LinkKind::kEvents:
      return tell_event(record, details(), overhearer);
    case LinkKind::kCan:
      return;
  }
}

}  // namespace armjig
