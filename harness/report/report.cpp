// SPDX-License-Identifier: Apache-2.0
#include "harness/report/report.hpp"

#include <memory>

#include "harness/report/output_file.hpp"

namespace armjig {
namespace {

constexpr std::array kForms{
    ReportForm{"json", "JSON", to_json}, ReportForm{"html", "a page", to_html},
    ReportForm{"junit", "JUnit XML", to_junit}, ReportForm{"sarif", "SARIF", to_sarif}};

}  // namespace

std::string_view to_string(Verdict verdict) noexcept {
  constexpr std::array<std::string_view, kVerdictCount> kNames{
      "pass", "deviation", "fail", "flaky", "skipped", "inconclusive", "error"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::string_view to_string(Level level) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"must", "should", "may"};
  return kNames[static_cast<std::size_t>(level)];
}

std::array<std::size_t, kVerdictCount> Report::counts() const noexcept {
  std::array<std::size_t, kVerdictCount> counts{};
  for (const auto& row : rows) ++counts[static_cast<std::size_t>(row.verdict)];
  return counts;
}

std::size_t Report::count(Verdict verdict) const noexcept {
  return counts()[static_cast<std::size_t>(verdict)];
}

Conclusion conclusion_of(const Report& report) noexcept {
  const auto any = [&report](Verdict verdict) { return report.count(verdict) > 0; };
  if (any(Verdict::kFail) || any(Verdict::kFlaky)) return Conclusion::kFindings;
  if (any(Verdict::kError)) return Conclusion::kRig;
  if (any(Verdict::kPass) || any(Verdict::kDeviation)) return Conclusion::kPassed;
  return any(Verdict::kInconclusive) ? Conclusion::kRig : Conclusion::kNothing;
}

std::string_view to_string(Conclusion conclusion) noexcept {
  switch (conclusion) {
    case Conclusion::kPassed:
      return "passed";
    case Conclusion::kFindings:
      return "findings";
    case Conclusion::kRig:
      return "rig";
    case Conclusion::kNothing:
      break;
  }
  return "nothing";
}

Outcome<void> write_files(const Report& report, const ReportFiles& files) {
  for (const auto& form : kForms) {
    const auto file = files.find(form.name);
    if (file == files.end() || file->second.empty()) continue;
    auto written =
        OutputFile::open(file->second).and_then([&](const std::shared_ptr<OutputFile>& opened) {
          return opened->put(form.text_of(report));
        });
    if (!written) return written;
  }
  return {};
}

std::span<const ReportForm> report_forms() noexcept { return kForms; }

}  // namespace armjig
