// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/session_guard.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace armjig {
namespace {

/// Until the server has taken the stop up: it may be busy with the arm, and must not be left with
/// its answer on the way.
constexpr Duration kStopTakes = std::chrono::milliseconds{500};
/// The supervisor wants a sign of life twice a second.
constexpr Duration kLongestWait = std::chrono::milliseconds{200};

}  // namespace

GuardedSession::GuardedSession(std::unique_ptr<SessionPort> port, std::unique_ptr<Judge> judge,
                               Permissions permissions)
    : port_{std::move(port)}, judge_{std::move(judge)}, permissions_{permissions} {}

GuardedSession::~GuardedSession() { close(); }

Result<void> GuardedSession::connect(Instant deadline) {
  if (auto connected = port_->connect(deadline); !connected) return connected;
  is_open_ = true;
  auto begun = watch_over();
  const auto opening = judge_->opening_bytes();
  if (begun && !opening.empty()) begun = send(opening);
  if (!begun) {
    end();
    port_->close();
  }
  return begun;
}

Result<void> GuardedSession::watch_over() {
  const auto descriptor = port_->descriptor();
  if (!descriptor || !permissions_.allow_motion()) return {};
  auto started = Supervisor::start(*descriptor, judge_->stop_bytes());
  if (!started) return tl::unexpected{started.error()};
  supervisor_ = *std::move(started);
  report();
  return {};
}

Result<void> GuardedSession::send(Bytes segment) {
  if (!is_open_) return fail(ErrorCode::kDisconnected);
  if (auto refusal = judge_->judge(segment, permissions_)) {
    refusal_ = *std::move(refusal);
    return fail(ErrorCode::kForbidden);
  }
  report();  // before it moves
  return port_->send(segment);
}

Result<SessionPort::Received> GuardedSession::receive(std::span<std::byte> into, Instant deadline) {
  for (;;) {
    report();
    const auto until = supervisor_ ? std::min(deadline, now() + kLongestWait) : deadline;
    const auto received = port_->receive(into, until);
    if (received && received->arrival == Arrival::kDeadline && until < deadline) continue;
    if (received) judge_->observe(into.first(received->size));
    report();
    return received;
  }
}

void GuardedSession::half_close() {
  stop_if_moving();
  port_->half_close();
}

void GuardedSession::close() {
  stop_if_moving();
  end();
  port_->close();
}

void GuardedSession::reset() {
  stop_if_moving();
  end();
  port_->reset();
}

/// The supervisor holds the socket, too, so it goes first. The stop was sent.
void GuardedSession::end() {
  is_open_ = false;
  if (supervisor_) (void)supervisor_->tell(Supervisor::Motion::kNone);
  supervisor_.reset();
}

/// Also the sign of life. Without its supervisor the arm may not move any more.
void GuardedSession::report() {
  if (!supervisor_) return;
  const bool is_told = supervisor_->tell(judge_->may_be_moving() ? Supervisor::Motion::kPossible
                                                                 : Supervisor::Motion::kNone);
  if (is_told) return;
  supervisor_.reset();
  permissions_.withdraw_motion();
  refusal_ = Refusal{Hazard::kMove, "the process that watches over the arm is gone; start again"};
  stop();
}

void GuardedSession::stop_if_moving() {
  if (is_open_ && judge_->may_be_moving()) stop();
}

/// Nothing can be reported from here, so errors of the port end it.
void GuardedSession::stop() {
  const auto bytes = judge_->stop_bytes();
  (void)judge_->judge(bytes, Permissions::all());
  if (!port_->send(bytes)) return;
  const auto deadline = now() + kStopTakes;
  std::array<std::byte, 4096> buffer;
  while (now() < deadline) {
    if (supervisor_) (void)supervisor_->tell(Supervisor::Motion::kPossible);
    const auto received = port_->receive(buffer, std::min(deadline, now() + kLongestWait));
    if (!received || received->arrival == Arrival::kEnd || received->arrival == Arrival::kReset) {
      return;
    }
    judge_->observe(Bytes{buffer}.first(received->size));
  }
}

}  // namespace armjig
