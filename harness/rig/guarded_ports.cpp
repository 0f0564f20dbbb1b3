// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/guarded_ports.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace armjig {
namespace {

using namespace std::chrono_literals;

/// Supervisors want a sign of life twice a second.
constexpr Duration kLongestWait = 200ms;

/// A server may be busy with the arm until it takes the stop up, and must not be left with its
/// answer on the way. TCP loses nothing.
constexpr Duration kServerTakes = 500ms;
constexpr Duration kServerAccepts = 2s;

/// As a judge wants it.
std::vector<std::byte> bytes_of(const BusMessage& message, Bytes data) {
  std::vector<std::byte> bytes(1 + data.size());
  bytes.front() = head_of(message);
  std::ranges::copy(data, bytes.begin() + 1);
  return bytes;
}

}  // namespace

GuardedStream::GuardedStream(std::unique_ptr<StreamPort> port, std::unique_ptr<Judge> judge,
                             Permissions permissions, std::shared_ptr<GuardState> watch)
    : StreamAround{std::move(port)},
      Guard{std::move(judge), permissions, std::move(watch), {8, 10ms}} {
  unread_.reserve(kMostUnread);
}

Result<std::size_t> GuardedStream::read(std::span<std::byte> into, Instant deadline) {
  for (;;) {
    watch().give_sign_of_life();
    if (!unread_.empty()) return unread_.take(into);
    if (auto taken = take_in(std::min(deadline, now() + kLongestWait)); !taken) {
      return tl::unexpected{taken.error()};
    }
    if (unread_.empty() && now() >= deadline) return 0;
  }
}

Result<void> GuardedStream::listen(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  const auto size = inner().read(buffer, deadline);
  if (!size) return tl::unexpected{size.error()};
  const auto bytes = Bytes{buffer}.first(*size);
  hear(bytes);
  unread_.add(bytes, kMostUnread);
  return {};
}

GuardedSession::GuardedSession(std::unique_ptr<SessionPort> port, std::unique_ptr<Judge> judge,
                               Permissions permissions, std::shared_ptr<GuardState> watch)
    : SessionAround{std::move(port)},
      Guard{std::move(judge), permissions, std::move(watch), {1, kServerTakes}} {}

GuardedSession::~GuardedSession() {
  leave_for_good(WhenLeft::kStop);
  inner().close();
}

Result<void> GuardedSession::connect(Instant deadline) {
  if (auto connected = inner().connect(deadline); !connected) return connected;
  is_open_ = true;
  unread_.clear();
  unread_end_.reset();
  auto done = begin(inner().lifeline());
  if (!done) {
    leave_for_good(WhenLeft::kSayNothing);
    inner().close();
  }
  return done;
}

Result<void> GuardedSession::send(Bytes segment) {
  if (!is_open_) return fail(ErrorCode::kDisconnected);
  return send_guarded(segment);
}

Result<SessionPort::Received> GuardedSession::receive(std::span<std::byte> into, Instant deadline) {
  for (;;) {
    watch().give_sign_of_life();
    if (const auto size = unread_.take(into); size > 0) return Received{Arrival::kData, size};
    if (const auto end = std::exchange(unread_end_, std::nullopt)) return *end;
    if (!is_open_) return inner().receive(into, deadline);
    if (auto taken = take_in(std::min(deadline, now() + kLongestWait)); !taken) {
      return tl::unexpected{taken.error()};
    }
    const bool is_over = unread_.empty() && !unread_end_ && now() >= deadline;
    if (is_over) return Received{Arrival::kDeadline, 0};
  }
}

Result<void> GuardedSession::listen(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  const auto received = inner().receive(buffer, deadline);
  if (!received) return tl::unexpected{received.error()};
  const auto bytes = Bytes{buffer}.first(received->size);
  hear(bytes);
  unread_.add(bytes, kMostUnread);
  const bool is_end = received->arrival == Arrival::kEnd || received->arrival == Arrival::kReset;
  if (is_end) unread_end_ = *received;
  if (received->arrival == Arrival::kReset) leave_for_good(WhenLeft::kSayNothing);
  return {};
}

