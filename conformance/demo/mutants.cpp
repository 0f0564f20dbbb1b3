// SPDX-License-Identifier: Apache-2.0
#include "conformance/demo/mutants.hpp"

#include <array>

#include "harness/wire/demo/demo.hpp"

namespace armjig::demo {

std::vector<Mutant> all_mutants() {
  std::vector<Mutant> all;
  for (const auto& field : reply_fields()) {
    for (const auto* kind : {"zero:", "stuck:", "off-by-one:"}) {
      const bool is_start = field.name == "start" && std::string_view{kind} == "stuck:";
      all.push_back({std::string{kind}.append(field.name), "Replies",
                     is_start ? "it has only one value" : ""});
    }
  }
  return all;
}

std::span<const std::string_view> mutant_hints(std::string_view /*section*/) {
  static constexpr std::array<std::string_view, 1> kAll{"demo"};
  return kAll;
}

}  // namespace armjig::demo
