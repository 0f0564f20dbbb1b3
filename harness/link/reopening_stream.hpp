// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "harness/link/descriptor.hpp"
#include "harness/link/stream_port.hpp"

namespace armjig {

/// A real port that is opened again when its device has gone: a cable pulled, a board reset, an
/// emulator restarted. While it is away, what is written is lost and nothing comes. Its time goes
/// on without a jump. It has no lifeline, because its file changes: who has to stop an arm
/// through one (`GuardedStream`) can not use it.
class ReopeningStream final : public StreamPort {
 public:
  using Open = std::function<Outcome<std::unique_ptr<StreamPort>>()>;

  /// `port` is open; `open` makes the next one.
  ReopeningStream(std::unique_ptr<StreamPort> port, Open open) noexcept;

  Result<void> write(Bytes bytes) override;
  /// While the device is away, tries to open it at once and then twice a second.
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;
  [[nodiscard]] Instant now() const override { return clock_.now(); }

  /// How often it was opened again.
  [[nodiscard]] std::uint64_t reopened() const noexcept { return reopened_; }

 private:
  void wait_for_device(Instant deadline);
  [[nodiscard]] Result<void> lose(const Error& error);

  std::unique_ptr<StreamPort> port_;  ///< none while the device is away
  Open open_;
  Stopwatch clock_;
  Instant next_try_{};
  std::uint64_t reopened_ = 0;
};

}  // namespace armjig
