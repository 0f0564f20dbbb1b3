// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/support/devices.hpp"

/// The devices whose suites are tested.
namespace armjig::test {

/// What is tested of a device.
struct TestedSuite {
  Suite suite;
  MutantsEntry mutants;
  OpenBench open;

  [[nodiscard]] std::unique_ptr<Bench> bench(const std::string& target) const {
    return *open({.target = *parse_target(target)});
  }
};

inline TestedSuite suite_of(std::string_view name) {
  const auto& one = device(name);
  return {one.suite(), one.mutants(),
          [&one](const RigOptions& how) { return cli::open_bench(one, how); }};
}

inline TestedSuite demo_suite() { return suite_of("demo"); }
inline TestedSuite kinovazed_suite() { return suite_of("kinovazed"); }
inline TestedSuite morap_suite() { return suite_of("morap"); }
inline TestedSuite parol6_suite() { return suite_of("parol6"); }

inline std::vector<TestedSuite> all_suites() {
  return {demo_suite(), kinovazed_suite(), morap_suite(), parol6_suite()};
}

}  // namespace armjig::test
