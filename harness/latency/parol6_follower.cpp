// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/parol6_follower.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "harness/wire/parol6/splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::parol6::latency {
namespace {

constexpr Duration kPatience = std::chrono::seconds{1};

class JointOne final : public Follower {
 public:
  explicit JointOne(Rig<StreamPort> rig) : rig_{std::move(rig)} {}

  std::string_view unit() const noexcept override { return "steps"; }
  double reach() const noexcept override { return 2'000; }
  Instant now() const override { return rig_.port().now(); }
  void wait_until(Instant time) override {
    while (now() < time && receive(time)) {
    }
  }

  Result<double> lead(double position, double speed) override {
    CommandFrame frame{.command = Command::kGoTo};
    frame.position[0] = Steps{static_cast<std::int32_t>(std::lround(position))};
    frame.speed[0] = StepsPerSecond{static_cast<std::int32_t>(std::lround(speed))};
    if (auto sent = rig_.port().write(encode(frame)); !sent) return tl::unexpected{sent.error()};
    position_.reset();
    const auto deadline = now() + kPatience;
    while (!position_) {
      if (auto received = receive(deadline); !received) return tl::unexpected{received.error()};
      if (!position_ && now() >= deadline) return fail(ErrorCode::kTimedOut);
    }
    return *position_;
  }

 private:
  Result<void> receive(Instant deadline) {
    std::array<std::byte, 256> buffer;
    const auto size = rig_.port().read(buffer, deadline);
    if (!size) return tl::unexpected{size.error()};
    for_each_step(splitter_, Bytes{buffer}.first(*size), [this](const Splitter::Step& step) {
      if (const auto frame = telemetry_of(step)) position_ = frame->position[0].value;
    });
    return {};
  }

  Rig<StreamPort> rig_;
  Splitter splitter_{kTelemetryPayloadSize};
  std::optional<double> position_;
};

}  // namespace

Outcome<std::unique_ptr<Follower>> make_follower(Rig<StreamPort> rig) {
  return std::make_unique<JointOne>(std::move(rig));
}

}  // namespace armjig::parol6::latency
