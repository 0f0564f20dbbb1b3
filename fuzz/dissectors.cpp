// SPDX-License-Identifier: Apache-2.0
// Any bytes in both directions of any device's link: its dissector gives every byte back, each
// message is of a kind that its description for other programs has, and its fields can be told,
// found and written again.
//
// Input: which device, then pieces, each after a byte that says its direction and length. On a bus
// the first byte of a piece says its direction.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fuzz/input.hpp"
#include "fuzz/require.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/append_text.hpp"
#include "harness/wire/brief.hpp"
#include "harness/wire/dissection.hpp"
#include "harness/wire/dissector.hpp"
#include "harness/wire/field.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "harness/wire/parol6/dissector.hpp"

namespace armjig::fuzz::dissectors {
namespace {

struct Device {
  bool is_bus;  ///< where the first byte of a piece says its direction
  MakeDissector make_dissector;
  Dissection description;
};

const Device& device(std::uint8_t number) {
  static const std::array<Device, 3> kDevices{
      Device{false, parol6::make_dissector, parol6::dissection()},
      Device{true, morap::make_dissector, morap::dissection()},
      Device{false, kinovazed::make_dissector, kinovazed::dissection()}};
  return kDevices[number % kDevices.size()];
}

void check_field(const Field& field, const Message& message) {
  const auto value = field_value(field, message.raw);
  require(!field_text(field, value).empty(), "a field can be told");
  require(!text_in_both(field, value).empty(), "a field can be told in both ways");
  require(!is_state(field) || number_of(field, value) == static_cast<double>(value),
          "a state is its number");
  require(find_field(message.fields, field.name) != nullptr, "a field is found by its name");
  if (field.place != Place::kBytes) return;
  auto copy = message.raw;
  set_field_value(field, copy, value);
  require(copy == message.raw, "writing what was read changes nothing");
  set_field_value(field, copy, ~value);
  const auto differences = field_differences(message.fields, message.raw, copy);
  require(!differences.empty(), "another value is a difference");
}

bool is_described(const Message& message, const Dissection& description) {
  return std::ranges::any_of(description.messages, [&](const MessageKind& kind) {
    return kind.name == message.name && kind.direction == message.direction;
  });
}

void check_message(const Message& message, const Dissection& description) {
  const auto line = to_line(message);
  require(!line.empty() && line.find('\n') == std::string::npos, "a message is told in one line");
  std::string appended;
  append_line(appended, message);
  require(appended == line, "the same with memory that serves again");
  require(!to_text(message).empty(), "a message can be told");
  std::string hex;
  append_hex(hex, message.raw);
  require(hex == to_hex(message.raw), "its bytes, too");
  if (!message.fault.empty() || message.fields.empty()) return;
  require(is_described(message, description), "a message is of a kind that is described");
  require(field_differences(message.fields, message.raw, message.raw).empty(),
          "a message does not differ from itself");
  for (const auto& field : message.fields) check_field(field, message);
}

void check(Input input) {
  const auto& [is_bus, make_dissector, description] = device(input.u8());
  const auto dissector = make_dissector();
  std::array<std::vector<std::byte>, 2> passed;
  std::vector<Message> messages;
  for (Instant now{}; !input.is_empty(); now += std::chrono::milliseconds{1}) {
    const auto how = input.u8();
    const auto piece = input.bytes(how & 0x7F);
    const bool is_from =
        is_bus ? !piece.empty() && (piece[0] & std::byte{1}) != std::byte{} : (how & 0x80) != 0;
    const auto direction = is_from ? Direction::kFromDevice : Direction::kToDevice;
    auto& all = passed[static_cast<std::size_t>(direction)];
    all.insert(all.end(), piece.begin(), piece.end());
    dissector->feed(direction, now, piece, messages);
  }
  dissector->finish(messages);
  std::array<std::vector<std::byte>, 2> seen;
  for (const auto& message : messages) {
    check_message(message, description);
    auto& all = seen[static_cast<std::size_t>(message.direction)];
    all.insert(all.end(), message.raw.begin(), message.raw.end());
  }
  require(seen == passed, "no byte is lost, and none is in another order");
}

}  // namespace
}  // namespace armjig::fuzz::dissectors

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::dissectors::check(armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
