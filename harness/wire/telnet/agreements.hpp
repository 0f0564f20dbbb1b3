// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "harness/wire/telnet/telnet.hpp"

namespace armjig::telnet {

/// What one side of a connection has agreed on with the other: BINARY, SGA and COM-PORT, each for
/// both directions (RFC 1143 without its queue: we never take back a wish).
class Agreements {
 public:
  enum class Direction : std::uint8_t { kOurs, kTheirs };

  /// The wish for an option: WILL for ours, DO for theirs. Requires one of the three.
  BoundedBytes<3> ask(Option option, Direction direction) noexcept;
  /// What is to be answered. What we asked for needs no answer, and what holds already none
  /// either, so nobody loops.
  [[nodiscard]] BoundedBytes<3> on(Negotiation negotiation) noexcept;

  /// COM-PORT holds if one side has said that it will and the other has not refused.
  [[nodiscard]] bool has_com_port() const noexcept;
  /// It was asked for, and the other side does not have it.
  [[nodiscard]] bool is_com_port_refused() const noexcept { return is_com_port_refused_; }

 private:
  enum class Agreement : std::uint8_t { kNo, kAsked, kYes };
  struct Of {
    Option option{};
    std::array<Agreement, 2> of{};  ///< by `Direction`
  };

  std::array<Of, 3> options_{Of{Option::kBinary}, {Option::kSuppressGoAhead}, {Option::kComPort}};
  bool is_com_port_refused_ = false;
};

}  // namespace armjig::telnet
