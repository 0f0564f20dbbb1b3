// SPDX-License-Identifier: Apache-2.0
// A conformance suite inside somebody else's program.
#include <algorithm>
#include <cstdio>

#include "conformance/run.hpp"
#include "conformance/suite.hpp"
#include "harness/rig/target.hpp"

int main() {
  const auto& suite = *std::ranges::find(armjig::suites(), "parol6", &armjig::Suite::device);
  const auto target = armjig::parse_target("emulated:");
  const auto bench = target.and_then([&](const auto& t) { return suite.open({.target = t}); });
  if (!bench) {
    std::printf("%s\n", describe(bench.error()).c_str());
    return 1;
  }
  int failed = 0;
  const armjig::RunOptions options{.selection = {.tier = armjig::Tier::kQuick},
                                   .permissions = armjig::Permissions::all()};
  const auto report = armjig::run_suite(suite, **bench, options, [&](const armjig::ReportRow& row) {
    if (row.verdict == armjig::Verdict::kFail) ++failed;
  });
  std::printf("%zu cases, %d failed\n", report.rows.size(), failed);
  return report.rows.empty() || failed > 0 ? 1 : 0;
}
