// SPDX-License-Identifier: Apache-2.0
// The document's experiment, docs/motion.md: joint 6 from 260 to 180 degrees in two seconds. A host
// that keeps its period and one that does not; speeds and positions, or speeds only.
#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cstdint>
#include <random>
#include <span>
#include <string>

#include "emulators/parol6/arm.hpp"
#include "harness/script/interpreter.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/script/programs.hpp"

namespace armjig::script {
namespace {

using namespace std::chrono_literals;

enum class Host { kIdeal, kJitters };

/// When the next frame leaves: each 10 ms, or between 8 and 12 ms after the one before.
class Period {
 public:
  explicit Period(Host host) : host_{host} {}

  Instant next() {
    constexpr std::uint32_t kSpread = 4000;
    const auto length = host_ == Host::kIdeal
                            ? std::chrono::microseconds{10'000}
                            : std::chrono::microseconds{8000 + random_() % (kSpread + 1)};
    return time_ += length;
  }

 private:
  Host host_;
  Instant time_{};
  std::minstd_rand random_{2026};
};

constexpr int kStart = 46222;
constexpr int kGoal = 32000;

/// Where joint 6 ends, in steps, behind one move from 260 to 180 degrees.
int end_of_joint6(std::string_view arguments, Host host) {
  const auto program =
      test::program_of(fmt::format("MoveJoint(0, 0, 0, 0, 0, 260, t=3)\nDelay(0.5)\n"
                                   "MoveJoint(0, 0, 0, 0, 0, 180, t=2, {})\nDelay(0.5)",
                                   arguments),
                       Dialect::kDocumented);
  Interpreter interpreter{program, {.planner = {.limits = parol6::planning::LimitCheck::kIgnored}}};
  parol6::emulation::Arm arm;
  Period period{host};
  parol6::JointSteps seen{};
  for (;;) {
    const auto now = period.next();
    arm.advance_to(now);
    for (const auto& sent : arm.sent()) {
      const std::span<const std::byte, parol6::kTelemetryFrameSize> frame{sent.bytes};
      seen = parol6::decode_telemetry(parol6::body_of(frame)).position;
    }
    arm.clear_sent();
    const auto frame = interpreter.next(seen);
    if (!frame || !*frame) return seen[5].value;
    arm.receive(now, parol6::encode(**frame));
    const auto* const move = interpreter.move();
    if (move != nullptr && move->sent == 1 && move->statement == 3) {
      EXPECT_EQ(seen[5].value, kStart);
    }
  }
}

TEST(Experiment, SpeedAndPositionEndsOnTheCommandedStep) {
  for (const auto* law : {"trap", "poly"}) {
    EXPECT_EQ(end_of_joint6(law, Host::kIdeal), kGoal) << law;
    EXPECT_EQ(end_of_joint6(law, Host::kJitters), kGoal) << law;
  }
}

TEST(Experiment, SpeedOnlyMisses) {
  // Steps beside the goal, of 177.8 in a degree. They are the emulated board's, to the step.
  EXPECT_EQ(end_of_joint6("trap, speed", Host::kIdeal) - kGoal, 628);
  EXPECT_EQ(end_of_joint6("poly, speed", Host::kIdeal) - kGoal, 493);
  EXPECT_EQ(end_of_joint6("trap, speed", Host::kJitters) - kGoal, 464);
  EXPECT_EQ(end_of_joint6("poly, speed", Host::kJitters) - kGoal, 307);
}

}  // namespace
}  // namespace armjig::script
