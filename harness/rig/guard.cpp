// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/guard.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "harness/rig/demo_judge.hpp"
#include "harness/rig/parol6_judge.hpp"

namespace armjig {
namespace {

constexpr std::array<std::string_view, kHazardCount> kHazards{"observe", "state", "move", "home",
                                                              "grip"};
constexpr std::array kJudges{
    JudgeEntry{"demo", demo::make_judge},
    JudgeEntry{"parol6", parol6::make_judge},
};
/// The stop leaves several times: a device in the middle of a broken message swallows the first.
constexpr int kStops = 8;
constexpr Duration kStopInterval = std::chrono::milliseconds{10};

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
                     "choose from state, move, home, grip with commas between them, or all");
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
  const bool may_move = permissions.allow(Hazard::kMove) || permissions.allow(Hazard::kHome);
  if (const auto descriptor = port->descriptor(); descriptor && may_move) {
    auto started = Supervisor::start(*descriptor, judge->stop_bytes());
    if (!started) return tl::unexpected{started.error()};
    supervisor = *std::move(started);
  }
  return std::unique_ptr<GuardedStream>{
      new GuardedStream{std::move(port), std::move(judge), permissions, std::move(supervisor)}};
}

GuardedStream::GuardedStream(std::unique_ptr<StreamPort> port, std::unique_ptr<Judge> judge,
                             Permissions permissions, std::optional<Supervisor> supervisor)
    : port_{std::move(port)},
      judge_{std::move(judge)},
      permissions_{permissions},
      supervisor_{std::move(supervisor)} {}

GuardedStream::~GuardedStream() {
  if (judge_->may_be_moving()) stop();
}

Result<void> GuardedStream::write(Bytes bytes) {
  refusal_ = judge_->judge(bytes, permissions_);
  if (!refusal_ && supervisor_ && !supervisor_->tell(judge_->may_be_moving())) {
    refusal_ = Refusal{Hazard::kMove, "the supervisor stopped the arm after a silence of ours"};
  }
  if (refusal_) return fail(ErrorCode::kForbidden);
  return port_->write(bytes);
}

Result<std::size_t> GuardedStream::read(std::span<std::byte> into, Instant deadline) {
  const auto size = port_->read(into, deadline);
  if (!size) return size;
  judge_->observe(into.first(*size));
  if (auto reason = judge_->must_stop()) {
    refusal_ = Refusal{Hazard::kMove, *std::move(reason)};
    if (auto stopped = port_->write(judge_->stop_bytes()); !stopped) {
      return tl::unexpected{stopped.error()};
    }
  }
  return size;
}

/// Nothing can be reported from here, so errors end it.
void GuardedStream::stop() {
  std::array<std::byte, 4096> ignored;
  for (int i = 0; i < kStops; ++i) {
    if (!port_->write(judge_->stop_bytes())) return;
    if (!port_->read(ignored, port_->now() + kStopInterval)) return;
  }
}

}  // namespace armjig
