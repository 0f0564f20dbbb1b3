// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/kinovazed/client.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace armjig::kinovazed::drive {
namespace {

constexpr Duration kAttempt = std::chrono::seconds{1};  ///< to connect, and between two of them
constexpr Duration kGlance = std::chrono::milliseconds{100};  ///< at `is_cancelled`

}  // namespace

Client::~Client() {
  if (!drive_.is_connected()) return;
  if (drive_.is_stick_deflected()) (void)begin({.verb = Verb::kMoveJoystick});
  const auto deadline = now() + patience::kReply;
  while (drive_.is_connected() && drive_.awaits_reply() && now() < deadline) {
    (void)poll(deadline);
  }
  port_.close();
}

Result<void> Client::connect(Instant deadline) {
  if (!drive_.is_connected()) {
    if (auto opened = open(deadline); !opened) return opened;
  }
  while (!drive_.heartbeat()) {
    if (now() >= deadline) return fail(ErrorCode::kTimedOut);
    if (!drive_.is_connected()) return fail(ErrorCode::kDisconnected);
    if (auto polled = poll(deadline); !polled) return polled;
  }
  return {};
}

Result<CallResult> Client::call(const Command& command, const CallOptions& how) {
  while (drive_.is_connected() && now() < drive_.not_before(command)) {
    if (auto polled = poll(drive_.not_before(command)); !polled) {
      return tl::unexpected{polled.error()};
    }
  }
  const auto id = begin(command);
  if (!id) return tl::unexpected{id.error()};
  const auto deadline = now() + how.time.value_or(patience::kReply + time_for(command.verb));
  for (;;) {
    if (const auto ending = take_ending(*id)) return CallResult{.ending = *ending};
    if (how.is_cancelled && how.is_cancelled()) {
      if (const auto sent = cancel(); !sent) return tl::unexpected{sent.error()};
      return CallResult{.kind = CallResult::Kind::kCancelled};
    }
    if (now() >= deadline) return CallResult{.kind = CallResult::Kind::kTimedOut};
    // A connection that is lost has ended the request; to begin a new one is not our business here.
    if (drive_.is_connected()) receive(std::min(deadline, now() + kGlance));
  }
}

Result<RequestId> Client::begin(const Command& command) {
  const auto id = drive_.begin(now(), command);
  if (!id) return id;
  if (const auto sent = flush(); !sent) {
    drive_.withdraw(*id);
    return tl::unexpected{sent.error()};
  }
  return id;
}

Result<std::optional<RequestId>> Client::cancel() {
  const auto id = drive_.cancel(now());
  if (!id || !*id) return id;
  if (const auto sent = flush(); !sent) {
    drive_.withdraw(**id);
    return tl::unexpected{sent.error()};
  }
  return id;
}

Result<void> Client::poll(Instant deadline) {
  if (!drive_.is_connected()) {
    if (auto opened = open(std::min(deadline, now() + kAttempt)); !opened) return opened;
  }
  // A client that waits for its turn must not lose its place by connecting anew.
  if (drive_.is_silent() && drive_.heartbeat()) {
    drop();
    return {};
  }
  do {
    receive(deadline);
  } while (events_.empty() && drive_.is_connected() && now() < deadline);
  return {};
}

std::vector<DriveEvent> Client::take_events() { return std::exchange(events_, {}); }

Result<void> Client::open(Instant deadline) {
  auto connected = port_.connect(deadline);
  if (connected) drive_.connect(now());
  return connected;
}

/// Waits for the next thing to happen, but not beyond `deadline`.
void Client::receive(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  const auto until = std::clamp(drive_.due().value_or(deadline), now(), std::max(now(), deadline));
  const auto received = port_.receive(buffer, until);
  if (!received || received->arrival == SessionPort::Arrival::kEnd ||
      received->arrival == SessionPort::Arrival::kReset) {
    drop();
  } else {
    const auto bytes = Bytes{buffer}.first(received->size);
    if (listener_ && !bytes.empty()) listener_(now(), bytes);
    drive_.receive(now(), bytes);
    drive_.tick(now());
    (void)flush();  // what cannot be sent ends the connection at the next look
  }
  collect();
}

Result<void> Client::flush() {
  const auto text = drive_.take_outgoing();
  if (text.empty()) return {};
  return port_.send(std::as_bytes(std::span{text}));
}

void Client::drop() {
  port_.close();
  drive_.disconnect(now());
  collect();
}

void Client::collect() {
  for (auto& event : drive_.take_events()) events_.push_back(event);
}

std::optional<Ending> Client::take_ending(RequestId request) {
  collect();
  const auto found = std::ranges::find_if(events_, [request](const DriveEvent& event) {
    return event.kind == DriveEvent::Kind::kEnded && event.request == request;
  });
  if (found == events_.end()) return std::nullopt;
  const auto ending = found->ending;
  events_.erase(found);
  return ending;
}

}  // namespace armjig::kinovazed::drive
