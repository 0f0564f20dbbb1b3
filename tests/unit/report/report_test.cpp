// SPDX-License-Identifier: Apache-2.0
#include "harness/report/report.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>

#include "tests/unit/report/sample_report.hpp"

namespace armjig {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

Report report_of(std::initializer_list<Verdict> verdicts) {
  Report report;
  for (const auto verdict : verdicts) report.rows.emplace_back().verdict = verdict;
  return report;
}

TEST(Report, CountsEachVerdict) {
  EXPECT_THAT(test::one_of_each().counts(), Each(1));
  const auto report = report_of({Verdict::kFail, Verdict::kPass, Verdict::kFail});
  EXPECT_EQ(report.count(Verdict::kFail), 2);
  EXPECT_EQ(report.count(Verdict::kFlaky), 0);
}

TEST(Report, SaysPassedAndFailedEvenIfThereAreNone) {
  EXPECT_EQ(counts_line(Report{}), "0 passed, 0 failed");
  EXPECT_EQ(counts_line(report_of({Verdict::kError, Verdict::kError})),
            "0 passed, 0 failed, 2 errors");
  EXPECT_EQ(counts_line(test::one_of_each()),
            "1 passed, 1 failed, 1 flaky, 1 deviated, 1 skipped, 1 inconclusive, 1 error");
}

TEST(Report, ConcludesFindingsWhateverElseThereIs) {
  EXPECT_EQ(conclusion_of(test::one_of_each()), Conclusion::kFindings);
  EXPECT_EQ(conclusion_of(report_of({Verdict::kError, Verdict::kFail})), Conclusion::kFindings);
  EXPECT_EQ(conclusion_of(report_of({Verdict::kPass, Verdict::kFlaky})), Conclusion::kFindings);
}

TEST(Report, ConcludesTheRigFromErrorsOrFromNothingButInconclusive) {
  EXPECT_EQ(conclusion_of(report_of({Verdict::kPass, Verdict::kError})), Conclusion::kRig);
  EXPECT_EQ(conclusion_of(report_of({Verdict::kInconclusive, Verdict::kSkipped})),
            Conclusion::kRig);
}

TEST(Report, ConcludesPassedIfSomethingRanAndNothingWasFound) {
  EXPECT_EQ(conclusion_of(report_of({Verdict::kPass, Verdict::kSkipped, Verdict::kInconclusive})),
            Conclusion::kPassed);
  EXPECT_EQ(conclusion_of(report_of({Verdict::kDeviation})), Conclusion::kPassed);
}

TEST(Report, ConcludesNothingIfNothingRan) {
  EXPECT_EQ(conclusion_of(Report{}), Conclusion::kNothing);
  EXPECT_EQ(conclusion_of(report_of({Verdict::kSkipped})), Conclusion::kNothing);
}

TEST(Report, HasTheDocumentedExitCodes) {
  EXPECT_EQ(static_cast<int>(Conclusion::kPassed), 0);
  EXPECT_EQ(static_cast<int>(Conclusion::kFindings), 1);
  EXPECT_EQ(static_cast<int>(Conclusion::kRig), 3);
  EXPECT_EQ(static_cast<int>(Conclusion::kNothing), 4);
}

class ReportFilesTest : public ::testing::Test {
 protected:
  ReportFilesTest() { std::filesystem::create_directory(folder_); }
  ~ReportFilesTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const char* name) const { return folder_ / name; }

  static std::string content(const std::string& path) {
    std::ifstream in{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
  }

  std::filesystem::path folder_ =
      std::filesystem::path{::testing::TempDir()} /
      ("armjig-" + std::string{::testing::UnitTest::GetInstance()->current_test_info()->name()});
};

TEST_F(ReportFilesTest, HaveTheFormThatWasAskedFor) {
  const auto report = test::one_of_each();
  ReportFiles files;
  for (const auto& form : report_forms())
    files[std::string{form.name}] = path(std::string{form.name}.c_str());
  ASSERT_TRUE(write_files(report, files));
  EXPECT_EQ(content(path("json")), to_json(report));
  EXPECT_EQ(content(path("html")), to_html(report));
  EXPECT_EQ(content(path("junit")), to_junit(report));
  EXPECT_EQ(content(path("sarif")), to_sarif(report));
}

TEST_F(ReportFilesTest, AreNotWrittenWithoutAPath) {
  ASSERT_TRUE(write_files(test::one_of_each(), {}));
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(ReportFilesTest, AreNamedIfTheyCannotBeWritten) {
  const auto written = write_files(test::one_of_each(), {{"junit", path("no/such/folder.xml")}});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kCannotWrite);
  EXPECT_THAT(written.error().where, HasSubstr("no/such/folder.xml"));
}

}  // namespace
}  // namespace armjig
