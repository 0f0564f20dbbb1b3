// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

/// What a bad link does, as data. `ImpairedPath` does it, `ImpairedStream`, `ImpairedSession` and
/// `ImpairedBus` do it to ports.
///
/// Chances are per *chunk*: what one `write` or `send` hands over, and what one read of the inner
/// port returns (at most 4096 bytes), each cut into chunks of at most `chunk` bytes if that is
/// given. On a bus every byte is a chunk, addresses included.
namespace armjig {

/// A time that is drawn anew whenever it is needed, and is never negative. Both parameters are from
/// zero to an hour.
struct DurationLaw {
  enum class Kind : std::uint8_t {
    kConstant,
    kUniform,
    kNormal,  ///< what would be negative is 0
    kExponential,
  };
  Kind kind{};
  Duration first{};   ///< the constant, the least, or the mean
  Duration second{};  ///< `kUniform`: the most; `kNormal`: the standard deviation; else 0

  friend bool operator==(const DurationLaw&, const DurationLaw&) = default;
};

/// One direction of a bad link. Each default is a link without that defect.
struct PathImpairment {
  enum class Grouping : std::uint8_t { kNone, kFixed, kRandom };

  /// A chunk that is held back lets the next one overtake it. It waits no longer than `wait`, which
  /// reaches over two periods of a 100 Hz loop.
  struct Reordering {
    double rate{};
    Duration wait = std::chrono::milliseconds{20};
    friend bool operator==(const Reordering&, const Reordering&) = default;
  };
  /// `kFixed`: pieces of `size` bytes and a rest; `kRandom`: each piece is of any size that is
  /// left.
  struct Split {
    Grouping kind{};
    std::size_t size{};
    friend bool operator==(const Split&, const Split&) = default;
  };
  /// `kFixed`: pieces are joined until there are at least `size` bytes; `kRandom`: a coin decides
  /// whether another one is waited for. Nothing waits longer than `wait`: 16 ms is the latency
  /// timer that FTDI's USB serial chips start with (AN232B-04).
  struct Merge {
    Grouping kind{};
    std::size_t size{};
    Duration wait = std::chrono::milliseconds{16};
    friend bool operator==(const Merge&, const Merge&) = default;
  };
  /// Before the chunk the link stands still; what follows waits too.
  struct Stall {
    double rate{};
    DurationLaw length;
    friend bool operator==(const Stall&, const Stall&) = default;
  };

  std::size_t chunk{};  ///< bytes; 0: as they come
  double bit_errors{};  ///< chance per bit
  double loss{};        ///< chance per chunk
  double doubling{};    ///< chance per chunk
  Reordering reordering;
  Split split;
  Merge merge;
  DurationLaw delay;          ///< of each piece; order is kept all the same
  std::uint64_t bandwidth{};  ///< bytes a second; 0: no limit. Lost bytes take their time as well.
  Stall stall;
  double disconnect{};               ///< chance per chunk: the link breaks before it
  std::uint64_t disconnect_after{};  ///< bytes handed over; 0: never

  friend bool operator==(const PathImpairment&, const PathImpairment&) = default;
};

/// Both directions of a bad link, seen from the host.
struct Impairment {
  PathImpairment out;  ///< towards the device
  PathImpairment in;   ///< from the device
  std::uint64_t seed = 1;

  friend bool operator==(const Impairment&, const Impairment&) = default;
};

/// Reads `NAME=VALUE,...`, as in `loss=0.1%,delay=normal(2ms,1ms),split=random,in.loss=2%,seed=7`.
/// A name with `out.` or `in.` means that direction only, and comes before one without, wherever it
/// stands. Problems name the item: `kUnknownOption`, `kBadValue`.
[[nodiscard]] Outcome<Impairment> parse_impairment(std::string_view text);

/// What `parse_impairment` reads as the same impairment, the seed included, so that a report that
/// has it can be repeated.
[[nodiscard]] std::string to_string(const Impairment& impairment);

/// The forms that `parse_impairment` takes, one a line, for help texts.
[[nodiscard]] std::string impairment_forms();

}  // namespace armjig