Result<void> GuardedSession::settle(Instant deadline) {
  while (now() < deadline && !unread_end_) {
    watch().give_sign_of_life();
    if (auto heard = listen(std::min(deadline, now() + kLongestWait)); !heard) return heard;
  }
  return {};
}

void GuardedSession::half_close() {
  leave(watch().when_left);
  inner().half_close();
}

void GuardedSession::close() {
  leave_for_good(watch().when_left);
  inner().close();
}

void GuardedSession::reset() {
  leave_for_good(watch().when_left);
  inner().reset();
}

void GuardedSession::leave(WhenLeft when_left) {
  if (!is_open_) return;
  if (when_left == WhenLeft::kStop) return stop_if_moving();
  if (may_be_moving()) watch().has_left_moving = true;
}

/// The supervisor holds the socket, too, so it goes first.
void GuardedSession::leave_for_good(WhenLeft when_left) {
  leave(when_left);
  is_open_ = false;
  end();
}

GuardedBus::GuardedBus(std::unique_ptr<BusPort> port, std::unique_ptr<Judge> judge,
                       Permissions permissions, std::shared_ptr<GuardState> watch)
    : Guard{std::move(judge), permissions, std::move(watch), {8, 10ms}}, port_{std::move(port)} {}

Result<Transfer> GuardedBus::transfer(std::span<const BusMessage> messages) {
  std::vector<std::vector<std::byte>> parts;
  for (const auto& message : messages) parts.push_back(bytes_of(message, message.write));
  const std::vector<Bytes> views{parts.begin(), parts.end()};
  if (auto admitted = admit(views); !admitted) return tl::unexpected{admitted.error()};
  const auto done = port_->transfer(messages);
  if (done == Transfer::kDone) {
    for (const auto& message : messages) {
      const bool is_read = message.access == Access::kRead;
      hear(bytes_of(message, is_read ? Bytes{message.read} : message.write));
    }
  }
  look();
  return done;
}

Result<void> GuardedBus::put(Bytes message) {
  const BusAddress address{static_cast<std::uint8_t>(std::to_integer<unsigned>(message[0]) >> 1U)};
  const auto part = write_to(address, message.subspan(1));
  const auto done = port_->transfer({&part, 1});
  if (!done) return tl::unexpected{done.error()};
  if (*done != Transfer::kDone) return fail(ErrorCode::kRefused);
  hear(message);
  return {};
}

/// Nothing comes unasked.
Result<void> GuardedBus::listen(Instant deadline) {
  port_->wait_until(deadline);
  return {};
}

void GuardedBus::wait_until(Instant time) {
  do {
    watch().give_sign_of_life();
    port_->wait_until(std::min(time, now() + kLongestWait));
  } while (now() < time);
}

GuardedSource::GuardedSource(std::unique_ptr<SessionSource> inner,
                             std::unique_ptr<Judge> (*make_judge)(), Permissions permissions,
                             const std::shared_ptr<GuardState>& watch)
    : SourceAround{std::move(inner),
                   [make_judge, permissions, watch](std::unique_ptr<SessionPort> port) {
                     return std::make_unique<GuardedSession>(std::move(port), make_judge(),
                                                             permissions, watch);
                   }},
      make_judge_{make_judge},
      watch_{watch} {}

/// A client of its own stops what another left moving.
GuardedSource::~GuardedSource() {
  if (!watch_->has_left_moving) return;
  GuardedSession last{inner().make_port(), make_judge_(), {}, watch_};
  if (last.connect(last.now() + kServerAccepts)) last.stop();
}

void GuardedSource::pause(Duration duration) {
  for (const auto end = now() + duration; now() < end;) {
    watch_->give_sign_of_life();
    SourceAround::pause(std::min(end - now(), kLongestWait));
  }
}

}  // namespace armjig
