// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/wire/dissector.hpp"

namespace armjig {

/// When a transaction on a bus is a message of a kind. The first byte is that with the address.
struct BusPattern {
  std::optional<std::uint8_t> address{};  ///< of seven bits; none: any
  /// To the device: the byte after the address. From it: the byte that last chose what is read.
  std::optional<std::uint8_t> key{};
  bool is_alone{};          ///< nothing follows the fields
  bool is_choice{};         ///< its key chooses what is read from now on
  std::uint16_t begin{};    ///< where fields begin of which `x.count` says how many `x.0`, ... are
                            ///< there; 0: all are
  std::string cut_short{};  ///< the fault of one that is too short; empty: that is of another kind
  std::string too_many{};   ///< the fault of a count above what the fields have
  std::string surplus{};    ///< the fault of what follows the fields
};

/// A message that a device sends or gets, for those who have only field lists and no dissector.
struct MessageKind {
  std::string_view name;
  Direction direction{};
  std::span<const Field> fields;
  std::string_view bad_word{};  ///< of lines: the fault of an argument without a name
  BusPattern on_bus{};          ///< of transactions; the first kind that fits is it
};

/// How bytes become messages.
enum class Framing : std::uint8_t {
  kSizes,  ///< a stream; one size for each direction; literals tell messages from noise
  /// A stream of lines that LF ends, of pieces that colons divide. The first piece is the name of
  /// the kind. Of lines to the device blanks around the line, one last colon, and what follows the
  /// digits of a number are forgiven; those from it end with CR LF.
  kLines,
  kTransactions,  ///< of a bus, each one packet
};

/// What is wrong with a line, in words.
struct LineWords {
  std::size_t longest{};  ///< without LF; longer ones come in pieces
  std::string_view empty, unknown_word, argument_count, not_a_number, too_large, no_return,
      too_long;
};

/// What a dissector in another language is made of.
struct Dissection {
  std::vector<MessageKind> messages;
  /// In Lua, what `messages` do not say: whether a message of the right size and with the right
  /// literals is one. A function of its bytes as a string and, if it has one, of
  /// `BusPattern::begin`, which answers nil or what is wrong.
  std::string_view check{};
  Framing framing = Framing::kSizes;
  LineWords lines{};            ///< of `kLines`
  std::uint8_t first_choice{};  ///< of `kTransactions`: what is read where nobody chose
};

/// Where other programs record the device.
struct DissectedLinks {
  std::uint16_t tcp_port{};     ///< 0: none
  std::uint32_t usb_product{};  ///< vendor and product in one number; 0: none
};

/// A dissector for Wireshark, as a Lua script. Requires of `kSizes` one kind for each direction.
[[nodiscard]] std::string lua_dissector(std::string_view device, std::string_view title,
                                        const Dissection& dissection, DissectedLinks links = {});

}  // namespace armjig
