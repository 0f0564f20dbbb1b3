// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"
#include "harness/link/byte_queue.hpp"
#include "harness/link/impairment.hpp"
#include "harness/link/random_source.hpp"

namespace armjig {

/// What one direction of a bad link did so far. A piece of a chunk that was split counts as a chunk
/// from then on; hence, with what is still on its way,
/// `chunks_out` = `chunks_in` - lost - cut off + doubled + `splits` - `merges` - on their way, and
/// `bytes_out` = `bytes_in` - lost - cut off + doubled - on their way.
struct PathStatistics {
  std::uint64_t chunks_in{};
  std::uint64_t bytes_in{};
  std::uint64_t chunks_out{};
  std::uint64_t bytes_out{};
  std::uint64_t chunks_lost{};
  std::uint64_t bytes_lost{};
  std::uint64_t chunks_doubled{};
  std::uint64_t bytes_doubled{};
  std::uint64_t chunks_reordered{};  ///< that another one did overtake
  std::uint64_t bits_flipped{};
  std::uint64_t splits{};  ///< cuts made
  std::uint64_t merges{};  ///< joints made
  std::uint64_t stalls{};
  std::uint64_t disconnects{};
  std::uint64_t chunks_cut_off{};  ///< that a disconnect, or the end of the connection, left behind
  std::uint64_t bytes_cut_off{};

  friend bool operator==(const PathStatistics&, const PathStatistics&) = default;
};

/// The name and place of each count, for reports.
struct PathCount {
  std::string_view name;
  std::uint64_t PathStatistics::* place;
};
[[nodiscard]] std::span<const PathCount> path_counts() noexcept;

PathStatistics& operator+=(PathStatistics& sum, const PathStatistics& part) noexcept;

struct ImpairmentStatistics {
  PathStatistics out;  ///< towards the device
  PathStatistics in;   ///< from the device

  friend bool operator==(const ImpairmentStatistics&, const ImpairmentStatistics&) = default;
};

/// One line, all counts that are not 0: `out: 100 chunks_in, ...; in: nothing`.
[[nodiscard]] std::string to_string(const ImpairmentStatistics& statistics);

/// Draws from the law; never negative.
[[nodiscard]] Duration draw(const DurationLaw& law, RandomSource& random) noexcept;

/// One direction of a bad link: chunks in with their times, chunks out when they are due. Does no
/// I/O; the same chunks at the same times with the same seed come out the same. Each kind of defect
/// draws from a source of its own: which chunks are lost, doubled, held back or stalled does not
/// depend on what else is switched on.
///
/// Times that it is given never decrease. What comes out is in order of time, and of coming in but
/// for reordered chunks; a chunk stays in one piece or in neighbouring pieces.
class ImpairedPath {
 public:
  /// What comes out at a time.
  struct Delivery {
    Instant due{};
    std::vector<std::byte> bytes;
  };
  enum class End : std::uint8_t {
    kOpen,    ///< there is more to come, or may be
    kClosed,  ///< by `close`
    kBroken,  ///< by a disconnect
  };

  ImpairedPath(const PathImpairment& impairment, RandomSource random);

  /// Takes bytes that are handed over at once. Behind the end they are cut off.
  void push(Instant time, Bytes bytes);

  /// Ends the path behind everything that is on its way. Does nothing if it has ended.
  void close(Instant time);

  /// The next delivery that is due at `now` or earlier.
  [[nodiscard]] std::optional<Delivery> pop(Instant now);

  /// When the next delivery is due, or the end unless it has come by `now`, if nothing more comes
  /// in.
  [[nodiscard]] std::optional<Instant> next_due(Instant now) const noexcept;

  /// Whether the path has come to its end, which is due behind all deliveries.
  [[nodiscard]] End end(Instant now) const noexcept;

  /// Cuts off everything that is on its way.
  void drop() noexcept;

  /// Begins a new connection, with an empty path; counts and random sources go on.
  void reopen() noexcept;

  [[nodiscard]] const PathStatistics& statistics() const noexcept { return statistics_; }

 private:
  enum Effect : std::uint8_t {
    kBitErrors,
    kLoss,
    kDoubling,
    kReordering,
    kSplit,
    kMerge,
    kDelay,
    kStall,
    kStallLength,
    kDisconnect,
    kEffectCount,
  };
  struct Piece {
    Instant due{};
    std::vector<std::byte> bytes;
    bool begins_chunk = false;
  };
  /// Pieces joined so far, and how long they wait for another one.
  struct Joint {
    Delivery delivery;
    std::size_t pieces{};
    Instant wait_until{};
  };

  [[nodiscard]] RandomSource& random(Effect effect) noexcept { return random_[effect]; }

  void take_chunk(Instant time, Bytes chunk);
  void carry(Instant time, Bytes chunk);
  void break_off(Instant time);
  void cut_off(std::size_t chunks, std::size_t bytes) noexcept;
  [[nodiscard]] Instant transmit(Instant time, std::size_t size) noexcept;
  [[nodiscard]] std::vector<Piece> pieces_of(Instant time, Bytes chunk);
  void flip_bits(std::span<std::byte> bytes) noexcept;
  void hold_back(std::vector<Piece> chunk);
  void send(std::vector<Piece> chunk);
  void release_held(Instant until);
  void append(Piece piece);
  [[nodiscard]] bool is_joint_complete();
  void release_joint(Instant due);

  PathImpairment impairment_;
  std::array<RandomSource, kEffectCount> random_;
  PathStatistics statistics_;

  std::uint64_t handed_over_{};  ///< bytes on this connection
  Instant free_{};               ///< when the link can begin with the next chunk
  Instant last_due_{};           ///< of the pieces appended so far
  // From the receiving end backwards: what is ready to be popped, what waits to be joined, and the
  // chunks that wait to be overtaken, behind which nothing has been appended yet.
  std::deque<Delivery> ready_;
  std::optional<Joint> joint_;
  std::vector<Piece> held_;
  End end_{};
  Instant end_due_{};
};

/// Both directions of a link.
struct ImpairedPaths {
  ImpairedPath out;
  ImpairedPath in;

  explicit ImpairedPaths(const Impairment& impairment)
      : out{impairment.out, RandomSource{impairment.seed}.fork(0)},
        in{impairment.in, RandomSource{impairment.seed}.fork(1)} {}

  /// The next time that something comes out of either, or that one ends, but not beyond `deadline`.
  [[nodiscard]] Instant next_due(Instant now, Instant deadline) const noexcept;

  void drop() noexcept {
    out.drop();
    in.drop();
  }

  /// Whether the link has broken by then, in one direction, hence in both.
  [[nodiscard]] bool is_broken(Instant time) const noexcept {
    constexpr auto kBroken = ImpairedPath::End::kBroken;
    return out.end(time) == kBroken || in.end(time) == kBroken;
  }

  /// What has come in by `until`, of one delivery and at most as much as there is room for; the
  /// rest of it stays, also if the path is dropped.
  [[nodiscard]] std::size_t take(std::span<std::byte> into, Instant until);
  void forget_taken() noexcept { taken_.clear(); }

  [[nodiscard]] ImpairmentStatistics statistics() const noexcept {
    return {out.statistics(), in.statistics()};
  }

 private:
  ByteQueue taken_;
};

}  // namespace armjig
