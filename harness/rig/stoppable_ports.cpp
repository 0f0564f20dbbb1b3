// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/stoppable_ports.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace armjig {
namespace {

/// How long a call waits before it asks again.
constexpr Duration kSlice = std::chrono::milliseconds{50};

/// `wait(deadline)` in slices until it has `something` or the deadline has come.
template <class Port, class Wait, class Something>
auto wait_in_slices(const Port& port, const MustStop& must_stop, Instant deadline, Wait wait,
                    Something something) -> decltype(wait(deadline)) {
  for (;;) {
    if (must_stop()) return fail(ErrorCode::kForbidden);
    const auto slice = std::min(deadline, port.now() + kSlice);
    auto result = wait(slice);
    if (!result || something(*result) || slice == deadline) return result;
  }
}

}  // namespace

Result<void> StoppableStream::write(Bytes bytes) {
  if (must_stop_()) return fail(ErrorCode::kForbidden);
  return inner().write(bytes);
}

Result<std::size_t> StoppableStream::read(std::span<std::byte> into, Instant deadline) {
  return wait_in_slices(
      inner(), must_stop_, deadline, [&](Instant slice) { return inner().read(into, slice); },
      [](std::size_t size) { return size > 0; });
}

Result<void> StoppableSession::connect(Instant deadline) {
  if (must_stop_()) return fail(ErrorCode::kForbidden);
  return inner().connect(deadline);
}

Result<void> StoppableSession::send(Bytes segment) {
  if (must_stop_()) return fail(ErrorCode::kForbidden);
  return inner().send(segment);
}

Result<SessionPort::Received> StoppableSession::receive(std::span<std::byte> into,
                                                        Instant deadline) {
  return wait_in_slices(
      inner(), must_stop_, deadline, [&](Instant slice) { return inner().receive(into, slice); },
      [](const Received& received) { return received.arrival != Arrival::kDeadline; });
}

StoppableSource::StoppableSource(std::unique_ptr<SessionSource> source, const MustStop& must_stop)
    : SourceAround{std::move(source),
                   [must_stop](std::unique_ptr<SessionPort> port) {
                     return std::make_unique<StoppableSession>(std::move(port), must_stop);
                   }},
      must_stop_{must_stop} {}

void StoppableSource::pause(Duration duration) {
  for (; duration > Duration::zero() && !must_stop_(); duration -= kSlice) {
    inner().pause(std::min(duration, kSlice));
  }
}

Result<Transfer> StoppableBus::transfer(std::span<const BusMessage> messages) {
  if (must_stop_()) return fail(ErrorCode::kForbidden);
  return inner().transfer(messages);
}

Result<Ack> StoppableBus::start(BusAddress address, Access access) {
  if (must_stop_()) return fail(ErrorCode::kForbidden);
  return inner().start(address, access);
}

Result<Ack> StoppableBus::write(std::byte byte) {
  if (must_stop_()) return fail(ErrorCode::kForbidden);
  return inner().write(byte);
}

Result<std::byte> StoppableBus::read(Ack reply) {
  if (must_stop_()) return fail(ErrorCode::kForbidden);
  return inner().read(reply);
}

void StoppableBus::wait_until(Instant time) {
  while (!must_stop_() && now() < time) inner().wait_until(std::min(time, now() + kSlice));
}

}  // namespace armjig
