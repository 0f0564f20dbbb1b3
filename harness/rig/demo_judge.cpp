// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/demo_judge.hpp"

#include "harness/wire/demo/demo.hpp"

namespace armjig::demo {
namespace {

class DemoJudge final : public Judge {
 public:
  std::optional<Refusal> judge(Bytes bytes, const Permissions& permissions) override {
    auto splitter = splitter_;
    auto is_running = is_running_;
    for (const auto byte : bytes) {
      const auto operation = splitter.step(byte);
      if (operation == static_cast<std::byte>(Operation::kStart)) {
        if (!permissions.allow(Hazard::kMove)) {
          return Refusal{Hazard::kMove, "start needs --allow move"};
        }
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
  std::optional<std::string> must_stop() override { return std::nullopt; }
  [[nodiscard]] bool may_be_moving() const override { return is_running_; }
  [[nodiscard]] std::vector<std::byte> stop_bytes() const override {
    const auto halt = encode(Operation::kHalt);
    return {halt.begin(), halt.end()};
  }

 private:
  Splitter splitter_{kRequestStart};
  bool is_running_ = false;
};

}  // namespace

std::unique_ptr<Judge> make_judge() { return std::make_unique<DemoJudge>(); }

}  // namespace armjig::demo
