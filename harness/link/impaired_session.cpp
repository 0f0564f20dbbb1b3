// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impaired_session.hpp"

#include <cassert>
#include <tuple>

namespace armjig {

using End = ImpairedPath::End;

ImpairedSession::ImpairedSession(std::unique_ptr<SessionPort> inner,
                                 std::shared_ptr<ImpairedPaths> paths)
    : SessionAround{std::move(inner)}, paths_{std::move(paths)} {}

ImpairedSession::~ImpairedSession() { std::ignore = send_due(Instant::max()); }

Result<void> ImpairedSession::connect(Instant deadline) {
  if (state_ == State::kBroken) return fail(ErrorCode::kBusy);
  auto connected = inner().connect(deadline);
  if (!connected) return connected;
  paths_->out.reopen();
  paths_->in.reopen();
  state_ = State::kOpen;
  return {};
}

Result<void> ImpairedSession::send(Bytes segment) {
  const auto time = now();
  break_if_due(time);
  if (state_ != State::kOpen) return fail(ErrorCode::kDisconnected);
  paths_->out.push(time, segment);
  if (auto sent = send_due(time); !sent) return sent;
  break_if_due(time);
  if (state_ != State::kOpen) return fail(ErrorCode::kDisconnected);
  return {};
}

Result<SessionPort::Received> ImpairedSession::receive(std::span<std::byte> into,
                                                       Instant deadline) {
  assert(!into.empty());
  for (bool has_fetched = false;; has_fetched = true) {
    if (state_ == State::kClosed) return fail(ErrorCode::kDisconnected);
    const auto time = now();  // one for all, or what falls between two would be waited for too long
    if (const auto sent = send_due(time); !sent) return tl::unexpected{sent.error()};
    if (const auto size = paths_->take(into, time); size > 0) return Received{Arrival::kData, size};
    break_if_due(time);
    if (state_ == State::kBroken) {
      state_ = State::kClosed;
      return Received{Arrival::kReset, 0};
    }
    if (paths_->in.end(time) == End::kClosed) return Received{Arrival::kEnd, 0};
    // A server may send without end what is delayed beyond the deadline.
    if (has_fetched && time >= deadline) return Received{Arrival::kDeadline, 0};
    const auto fetched = fetch(paths_->next_due(time, deadline));
    if (!fetched) return tl::unexpected{fetched.error()};
    if (*fetched) return **fetched;
  }
}

void ImpairedSession::half_close() {
  if (state_ != State::kOpen) return;
  state_ = State::kHalfClosing;
  paths_->out.close(now());
  std::ignore = send_due(now());
}

void ImpairedSession::close() {
  std::ignore = send_due(Instant::max());
  inner().close();
  forget(State::kClosed);
}

void ImpairedSession::reset() {
  inner().reset();
  forget(State::kClosed);
}

Result<void> ImpairedSession::send_due(Instant until) {
  while (const auto delivery = paths_->out.pop(until)) {
    if (auto sent = inner().send(delivery->bytes); !sent) {
      paths_->out.drop();
      return sent;
    }
  }
  if (state_ == State::kHalfClosing && paths_->out.end(until) == End::kClosed) {
    inner().half_close();
    state_ = State::kHalfClosed;
  }
  return {};
}

/// Waits for the inner port until `limit`. What it returns is for the caller at once.
Result<std::optional<SessionPort::Received>> ImpairedSession::fetch(Instant limit) {
  const auto received = inner().receive(buffer_, limit);
  if (!received) return tl::unexpected{received.error()};
  switch (received->arrival) {
    case Arrival::kData:
      paths_->in.push(now(), Bytes{buffer_}.first(received->size));
      break;
    case Arrival::kDeadline:
      break;
    case Arrival::kEnd:
      paths_->in.close(now());
      break;
    case Arrival::kReset:
      forget(State::kClosed);
      return *received;
  }
  return std::nullopt;
}

void ImpairedSession::break_if_due(Instant time) {
  if (!paths_->is_broken(time) || state_ == State::kClosed || state_ == State::kBroken) return;
  inner().reset();
  forget(State::kBroken);
}

void ImpairedSession::forget(State next) {
  paths_->drop();
  paths_->forget_taken();
  state_ = next;
}

}  // namespace armjig
