// SPDX-License-Identifier: Apache-2.0
#include "cli/program_judge.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cstddef>
#include <map>

namespace armjig::cli {
namespace {

/// What is broken in every message need not be said a hundred times a second.
constexpr std::size_t kMostLines = 3;

}  // namespace

Outcome<std::unique_ptr<ProgramCheck>> make_program_check(const Device& device,
                                                          const LinkNoise& noise,
                                                          std::string_view name) {
  if (!device.program_check) {
    return problem(ErrorCode::kBadValue, "--check",
                   fmt::format("nothing is demanded of programs for {}", device.name));
  }
  auto lines = std::make_shared<std::map<std::string_view, std::size_t>>();
  return std::make_unique<ProgramCheck>(
      *device.program_check, noise,
      [lines, who = name.empty() ? "" : fmt::format("{}: ", name)](const Offence& offence) {
        if (++(*lines)[offence.requirement] > kMostLines) return;
        fmt::print(stderr, "armjig: {}{:.3f} s {}: {}\n", who, seconds(offence.time),
                   offence.requirement, offence.what);
      });
}

}  // namespace armjig::cli
