// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "harness/core/bytes.hpp"

/// Telnet (RFC 854, 855) as far as RFC 2217 needs it: bytes of a connection to data, options and
/// their subnegotiations, and back. Data are taken as they are, as with BINARY (RFC 856) in both
/// directions: nothing is done to a carriage return.
namespace armjig::telnet {

inline constexpr std::byte kIac{255};
inline constexpr std::byte kSubnegotiationBegin{250};
inline constexpr std::byte kSubnegotiationEnd{240};

enum class Verb : std::uint8_t { kWill = 251, kWont = 252, kDo = 253, kDont = 254 };

/// The options that mean something here; another peer may name any of 256.
enum class Option : std::uint8_t { kBinary = 0, kSuppressGoAhead = 3, kComPort = 44 };

/// Bytes of the user, a view of what was given to `step`, at least one.
struct Data {
  Bytes bytes;
};
struct Negotiation {
  Verb verb{};
  Option option{};
  friend bool operator==(const Negotiation&, const Negotiation&) = default;
};
/// What stood between IAC SB and IAC SE, without doubled IAC. Valid until the next `step`.
struct Subnegotiation {
  Option option{};
  Bytes bytes;          ///< at most `Decoder::kLongest`
  bool is_cut = false;  ///< there were more
};
/// Any other command, such as NOP or Are You There.
struct Command {
  std::byte code{};
  friend bool operator==(const Command&, const Command&) = default;
};

/// Takes the bytes of a peer apart, wherever they are split. Whatever comes is something: a
/// subnegotiation that another command breaks off, or that names no option, is dropped.
class Decoder {
 public:
  /// Enough for all of RFC 2217 but long signatures.
  static constexpr std::size_t kLongest = 64;

  struct Step {
    std::size_t used = 0;
    /// monostate: nothing yet.
    std::variant<std::monostate, Data, Negotiation, Subnegotiation, Command> found;
  };
  /// Reads up to the end of the first thing that is found. `used > 0` unless `in` is empty.
  [[nodiscard]] Step step(Bytes in) noexcept;

 private:
  enum class State : std::uint8_t { kData, kCommand, kVerb, kInside, kInsideCommand };

  [[nodiscard]] Step take(std::byte byte) noexcept;
  [[nodiscard]] Step take_command(std::byte code) noexcept;
  [[nodiscard]] Step end_subnegotiation() noexcept;
  void keep(std::byte byte) noexcept;

  State state_ = State::kData;
  Verb verb_{};
  BoundedBytes<kLongest + 1> inside_;  ///< the option first
  bool is_cut_ = false;
};

/// `IAC verb option`.
[[nodiscard]] BoundedBytes<3> encode(Negotiation negotiation) noexcept;

/// `data` as it goes over the connection, in pieces: each is handed to `emit`.
template <class Emit>
void escape(Bytes data, Emit&& emit) {
  while (!data.empty()) {
    std::size_t size = 0;
    while (size < data.size() && data[size] != kIac) ++size;
    if (size < data.size()) ++size;  // the piece ends with the first of the two
    emit(data.first(size));
    if (data[size - 1] == kIac) emit(data.subspan(size - 1, 1));
    data = data.subspan(size);
  }
}

}  // namespace armjig::telnet
