// SPDX-License-Identifier: Apache-2.0
#include "harness/link/reopening_stream.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace armjig {
namespace {

constexpr Duration kBetweenTries = std::chrono::milliseconds{500};

}  // namespace

ReopeningStream::ReopeningStream(std::unique_ptr<StreamPort> port, Open open) noexcept
    : port_{std::move(port)}, open_{std::move(open)} {}

Result<void> ReopeningStream::write(Bytes bytes) {
  if (port_ == nullptr) return {};
  const auto written = port_->write(bytes);
  return written ? written : lose(written.error());
}

Result<std::size_t> ReopeningStream::read(std::span<std::byte> into, Instant deadline) {
  if (port_ == nullptr) wait_for_device(deadline);
  if (port_ == nullptr) return 0;
  const auto size = port_->read(into, port_->now() + (deadline - now()));
  if (size) return size;
  if (auto lost = lose(size.error()); !lost) return tl::unexpected{lost.error()};
  return 0;
}

/// Sleeps at most until `deadline`, so that whoever reads keeps its pace.
void ReopeningStream::wait_for_device(Instant deadline) {
  std::this_thread::sleep_for(std::min(deadline, next_try_) - now());
  if (now() < next_try_) return;
  if (auto opened = open_()) {
    port_ = *std::move(opened);
    ++reopened_;
  }
  next_try_ = now() + kBetweenTries;
}

/// Only a device that has gone may come back.
Result<void> ReopeningStream::lose(const Error& error) {
  if (error.code != ErrorCode::kDisconnected) return tl::unexpected{error};
  port_.reset();  // frees its lock, or the next open would find it busy
  next_try_ = now();
  return {};
}

}  // namespace armjig
