// SPDX-License-Identifier: Apache-2.0
#include "conformance/port_bench.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "harness/core/hex.hpp"
#include "harness/wire/brief.hpp"

namespace armjig {
namespace {

/// The field of the message that the judgement got; none if it is about something else.
const Field* field_judged(const Message& message, const Judgement& judgement) {
  const auto is_it = [&](const Field& field) {
    return judgement.actual == sentence_of(field, field_value(field, message.raw));
  };
  const auto field = std::ranges::find_if(message.fields, is_it);
  return field == message.fields.end() ? nullptr : &*field;
}

/// `> speed.j1 = 720896 steps/s = 0x0B0000 (bytes 22 to 24: 0B 00 00)`.
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

std::string evidence_of(const std::deque<Message>& messages, const Judgement& judgement) {
  const Message* judged = nullptr;
  for (const auto& message : messages) {
    if (field_judged(message, judgement) != nullptr) judged = &message;
  }
  std::string text;
  for (const auto& message : messages) {
    text += fmt::format("{:.3f} ms {}\n", static_cast<double>(microseconds(message.time)) / 1000.0,
                        to_line(message));
    if (message.fault.empty()) text += fmt::format("  {}\n", to_short_dump(message.raw));
    if (&message == judged) text += marked(*field_judged(message, judgement), message);
  }
  return text;
}

}  // namespace armjig
