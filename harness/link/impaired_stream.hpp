// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "harness/link/impaired_path.hpp"
#include "harness/link/port_around.hpp"

namespace armjig {

/// A byte stream that is as bad as `Impairment` says. One `write` is a chunk, and so is what one
/// read of the inner port returns; each delivery of the bad link becomes one write to the inner
/// port, and is never joined with another one in one `read`.
///
/// Time is the inner port's, virtual or real, and passes only there: there is no thread behind
/// this. What is delayed on its way out leaves while the next `read` waits, or at the latest when
/// the next `write` or the destructor comes; a `write` does not wait for bandwidth. What comes in
/// begins its way when a `read` fetches it from the inner port.
///
/// A guarded port belongs inside, not around: a flipped bit can make a motion out of a question.
///
/// The link breaks for both directions at once: what is on its way in the other one is lost, the
/// inner port stays open but is no longer used, and all calls fail with `kDisconnected`.
class ImpairedStream final : public StreamAround {
 public:
  /// Requires `inner`.
  ImpairedStream(std::unique_ptr<StreamPort> inner, const Impairment& impairment);

  /// Hands over at once what is still on its way out, so that a last stop command is not lost with
  /// the port. Lost chunks stay lost.
  ~ImpairedStream() override;

  /// Errors: those of the inner port, for these bytes or for earlier ones that were delayed;
  /// `kDisconnected` if the link is broken, or breaks within or right behind these bytes.
  [[nodiscard]] Result<void> write(Bytes bytes) override;

  /// Errors: as for `write`. If the inner port has gone, what was on its way in comes at once, then
  /// the error.
  [[nodiscard]] Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;

  [[nodiscard]] ImpairmentStatistics statistics() const noexcept { return paths_.statistics(); }

 private:
  static constexpr std::size_t kMostAtOnce = 4096;

  [[nodiscard]] Result<void> send_due(Instant until);
  [[nodiscard]] Result<void> fetch(Instant limit);
  [[nodiscard]] std::optional<Error> failure(Instant time);
  [[nodiscard]] tl::unexpected<Error> failed(const Error& error);

  ImpairedPaths paths_;
  std::optional<Error> failure_;  ///< for good
  std::array<std::byte, kMostAtOnce> buffer_{};
};

}  // namespace armjig
