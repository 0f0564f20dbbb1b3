// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/field.hpp"

namespace armjig {

enum class Direction : std::uint8_t { kToDevice, kFromDevice };

[[nodiscard]] constexpr std::string_view to_string(Direction direction) noexcept {
  return direction == Direction::kToDevice ? "to_device" : "from_device";
}

/// One dissected message, or a run of bytes that is none.
struct Message {
  Direction direction{};
  Instant time{};  ///< of its last byte
  std::string_view name;
  std::vector<std::byte> raw;
  std::span<const Field> fields;  ///< into `raw`; empty for what is not a message
  std::string fault;              ///< why the bytes are not a message; empty if they are
};

/// Turns what passes on a link into messages with named fields. One for each device; everything
/// that describes traffic (decode, differences, reports) goes through it.
class Dissector {
 public:
  Dissector() = default;
  Dissector(const Dissector&) = delete;
  Dissector& operator=(const Dissector&) = delete;
  virtual ~Dissector() = default;

  /// Takes bytes that passed at `time` in one direction and appends what is complete now.
  virtual void feed(Direction direction, Instant time, Bytes bytes, std::vector<Message>& out) = 0;

  /// Appends what is left over at the end of the traffic.
  virtual void finish(std::vector<Message>& out) = 0;
};

/// Makes the dissector of one device, at the beginning of its traffic.
using MakeDissector = std::unique_ptr<Dissector> (*)();

/// One line a field, the interesting ones first told by the caller's choice of message.
[[nodiscard]] std::string to_text(const Message& message);

/// The fields whose values differ between two messages of one kind, as `name: A, B` sentences.
[[nodiscard]] std::vector<std::string> field_differences(std::span<const Field> fields,
                                                         Bytes expected, Bytes actual);

}  // namespace armjig
