// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "harness/link/impaired_path.hpp"
#include "harness/link/port_around.hpp"

namespace armjig {

/// Connections that are as bad as `Impairment` says. One `send` is a chunk, and so is what one
/// receive of the inner port returns; each delivery of the bad link becomes one segment to the
/// server, and is never joined with another one in one `receive`. Time is as in `ImpairedStream`:
/// what is delayed on its way out leaves while the next `receive` waits, or at the latest when the
/// next `send`, `close` or the destructor comes.
///
/// A disconnect throws the connection away on both sides: the server sees a reset, and so does
/// `receive`, once. `connect` then begins a new one; random events and counts go on, the bytes of
/// `disconnect_after` count anew.
class ImpairedSession final : public SessionAround {
 public:
  /// Requires `inner`, without a connection. `paths` are for this session alone, and tell others
  /// their counts.
  ImpairedSession(std::unique_ptr<SessionPort> inner, std::shared_ptr<ImpairedPaths> paths);
  ImpairedSession(std::unique_ptr<SessionPort> inner, const Impairment& impairment)
      : ImpairedSession{std::move(inner), std::make_shared<ImpairedPaths>(impairment)} {}

  /// Hands over at once what is still on its way out.
  ~ImpairedSession() override;

  /// Errors: those of the inner port; `kBusy` also while a reset was not received or closed.
  [[nodiscard]] Result<void> connect(Instant deadline) override;

  /// Errors: those of the inner port, for this segment or for earlier ones that were delayed;
  /// `kDisconnected` also after `half_close`, and if the link breaks within or right behind it.
  [[nodiscard]] Result<void> send(Bytes segment) override;

  /// Errors: as for the inner port, and as for `send`. An end comes behind all data that were on
  /// their way and is said again each time; a reset by the server comes before them.
  [[nodiscard]] Result<Received> receive(std::span<std::byte> into, Instant deadline) override;

  /// Behind what is on its way out.
  void half_close() override;
  /// Hands over at once what is on its way out, then closes.
  void close() override;
  /// What is on its way is lost.
  void reset() override;

  [[nodiscard]] ImpairmentStatistics statistics() const noexcept { return paths_->statistics(); }

 private:
  enum class State : std::uint8_t {
    kClosed,
    kOpen,
    kHalfClosing,  ///< as soon as everything on its way out has left
    kHalfClosed,
    kBroken,  ///< and `receive` has not yet said so
  };
  static constexpr std::size_t kMostAtOnce = 4096;

  [[nodiscard]] Result<void> send_due(Instant until);
  [[nodiscard]] Result<std::optional<Received>> fetch(Instant limit);
  void break_if_due(Instant time);
  void forget(State next);

  std::shared_ptr<ImpairedPaths> paths_;
  State state_{};
  std::array<std::byte, kMostAtOnce> buffer_{};
};

}  // namespace armjig
