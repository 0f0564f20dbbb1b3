// SPDX-License-Identifier: Apache-2.0
#include "harness/console/message_view.hpp"

#include <fmt/core.h>

#include "harness/capture/message_json.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

/// `reply  state 1 (running)`, or what noise is made of and why it is none.
std::string line_of(const Message& message) {
  std::string text{message.name};
  for (const auto& field : message.fields) {
    if (field.encoding == Encoding::kLiteral) continue;
    text += fmt::format("  {} {}", field.name, field_text(field, field_value(field, message.raw)));
  }
  if (!message.fault.empty())
    text += fmt::format("  {}: {}", to_hex_dump(message.raw), message.fault);
  return text;
}

}  // namespace

void MessageView::feed(Direction direction, Instant now, Bytes bytes) {
  messages_.clear();
  dissector_->feed(direction, now, bytes, messages_);
  for (const auto& message : messages_) {
    if (!message.fault.empty()) continue;
    ++count_;
    newest_ = message;
  }
}

std::vector<std::string> MessageView::lines() const {
  std::vector<std::string> lines;
  for (const auto& message : messages_) lines.push_back(line_of(message));
  return lines;
}

std::vector<std::string> MessageView::json_lines() const {
  std::vector<std::string> lines;
  for (const auto& message : messages_) lines.push_back(to_json(message));
  return lines;
}

std::vector<std::string> MessageView::newest_line() const {
  if (count_ == 0) return {};
  return {line_of(newest_)};
}

std::string MessageView::newest_panel() const { return count_ == 0 ? "" : to_text(newest_); }

}  // namespace armjig
