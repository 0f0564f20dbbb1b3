// SPDX-License-Identifier: Apache-2.0
#include "conformance/sessions.hpp"

#include <array>
#include <cstdint>

namespace armjig {
namespace {

/// Sessions may end the program of a device, so they come last.
template <std::uint64_t sessions>
constexpr Case beside_reference(std::string_view rule) noexcept {
  return {.rule = rule,
          .run = [](Bench& bench) { bench.expect_as_reference(sessions); },
          .hazard = Hazard::kCrash,
          .is_search = true};
}

}  // namespace

Chapter sessions_chapter(std::string_view id, std::string_view source) {
  const std::array<Clause, 3> clauses{
      must(id,
           "In sessions drawn at random the device says what the reference says, at the same "
           "moments.",
           source, Profiles::kFirmware),
      variant("few", beside_reference<100>("Nothing differs in 100 sessions.")),
      variant("many", full(beside_reference<500>("Nor in 500 others."))),
  };
  return chapter("Sessions", clauses);
}

}  // namespace armjig
