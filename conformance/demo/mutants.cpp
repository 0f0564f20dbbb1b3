// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/demo/suite.hpp"
#include "harness/wire/demo/demo.hpp"

namespace armjig::demo::conformance {
namespace {

constexpr std::array kEquivalents{EquivalentFault{"stuck:start", "it has only one value"}};
constexpr std::array kHints{SectionHints{"Replies", {"demo"}}};

std::vector<NamedFault> all_faults() {
  std::vector<NamedFault> all;
  for (const auto& field : reply_fields()) {
    for (const auto* kind : {"zero:", "stuck:", "off-by-one:"}) {
      all.push_back({std::string{kind}.append(field.name), "Replies"});
    }
  }
  return all;
}

}  // namespace

MutantsEntry mutants_entry() noexcept { return {"demo", all_faults, kEquivalents, kHints}; }

}  // namespace armjig::demo::conformance
