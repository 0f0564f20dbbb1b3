// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/demo/demo.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace armjig::demo {
namespace {

constexpr std::array<NamedValue, 3> kOperations{{{'q', "query"}, {'s', "start"}, {'h', "halt"}}};
constexpr std::array<NamedValue, 4> kStates{
    {{0, "ready"}, {1, "running"}, {2, "halted"}, {0xEE, "unknown_operation"}}};

using enum Encoding;
constexpr std::array kRequestFields{
    Field{"start", 0, 1, kLiteral, "", "begins a request", {}, {}, 0xA5},
    Field{"operation", 1, 1, kCode, "", "what to do", {}, kOperations},
    Field{"check", 2, 1, kUnsigned, "", "the operation with all bits turned"}};
constexpr std::array kReplyFields{
    Field{"start", 0, 1, kLiteral, "", "begins a reply", {}, {}, 0x5A},
    Field{"state", 1, 1, kCode, "", "after the request", {}, kStates},
    Field{"check", 2, 1, kUnsigned, "", "the state with all bits turned"}};

constexpr MessageBytes message(std::byte start, std::uint8_t content) noexcept {
  return {start, std::byte{content}, ~std::byte{content}};
}

class DemoDissector final : public Dissector {
 public:
  void feed(Direction direction, Instant time, Bytes bytes, std::vector<Message>& out) override {
    auto& lane = direction == Direction::kToDevice ? requests_ : replies_;
    for (const auto byte : bytes) {
      lane.pending.push_back(byte);
      if (!lane.splitter.step(byte)) continue;
      emit_noise(direction, time, lane, lane.pending.size() - kMessageSize, out);
      out.push_back({direction, time, lane.name, std::exchange(lane.pending, {}), lane.fields, {}});
    }
  }
  void finish(std::vector<Message>& out) override {
    emit_noise(Direction::kToDevice, {}, requests_, requests_.pending.size(), out);
    emit_noise(Direction::kFromDevice, {}, replies_, replies_.pending.size(), out);
  }

 private:
  struct Lane {
    Splitter splitter;
    std::string_view name;
    std::span<const Field> fields;
    std::vector<std::byte> pending{};
  };

  static void emit_noise(Direction direction, Instant time, Lane& lane, std::size_t size,
                         std::vector<Message>& out) {
    if (size == 0) return;
    const auto end = lane.pending.begin() + static_cast<std::ptrdiff_t>(size);
    out.push_back({direction, time, "noise", {lane.pending.begin(), end}, {}, "not a message"});
    lane.pending.erase(lane.pending.begin(), end);
  }

  Lane requests_{Splitter{kRequestStart}, "request", kRequestFields};
  Lane replies_{Splitter{kReplyStart}, "reply", kReplyFields};
};

}  // namespace

MessageBytes encode(Operation operation) noexcept {
  return message(kRequestStart, static_cast<std::uint8_t>(operation));
}
MessageBytes encode(State state) noexcept {
  return message(kReplyStart, static_cast<std::uint8_t>(state));
}

std::optional<std::byte> Splitter::step(std::byte byte) noexcept {
  held_[size_++] = byte;
  if (held_[0] != start_) drop_until_start();
  if (size_ < kMessageSize) return std::nullopt;
  if (held_[2] == ~held_[1]) {
    size_ = 0;
    return held_[1];
  }
  drop_until_start();
  return std::nullopt;
}

void Splitter::drop_until_start() noexcept {
  const auto next = std::find(held_.begin() + 1, held_.begin() + size_, start_);
  size_ = static_cast<std::size_t>(std::copy(next, held_.begin() + size_, held_.begin()) -
                                   held_.begin());
}

std::span<const Field> request_fields() noexcept { return kRequestFields; }
std::span<const Field> reply_fields() noexcept { return kReplyFields; }

Dissection dissection() {
  return {.messages = {{"request", Direction::kToDevice, kRequestFields},
                       {"reply", Direction::kFromDevice, kReplyFields}},
          .check =
              "function(m) return m:byte(2) + m:byte(3) ~= 255 and "
              "string.format('check: 0x%02X', m:byte(3)) or nil end"};
}

std::unique_ptr<Dissector> make_dissector() { return std::make_unique<DemoDissector>(); }

}  // namespace armjig::demo
