// SPDX-License-Identifier: Apache-2.0
// What a bench says of nodes that must not pass for sound ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

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

}  // namespace
}  // namespace armjig::morap::conformance
