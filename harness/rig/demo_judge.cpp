// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/demo_judge.hpp"

#include <algorithm>
#include <array>

#include "harness/wire/demo/demo.hpp"

namespace armjig::demo::rig {
namespace {

/// A request that has begun is damaged by these and dropped.
constexpr std::array<std::byte, kMessageSize - 1> kFlush{};

class DemoJudge final : public OneStopJudge {
 public:
  DemoJudge() {
    stop_by(stop_);
    std::ranges::copy(kFlush, stop_.begin());
    std::ranges::copy(encode(Operation::kHalt), stop_.begin() + kFlush.size());
  }

  [[nodiscard]] Bytes opening_bytes() const override { return kFlush; }

  std::optional<Refusal> judge(Messages messages, const Permissions& permissions) override {
    auto splitter = splitter_;
    auto is_running = is_running_;
    for (const auto byte : messages.front()) {
      const auto operation = splitter.step(byte);
      if (operation == static_cast<std::byte>(Operation::kStart)) {
        if (auto refusal = demand(Hazard::kMove, permissions, "start")) return refusal;
        is_running = true;
      } else if (operation == static_cast<std::byte>(Operation::kHalt)) {
        is_running = false;
      }
    }
    splitter_ = splitter;
    is_running_ = is_running;
    return std::nullopt;
  }

  void observe(Bytes /*bytes*/) override {}
  [[nodiscard]] bool may_be_moving() const override { return is_running_; }

 private:
  Splitter splitter_{kRequestStart};
  bool is_running_ = false;
  std::array<std::byte, kFlush.size() + kMessageSize> stop_{};
};

}  // namespace

std::unique_ptr<Judge> make_judge() { return std::make_unique<DemoJudge>(); }

}  // namespace armjig::demo::rig
