// SPDX-License-Identifier: Apache-2.0
#include "harness/link/reopening_ports.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace armjig {
namespace {

constexpr Duration kBetweenTries = std::chrono::milliseconds{500};

}  // namespace

template <class Port>
Reopener<Port>::Reopener(std::unique_ptr<Port> port, Open open) noexcept
    : port_{std::move(port)}, open_{std::move(open)} {}

template <class Port>
void Reopener<Port>::wait_for_device(Instant deadline) {
  std::this_thread::sleep_for(std::min(deadline, next_try_) - now());
  if (now() < next_try_) return;
  if (auto opened = open_()) {
    port_ = *std::move(opened);
    ++reopened_;
  }
  next_try_ = now() + kBetweenTries;
}

template <class Port>
Result<void> Reopener<Port>::lose(const Error& error) {
  if (error.code != ErrorCode::kDisconnected) return tl::unexpected{error};
  port_.reset();  // frees its lock, or the next open would find it busy
  next_try_ = now();
  return {};
}

template class Reopener<StreamPort>;
template class Reopener<BusPort>;

Result<void> ReopeningStream::write(Bytes bytes) {
  auto* const port = device_.port();
  if (port == nullptr) return {};
  const auto written = port->write(bytes);
  return written ? written : device_.lose(written.error());
}

Result<std::size_t> ReopeningStream::read(std::span<std::byte> into, Instant deadline) {
  if (device_.port() == nullptr) device_.wait_for_device(deadline);
  auto* const port = device_.port();
  if (port == nullptr) return 0;
  const auto size = port->read(into, port->now() + (deadline - now()));
  if (size) return size;
  if (auto lost = device_.lose(size.error()); !lost) return tl::unexpected{lost.error()};
  return 0;
}

Result<Transfer> ReopeningBus::transfer(std::span<const BusMessage> messages) {
  auto* const port = adapter_.port();
  if (port == nullptr) return fail(ErrorCode::kNotFound);
  const auto done = port->transfer(messages);
  if (done) return done;
  if (auto lost = adapter_.lose(done.error()); !lost) return tl::unexpected{lost.error()};
  return fail(ErrorCode::kNotFound, done.error().detail);
}

void ReopeningBus::wait_until(Instant time) {
  if (adapter_.port() == nullptr) adapter_.wait_for_device(time);
  while (now() < time) {
    if (adapter_.port() == nullptr) {
      adapter_.wait_for_device(time);
    } else {
      std::this_thread::sleep_for(time - now());
    }
  }
}

}  // namespace armjig
