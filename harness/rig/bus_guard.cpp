// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/bus_guard.hpp"

#include <array>
#include <cassert>
#include <tuple>
#include <utility>

#include "harness/rig/morap_judge.hpp"

namespace armjig {
namespace {

constexpr std::array kBusJudges{
    BusJudgeEntry{"morap", morap::make_judge},
};

}  // namespace

std::span<const BusJudgeEntry> bus_judges() noexcept { return kBusJudges; }

GuardedBus::GuardedBus(std::unique_ptr<BusPort> port, std::unique_ptr<BusJudge> judge,
                       Permissions permissions)
    : port_{std::move(port)}, judge_{std::move(judge)}, permissions_{permissions} {
  assert(port_ != nullptr && judge_ != nullptr);
}

GuardedBus::~GuardedBus() { stop_all(); }

Result<Transfer> GuardedBus::transfer(std::span<const BusMessage> messages) {
  for (const auto& message : messages) {
    auto refusal = judge_->judge(message, permissions_);
    if (!refusal) continue;
    refusal_ = std::move(refusal);
    stop_all();
    return fail(ErrorCode::kForbidden);
  }
  return port_->transfer(messages);
}

/// Whatever comes of it: nothing more can be done.
void GuardedBus::stop_all() {
  for (const auto address : judge_->moving()) {
    const auto stop = write_to(address, judge_->stop_bytes());
    std::ignore = judge_->judge(stop, permissions_);
    std::ignore = port_->transfer({&stop, 1});
  }
}

}  // namespace armjig
