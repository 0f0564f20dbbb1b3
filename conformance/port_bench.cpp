// SPDX-License-Identifier: Apache-2.0
#include "conformance/port_bench.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "harness/core/hex.hpp"
#include "harness/wire/brief.hpp"

namespace armjig {
namespace {

/// Whether the byte is one of the field's.
bool covers(const Field& field, Bytes message, std::size_t byte) {
  if (field.place == Place::kBytes) return byte - field.offset < field.width;
  const auto before = message.first(std::min(byte, message.size()));
  return std::ranges::count(before, std::byte{':'}) == field.offset;
}

bool is_judged(const Field& field, Bytes message, const Judgement& judgement) {
  if (judgement.byte) return covers(field, message, *judgement.byte);
  return judgement.actual == sentence_of(field, field_value(field, message));
}

std::string marked(const Field& field, const Message& message) {
  const auto sentence = sentence_of(field, field_value(field, message.raw));
  if (field.place == Place::kPiece) return fmt::format("> {}\n", sentence);
  const auto bytes = to_hex_dump(Bytes{message.raw}.subspan(field.offset, field.width));
  const auto places = field.width == 1 ? fmt::format("byte {}", field.offset)
                                       : fmt::format("bytes {} to {}", field.offset,
                                                     field.offset + field.width - 1);
  return fmt::format("> {} ({}: {})\n", sentence, places, bytes);
}

}  // namespace

std::string sentence_of(const Field& field, std::int64_t value) {
  return fmt::format("{} = {}", field.name, text_in_both(field, value));
}

std::string mark_of(const Message& message, const Judgement& judgement) {
  if (message.direction != Direction::kFromDevice) return {};
  const auto field = std::ranges::find_if(
      message.fields, [&](const Field& each) { return is_judged(each, message.raw, judgement); });
  return field == message.fields.end() ? std::string{} : marked(*field, message);
}

std::string evidence_of(const std::deque<Message>& messages, const Judgement& judgement) {
  const Message* judged = nullptr;
  for (const auto& message : messages) {
    if (!mark_of(message, judgement).empty()) judged = &message;
  }
  std::string text;
  for (const auto& message : messages) {
    text += fmt::format("{:.3f} ms {}\n", static_cast<double>(microseconds(message.time)) / 1000.0,
                        to_line(message));
    if (message.fault.empty()) text += fmt::format("  {}\n", to_short_dump(message.raw));
    if (&message == judged) text += mark_of(message, judgement);
  }
  return text;
}

}  // namespace armjig
