// SPDX-License-Identifier: Apache-2.0
// What a bench says of nodes that must not pass for sound ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "conformance/morap/cases.hpp"
#include "conformance/morap/node_bench.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig::morap::conformance {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A node that is judged like a real one, its shaft free.
std::unique_ptr<NodeBench> free_node(std::string_view target) {
  auto node = std::make_unique<NodeBench>(test::emulated<cli::OnBus>("morap", target),
                                          NodeBench::Subject{.is_real = true});
  node->begin(Profile::kFirmware, 1);
  EXPECT_TRUE(node->is_alive());
  node->touch("shaft", 1);
  return node;
}

TEST(NodeVerdicts, AShaftThatALoadTurnsIsNotHeldAgainstItsNode) {
  const auto node = free_node("emulated:?load=1");
  const auto begin = node->now();
  node->bring_to(kFree);
  EXPECT_EQ(node->judgement().verdict, Verdict::kSkipped);
  EXPECT_THAT(node->judgement().actual, HasSubstr("turns for more than 5 s"));
  EXPECT_LT(node->now() - begin, 6s);
}

TEST(NodeVerdicts, AShaftThatIsDrivenOnSaysSoAfterFiveSeconds) {
  const auto node = free_node("emulated:?fault=row:enabled.calibration_unknown.ignored");
  node->bring_to(kFree);
  node->send(CommandId::kVoltage, 3.0F);
  node->pause(1s);
  const auto begin = node->now();
  node->bring_to(kFree);
  EXPECT_EQ(node->judgement().verdict, Verdict::kFail);
  EXPECT_THAT(node->judgement().expected, HasSubstr("comes to rest within 5 s"));
  EXPECT_THAT(node->judgement().actual, HasSubstr("goes on"));
  EXPECT_LT(node->now() - begin, 6s);
}

TEST(NodeVerdicts, AShaftThatCoastsForLongIsBraked) {
  const auto node = free_node("emulated:?viscous=0.01");
  node->bring_to(kFree);
  node->send(CommandId::kVoltage, 3.0F);
  node->pause(1s);
  node->bring_to(kFree);
  EXPECT_EQ(node->judgement().verdict, Verdict::kPass) << node->judgement().actual;
}

TEST(NodeVerdicts, AShaftThatWasDrivenIsWaitedFor) {
  const auto node = free_node("emulated:");
  node->bring_to(kFree);
  node->send(CommandId::kVoltage, 3.0F);
  node->pause(1s);
  node->bring_to(kFree);
  EXPECT_EQ(node->judgement().verdict, Verdict::kPass) << node->judgement().actual;
}

/// What a slow loop comes to if this machine stands still for so long before it looks.
Verdict verdict_after(Duration stop) {
  const auto node = free_node("emulated:");
  node->bring_to(kSlow);
  run_slow_loop(*node);
  node->send(CommandId::kPosition, 0.375F);
  node->tick();
  node->pause(stop);
  node->expect_levels(16);
  return node->judgement().verdict;
}

TEST(NodeVerdicts, WhoMissesTheMiddleBetweenTwoTicksLeavesTheCaseOpen) {
  EXPECT_EQ(verdict_after(0ms), Verdict::kPass);
  EXPECT_EQ(verdict_after(60ms), Verdict::kPass);
  for (const auto stop : {70ms, 90ms, 120ms, 300ms}) {
    EXPECT_EQ(verdict_after(stop), Verdict::kInconclusive) << stop.count() << " ms";
  }
}

TEST(NodeVerdicts, TicksOfANodeThatIdlesAreNotMetOnALink) {
  const auto node = free_node("emulated:");
  node->bring_to(kFree);
  node->tick();
  EXPECT_EQ(node->judgement().verdict, Verdict::kSkipped);
}

}  // namespace
}  // namespace armjig::morap::conformance
