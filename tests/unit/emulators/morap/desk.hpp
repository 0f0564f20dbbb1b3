// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "emulators/morap/node.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::morap::emulation::test {

/// A node that is spoken to in hexadecimal digits, as docs/spec/morap.md writes them. Talking takes
/// no time here, so that ticks come only when they are asked for.
class Desk {
 public:
  explicit Desk(const NodeSetup& setup) : node_{setup} {}

  /// A write. How many data bytes were acknowledged.
  std::size_t write(std::string_view data) {
    node_.start(now_, /*is_read=*/false);
    std::size_t acknowledged = 0;
    for (const auto byte : armjig::test::hex(data)) {
      if (node_.write(now_, byte)) ++acknowledged;
    }
    return acknowledged;
  }
  armjig::test::ByteVector read(std::size_t size) {
    node_.start(now_, /*is_read=*/true);
    armjig::test::ByteVector bytes;
    for (; size > 0; --size) bytes.push_back(node_.read(now_));
    return bytes;
  }
  /// Lets ticks come.
  void tick(int count = 1) {
    for (; count > 0; --count) {
      now_ = node_.next_tick();
      node_.advance_to(now_);
    }
  }
  /// To this many counts since power-on.
  void turn_to(std::int32_t counts) {
    node_.turn_encoder(now_, counts - turned_);
    turned_ = counts;
  }
  [[nodiscard]] Node& node() noexcept { return node_; }
  [[nodiscard]] Instant now() const noexcept { return now_; }

 private:
  Node node_;
  Instant now_{};
  std::int32_t turned_ = 0;
};

}  // namespace armjig::morap::emulation::test
