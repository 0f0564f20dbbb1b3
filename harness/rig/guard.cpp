// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/guard.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "harness/rig/demo_judge.hpp"
#include "harness/rig/kinovazed_judge.hpp"
#include "harness/rig/parol6_judge.hpp"

namespace armjig {
namespace {

constexpr std::array<std::string_view, kHazardCount> kHazards{"observe", "state",   "move", "home",
                                                              "grip",    "program", "crash"};
constexpr std::array kJudges{
    JudgeEntry{"demo", demo::make_judge},
    JudgeEntry{"kinovazed", kinovazed::make_judge},
    JudgeEntry{"parol6", parol6::make_judge},
};
/// The stop leaves until the device shows that it heard it, but not more often than that.
constexpr int kStops = 8;
constexpr Duration kStopInterval = std::chrono::milliseconds{10};
/// What arrived while nobody read; then the oldest goes, as in the queue of a terminal.
constexpr std::size_t kMostUnread = std::size_t{64} * 1024;

constexpr std::string_view kUnsupervised =
    "the process that watches over the arm has stopped it, after half a second without a sign of "
    "life from here, or was ended itself; open the target again";

}  // namespace

std::string_view to_string(Hazard hazard) noexcept {
  return kHazards[static_cast<std::size_t>(hazard)];
}

Outcome<Permissions> parse_permissions(std::string_view text) {
  if (text == "all") return Permissions::all();
  Permissions permissions;
  auto rest = text;
  while (!rest.empty()) {
    const auto end = rest.find(',');
    const auto word = rest.substr(0, end);
    const auto found = std::ranges::find(kHazards, word);
    if (found == kHazards.end()) {
      return problem(ErrorCode::kBadValue, "--allow " + std::string{text},
                     "choose from state, move, home, grip, program, crash with commas between "
                     "them, or all");
    }
    permissions.add(static_cast<Hazard>(found - kHazards.begin()));
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
  }
  return permissions;
}

std::span<const JudgeEntry> judges() noexcept { return kJudges; }

Result<std::unique_ptr<GuardedStream>> GuardedStream::guard(std::unique_ptr<StreamPort> port,
                                                            std::unique_ptr<Judge> judge,
                                                            Permissions permissions) {
  std::optional<Supervisor> supervisor;
  if (const auto descriptor = port->descriptor(); descriptor && permissions.allow_motion()) {
    auto started = Supervisor::start(*descriptor, judge->stop_bytes());
    if (!started) return tl::unexpected{started.error()};
    supervisor = *std::move(started);
  }
  std::unique_ptr<GuardedStream> guarded{
      new GuardedStream{std::move(port), std::move(judge), permissions, std::move(supervisor)}};
  if (auto in_step = guarded->fall_into_step(); !in_step) return tl::unexpected{in_step.error()};
  return guarded;
}

GuardedStream::GuardedStream(std::unique_ptr<StreamPort> port, std::unique_ptr<Judge> judge,
                             Permissions permissions, std::optional<Supervisor> supervisor)
    : port_{std::move(port)},
      judge_{std::move(judge)},
      permissions_{permissions},
      supervisor_{std::move(supervisor)} {
  unread_.reserve(kMostUnread);
}

GuardedStream::~GuardedStream() {
  if (judge_->may_be_moving()) stop();
  report_motion();  // what we could not stop, the supervisor goes on stopping
}

Result<void> GuardedStream::write(Bytes bytes) {
  if (auto taken = take_in(now()); !taken) return taken;
  report_life(Supervisor::Motion::kPossible);
  if (auto in_step = fall_into_step(); !in_step) return in_step;
  if (auto refusal = judge_->judge(bytes, permissions_)) {
    if (is_unsupervised_ && !permissions_.allow(refusal->hazard)) refusal->reason = kUnsupervised;
    refusal_ = *std::move(refusal);
    if (judge_->may_be_moving()) stop();
    report_motion();
    return fail(ErrorCode::kForbidden);
  }
  const auto written = put(bytes);
  report_motion();
  return written;
}

Result<std::size_t> GuardedStream::read(std::span<std::byte> into, Instant deadline) {
  report_life(motion());
  if (unread_.empty()) {
    if (auto taken = take_in(deadline); !taken) return tl::unexpected{taken.error()};
    report_motion();
  }
  const auto size = std::min(into.size(), unread_.size());
  std::copy_n(unread_.begin(), size, into.begin());
  unread_.erase(unread_.begin(), unread_.begin() + static_cast<std::ptrdiff_t>(size));
  return size;
}

/// Waits for something to come, shows it to the judge and keeps it. Stops the arm if it has to be.
Result<void> GuardedStream::take_in(Instant deadline) {
  const auto received = receive(deadline);
  auto reason = judge_->must_stop();
  if (!received && judge_->may_be_moving()) reason = "the arm is out of sight";
  if (reason) {
    refusal_ = Refusal{Hazard::kMove, *std::move(reason)};
    stop();
  }
  return received;
}

Result<void> GuardedStream::receive(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  const auto size = port_->read(buffer, deadline);
  if (!size) return tl::unexpected{size.error()};
  const auto bytes = Bytes{buffer}.first(*size);
  judge_->observe(bytes);
  unread_.insert(unread_.end(), bytes.begin(), bytes.end());
  if (unread_.size() > kMostUnread) {
    const auto surplus = unread_.size() - kMostUnread;
    unread_.erase(unread_.begin(), unread_.begin() + static_cast<std::ptrdiff_t>(surplus));
  }
  return {};
}

Result<void> GuardedStream::put(Bytes bytes) {
  const auto written = port_->write(bytes);
  if (!written) is_in_step_ = false;  // nobody knows how much of it has left
  return written;
}

/// Makes sure that the judge reads what will be written as the device does.
Result<void> GuardedStream::fall_into_step() {
  if (is_in_step_) return {};
  const auto opening = judge_->opening_bytes();
  [[maybe_unused]] const auto refusal = judge_->judge(opening, permissions_);
  assert(!refusal);
  auto written = put(opening);
  is_in_step_ = written.has_value();
  return written;
}

Supervisor::Motion GuardedStream::motion() const {
  return judge_->may_be_moving() ? Supervisor::Motion::kPossible : Supervisor::Motion::kNone;
}

/// Before a write, which may move the arm, and a read, which does not. Without its supervisor the
/// arm may not move any more.
void GuardedStream::report_life(Supervisor::Motion motion) {
  if (!supervisor_ || is_unsupervised_) return;
  told_motion_ = motion;
  if (supervisor_->tell(told_motion_)) return;
  is_unsupervised_ = true;
  permissions_.withdraw_motion();
  refusal_ = Refusal{Hazard::kMove, std::string{kUnsupervised}};
  stop();
}

/// When the judge may have changed its mind.
void GuardedStream::report_motion() {
  if (!supervisor_ || is_unsupervised_) return;
  const auto stop = judge_->stop_bytes();
  if (!std::ranges::equal(stop, told_stop_) && supervisor_->tell_stop(stop)) {
    told_stop_.assign(stop.begin(), stop.end());
  }
  // If it is gone already, the next call will find out.
  if (motion() != told_motion_ && supervisor_->tell(motion())) told_motion_ = motion();
}

/// Nothing can be reported from here, so errors of the port end it.
void GuardedStream::stop() {
  for (int i = 0; i < kStops; ++i) {
    const auto view = judge_->stop_bytes();
    const std::vector<std::byte> bytes{view.begin(), view.end()};
    [[maybe_unused]] const auto refusal = judge_->judge(bytes, Permissions::all());
    assert(!refusal);
    if (!put(bytes) || !receive(now() + kStopInterval)) return;
    if (!judge_->may_be_moving()) return;
  }
}

}  // namespace armjig
