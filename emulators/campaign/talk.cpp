// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/talk.hpp"

#include <bit>
#include <cstdlib>
#include <map>
#include <string_view>

namespace armjig::campaign {
namespace {

/// FNV-1a, the same on every machine.
class Hash {
 public:
  Hash& add(std::string_view text) {
    for (const auto letter : text) put(static_cast<unsigned char>(letter));
    return put(0xFF);
  }
  Hash& add(std::uint64_t number) {
    for (int i = 0; i < 64; i += 8) put(static_cast<unsigned char>(number >> i));
    return *this;
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  Hash& put(unsigned char byte) {
    value_ = (value_ ^ byte) * 0x100000001B3ULL;
    return *this;
  }
  std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

/// How large a number is, roughly, with its sign.
std::uint64_t size_of(std::int64_t value) {
  const auto width = static_cast<std::uint64_t>(std::bit_width(
      value < 0 ? static_cast<std::uint64_t>(-(value + 1)) : static_cast<std::uint64_t>(value)));
  return value < 0 ? 128 + width : width;
}

std::uint64_t state_in(const RecordedMessage& one) {
  Hash hash;
  hash.add(one.message.name).add(one.message.fault);
  for (const auto& field : one.message.fields) {
    if (is_state(field)) hash.add(static_cast<std::uint64_t>(field_value(field, one.message.raw)));
  }
  return hash.value();
}

std::uint64_t answer_in(const RecordedMessage& one) {
  Hash hash;
  hash.add(one.message.name).add(one.message.fault).add(one.note);
  for (const auto& field : one.message.fields) {
    hash.add(size_of(field_value(field, one.message.raw)));
  }
  return hash.value();
}

}  // namespace

RecordedMessages messages_of(const std::vector<KeptRecord>& said, MakeDissector make_dissector) {
  // Links are compared by where they are, so each kind has one place.
  static const CaptureLink kLinks[] = {{"device", "device", LinkKind::kStream},
                                       {"device", "device", LinkKind::kSession},
                                       {"device", "device", LinkKind::kBus},
                                       {"device", "device", LinkKind::kCan},
                                       {"device", "device", LinkKind::kEvents}};
  RecordedMessages messages{[make_dissector](std::string_view) { return make_dissector; }};
  for (const auto& record : said) {
    (void)messages.add(record.on(kLinks[static_cast<std::size_t>(record.kind)]));
  }
  messages.finish();
  return messages;
}

MessagesInOrder all_named(std::string_view name, std::string_view fault, const std::string& lane,
                          const RecordedMessages& said) {
  MessagesInOrder all;
  const auto found = said.lanes().find(lane);
  if (found == said.lanes().end()) return all;
  for (const auto& one : found->second) {
    if (one.message.name == name && one.message.fault == fault) all.push_back(&one);
  }
  return all;
}

std::uint64_t state_told(const RecordedMessages& messages, Instant begin) {
  std::map<std::string_view, std::uint64_t> last;
  for (const auto& [lane, said] : messages.lanes()) {
    for (const auto& one : said) {
      if (one.message.time >= begin) last[one.message.name] = state_in(one);
    }
  }
  Hash hash;
  for (const auto& [name, state] : last) hash.add(state);
  return hash.value();
}

bool Shown::add(const RecordedMessages& messages) {
  constexpr std::size_t kMostAnswers = 200'000;
  bool is_new = false;
  for (const auto& [lane, said] : messages.lanes()) {
    std::uint64_t before = 0;
    for (const auto& one : said) {
      const auto state = state_in(one);
      is_new |= states_.insert(state).second;
      is_new |= transitions_.insert(Hash{}.add(before).add(state).value()).second;
      if (answers_.size() < kMostAnswers) is_new |= answers_.insert(answer_in(one)).second;
      before = state;
    }
  }
  return is_new;
}

}  // namespace armjig::campaign
