// SPDX-License-Identifier: Apache-2.0
// A conformance suite inside somebody else's program.
#include <cstdio>

#include <utility>

#include "conformance/parol6/suite.hpp"
#include "conformance/run.hpp"
#include "emulators/memory/in_memory.hpp"
#include "emulators/parol6/arm.hpp"

int main() {
  namespace parol6 = armjig::parol6;
  auto arm = armjig::make_hosted(parol6::emulation::Arm{});
  armjig::Rig<armjig::StreamPort> rig{armjig::open_in_memory(std::move(arm))};
  const armjig::RigOptions how{.target = {.text = "emulated:", .scheme = "emulated"}};
  const auto bench = parol6::conformance::make_bench(std::move(rig), how);
  if (!bench) {
    std::printf("%s\n", describe(bench.error()).c_str());
    return 1;
  }
  int failed = 0;
  const armjig::RunOptions options{.selection = {.tier = armjig::Tier::kQuick},
                                   .permissions = armjig::Permissions::all()};
  const auto report = armjig::run_suite(parol6::conformance::suite(), **bench, options,
                                        [&](const armjig::ReportRow& row) {
                                          if (row.verdict == armjig::Verdict::kFail) ++failed;
                                        });
  std::printf("%zu cases, %d failed\n", report.rows.size(), failed);
  return report.rows.empty() || failed > 0 ? 1 : 0;
}
