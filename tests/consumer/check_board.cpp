// SPDX-License-Identifier: Apache-2.0
// A conformance suite inside somebody else's program.
#include <algorithm>
#include <cstdio>

#include "conformance/suite.hpp"
#include "emulators/host/devices.hpp"
#include "harness/rig/target.hpp"

int main() {
  const auto& suite = *std::ranges::find(armjig::suites(), "parol6", &armjig::Suite::device);
  const auto target = armjig::parse_target("emulated:");
  const auto port =
      target.and_then([&](const auto& t) { return armjig::hosted_device(suite.device).open(t); });
  if (!port) {
    std::printf("%s\n", describe(port.error()).c_str());
    return 1;
  }
  int failed = 0;
  const auto report =
      armjig::run_suite(suite, **port, *target, {}, [&](const armjig::ReportRow& row) {
        if (row.verdict != armjig::Verdict::kPass) ++failed;
      });
  std::printf("%zu cases, %d failed\n", report.rows.size(), failed);
  return report.rows.empty() || failed > 0 ? 1 : 0;
}
