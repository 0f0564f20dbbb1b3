// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/guard.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <string_view>
#include <utility>

namespace armjig {
namespace {

constexpr std::string_view kUnsupervised =
    "the process that watches over the arm has stopped it, after half a second without a sign of "
    "life from here, or was ended itself; open the target again";

/// Whether a message that failed so may come through when it is sent again.
bool is_passing(const Error& error) noexcept {
  return error.code == ErrorCode::kBusy || error.code == ErrorCode::kRefused;
}

}  // namespace

void GuardState::give_sign_of_life() {
  for (auto* const guard : guards_) guard->report_life();
}

Result<void> GuardState::resume() {
  for (auto* const guard : guards_) {
    if (auto resumed = guard->resume(); !resumed) return resumed;
  }
  is_unsupervised = false;
  return {};
}

Guard::Guard(std::unique_ptr<Judge> judge, Permissions permissions,
             std::shared_ptr<GuardState> watch, Patience patience)
    : judge_{std::move(judge)},
      granted_{permissions},
      permissions_{permissions},
      watch_{std::move(watch)},
      patience_{patience} {
  assert(judge_ != nullptr && watch_ != nullptr);
  watch_->guards_.push_back(this);
}

Guard::~Guard() { std::erase(watch_->guards_, this); }

Result<void> Guard::begin(const std::optional<Lifeline>& line) {
  is_in_step_ = false;
  line_ = line;
  if (auto supervised = supervise(); !supervised) return supervised;
  return fall_into_step();
}

Result<void> Guard::supervise() {
  if (!line_ || !permissions_.allow_motion()) return {};
  auto started = Supervisor::start(*line_, judge_->stop());
  if (!started) return tl::unexpected{started.error()};
  supervisor_ = *std::move(started);
  report_life();
  return {};
}

Result<void> Guard::resume() {
  if (!std::exchange(is_unsupervised_, false)) return {};
  supervisor_.reset();  // it has ended, or will when it has stopped the device
  permissions_ = granted_;
  return supervise();
}

void Guard::end() {
  if (supervisor_) (void)supervisor_->tell(Supervisor::Motion::kNone);
  supervisor_.reset();
  line_.reset();
}

Result<void> Guard::admit(Messages messages) {
  if (auto taken = take_in(time()); !taken) return taken;
  watch_->give_sign_of_life();
  if (auto in_step = fall_into_step(); !in_step) return in_step;
  judge_->set_time(time());
  auto refusal = judge_->judge(messages, permissions_);
  report_change();  // before it moves
  if (!refusal) return {};
  if (is_unsupervised_ && !permissions_.allow(refusal->hazard)) {
    refusal = Refusal{refusal->hazard, std::string{kUnsupervised}, Refusal::Cause::kUnsupervised};
  }
  refuse(*std::move(refusal));
  return fail(ErrorCode::kForbidden);
}

Result<void> Guard::send_guarded(Bytes message) {
  if (auto admitted = admit({&message, 1}); !admitted) return admitted;
  return hand_over(message);
}

Result<void> Guard::take_in(Instant deadline) {
  const auto heard = listen(deadline);
  if (!heard && judge_->may_be_moving()) {
    refuse({Hazard::kMove, "the arm is out of sight", Refusal::Cause::kDevice,
            Refusal::Matter::kUnseen});
  }
  look();
  return heard;
}

void Guard::hear(Bytes bytes) {
  judge_->set_time(time());
  judge_->observe(bytes);
}

void Guard::look() {
  if (auto reason = judge_->must_stop()) {
    refuse({Hazard::kMove, *std::move(reason), Refusal::Cause::kDevice, judge_->matter_of_stop()});
  }
  report_change();
}

void Guard::refuse(Refusal refusal) {
  watch_->last_refusal = std::move(refusal);
  ++watch_->refusals;
  stop_if_moving();
}

void Guard::stop_if_moving() {
  if (judge_->may_be_moving()) stop();
  report_change();  // what we could not stop, the supervisor goes on stopping
}

Result<void> Guard::hand_over(Bytes message) {
  const auto handed_over = put(message);
  if (!handed_over) is_in_step_ = false;  // nobody knows how much of it has left
  return handed_over;
}

/// Makes sure that the judge reads what will be sent as the device does.
Result<void> Guard::fall_into_step() {
  if (is_in_step_) return {};
  is_in_step_ = !judge_->needs_opening();
  if (is_in_step_) return {};
  const auto opening = judge_->opening_bytes();
  [[maybe_unused]] const auto refusal = judge_->judge(opening, permissions_);
  assert(!refusal);
  auto written = hand_over(opening);
  is_in_step_ = written.has_value();
  return written;
}

Supervisor::Motion Guard::motion() const {
  return judge_->may_be_moving() ? Supervisor::Motion::kPossible : Supervisor::Motion::kNone;
}

/// Without its supervisor the device may not move any more.
void Guard::report_life() {
  if (!supervisor_ || is_unsupervised_) return;
  told_motion_ = motion();
  if (supervisor_->tell(told_motion_)) return;
  is_unsupervised_ = watch_->is_unsupervised = true;
  permissions_.withdraw_motion();
  refuse({Hazard::kMove, std::string{kUnsupervised}, Refusal::Cause::kUnsupervised});
}

/// When the judge may have changed its mind. If the supervisor is gone, the next sign of life will
/// find out.
void Guard::report_change() {
  if (!supervisor_ || is_unsupervised_) return;
  (void)supervisor_->tell_stop(judge_->stop());
  if (motion() != told_motion_ && supervisor_->tell(motion())) told_motion_ = motion();
}

/// Nothing can be reported from here, so errors of the port end it.
void Guard::stop() {
  for (int i = 0; i < patience_.stops; ++i) {
    std::vector<std::vector<std::byte>> messages;  // a copy, for judging changes the judge
    for (const auto message : judge_->stop()) messages.emplace_back(message.begin(), message.end());
    for (const auto& message : messages) {
      [[maybe_unused]] const auto refusal = judge_->judge(message, Permissions::all());
      assert(!refusal);
      if (const auto done = hand_over(message); !done && !is_passing(done.error())) return;
    }
    watch_->has_left_moving = false;
    if (!settle(time() + patience_.between) || !judge_->may_be_moving()) return;
  }
}

}  // namespace armjig
