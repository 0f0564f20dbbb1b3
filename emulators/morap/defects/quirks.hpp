// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "emulators/morap/node.hpp"
#include "harness/core/time.hpp"

namespace armjig::morap::emulation {

/// What a quirk remembers.
struct QuirkMemory {
  std::vector<std::byte> bytes;
  int count = 0;
};

/// A wrong behaviour, written by hand. Each does one or two of these things.
struct Quirk {
  std::string_view name;
  std::string_view section;  ///< of docs/spec
  /// Changes a complete command, its identifier first, before the node hears it; nothing is left of
  /// one that it does not hear.
  void (*hear)(std::vector<std::byte>& command, QuirkMemory& memory, const Node& node){};
  /// Makes a command of what was written when the transaction ends before one is complete.
  void (*finish)(std::vector<std::byte>& command, QuirkMemory& memory, const Node& node){};
  /// Makes a command of what was written, of which the last byte is surplus.
  void (*surplus)(std::vector<std::byte>& command, QuirkMemory& memory, const Node& node){};
  /// Changes an answer, as long as it is on the wire, before its first byte is sent.
  void (*say)(std::vector<std::byte>& answer, QuirkMemory& memory, const Node& node){};
  /// Whether an address is acknowledged.
  bool (*acknowledges)(std::uint8_t address, const Node& node){};
  /// Whether the last of the data bytes is not.
  bool (*refuses)(Bytes written, const Node& node){};
  /// How long the clock is held behind the last byte; `written` is empty behind an address.
  Duration (*stretch)(Bytes written, bool is_read){};
};

[[nodiscard]] std::span<const Quirk> quirks() noexcept;

/// Those in corners that no suite looks into; `rare:NAME`. They are not among `all_faults`, for
/// they try campaigns, not suites.
[[nodiscard]] std::span<const Quirk> rare_quirks() noexcept;

}  // namespace armjig::morap::emulation
