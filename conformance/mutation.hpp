// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/suite.hpp"
#include "harness/core/error.hpp"
#include "harness/report/report.hpp"

namespace armjig {

/// A faulty device that a suite should find.
struct Mutant {
  std::string name;     ///< `fault` of an `emulated:` target
  std::string section;  ///< of the specification: where the fault is
  /// Why nobody can tell it from a sound device on the wire; empty: it should be found.
  std::string equivalent{};
};

/// The mutants of a device, and where to look for a section's requirements first.
struct MutantsEntry {
  std::string_view device;
  std::vector<Mutant> (*all)();
  /// Beginnings of the names of requirements that faults of that section break.
  std::span<const std::string_view> (*hints)(std::string_view section);
};

/// Devices that have mutants.
[[nodiscard]] std::span<const MutantsEntry> mutants() noexcept;

/// What became of one.
struct MutantFate {
  Mutant mutant;
  std::string killer{};  ///< the case that found it; empty: it survived
  std::string finding{};
};

struct MutationOptions {
  Profile profile = Profile::kFirmware;
  std::string filter{};  ///< a piece of the mutant's name; empty: all
  unsigned threads = 1;
  /// Whether a mutant is sought for each must-requirement that none of the first killers proved.
  bool proves_requirements = true;
};

/// A suite tried on its mutants.
struct MutationResult {
  std::vector<MutantFate> fates;             ///< in the order of `MutantsEntry::all`
  std::vector<std::string> broken_on_sound;  ///< cases that fail without any fault
  std::vector<const Requirement*> unproven;  ///< musts that no mutant breaks
};

/// Runs cases on each mutant until one finds it: those that the section hints at first, then what
/// found the mutants of the section before. The same result for the same suite, whatever the
/// number of threads. Problems: those of `Suite::open`.
[[nodiscard]] Outcome<MutationResult> run_mutants(const Suite& suite, const MutantsEntry& entry,
                                                  const MutationOptions& options);

/// A row for each mutant, and for each must-requirement without one; kill rates by section.
[[nodiscard]] Report to_report(const MutationResult& result, const Suite& suite,
                               const MutationOptions& options);

}  // namespace armjig
