// SPDX-License-Identifier: Apache-2.0
#include "suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/run.hpp"
#include "device.hpp"

namespace gripper {
namespace {

using namespace armjig;

class EachSpeed : public testing::TestWithParam<const cli::Device*> {
 protected:
  static Outcome<std::unique_ptr<Bench>> open(const RigOptions& how) {
    return cli::open_bench(*GetParam(), how);
  }
};

std::vector<const cli::Device*> all() {
  std::vector<const cli::Device*> pointers;
  for (const auto& device : devices()) pointers.push_back(&device);
  return pointers;
}
INSTANTIATE_TEST_SUITE_P(Gripper, EachSpeed, testing::ValuesIn(all()));

TEST_P(EachSpeed, IsACompleteEntry) {
  EXPECT_THAT(cli::missing_parts(*GetParam()), testing::IsEmpty());
}

TEST_P(EachSpeed, PassesItsSuite) {
  const auto bench = open({.target = parse_target("emulated:").value()});
  ASSERT_TRUE(bench) << describe(bench.error());
  const auto report = run_suite(
      suite(), **bench, {.permissions = Permissions::all()},
      [](const ReportRow& row) { EXPECT_EQ(row.verdict, Verdict::kPass) << to_text(row); });
  EXPECT_EQ(report.count(Verdict::kPass), report.rows.size());
}

TEST_P(EachSpeed, IsFoundWithEachFaultThatIsOne) {
  const auto result = run_mutants(suite(), mutants(), open, {});
  ASSERT_TRUE(result) << describe(result.error());
  for (const auto& fate : result->fates) {
    EXPECT_NE(fate.killer.empty(), fate.mutant.equivalent.empty()) << fate.mutant.name;
  }
  EXPECT_THAT(result->broken_on_sound, testing::IsEmpty());
  for (const auto* unproven : result->unproven) ADD_FAILURE() << unproven->id;
}

}  // namespace
}  // namespace gripper
