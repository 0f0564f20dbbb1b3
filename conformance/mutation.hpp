// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "conformance/suite.hpp"
#include "emulators/faults/named_fault.hpp"
#include "harness/core/error.hpp"
#include "harness/report/report.hpp"
#include "harness/rig/rig.hpp"

namespace armjig {

/// A faulty device that a suite should find.
struct Mutant {
  std::string name;     ///< `fault` of an `emulated:` target
  std::string section;  ///< of the specification: where the fault is
  /// Why nobody can tell it from a sound device on the wire; empty: it should be found.
  std::string equivalent{};
};

/// A fault that is none on the wire. What is so for the shipped device is so for one that keeps to
/// its document as well, until it is found there.
struct EquivalentFault {
  std::string_view name;
  std::string_view reason;
  Profile profile = Profile::kFirmware;
};

/// Which requirements the faults of a section break most likely.
struct SectionHints {
  std::string_view section;
  std::array<std::string_view, 4> requirements;  ///< beginnings of names; the rest is empty
};

/// What is known about the faults of a device.
struct MutantsEntry {
  std::string_view device;
  std::vector<NamedFault> (*faults)();
  std::span<const EquivalentFault> equivalents;
  std::span<const SectionHints> hints;  ///< for the speed alone
  /// Options of the emulated device that has all that the suite is about: `pen=yes`; may be empty.
  std::string_view equipment{};
};

/// One for each fault, in the order of the device's list.
[[nodiscard]] std::vector<Mutant> mutants_of(const MutantsEntry& entry, Profile profile);

/// What became of one.
struct MutantFate {
  Mutant mutant;
  std::string killer{};  ///< the case that found it; empty: it survived
  std::string finding{};
  bool was_tried = true;  ///< to the end; no: the run was stopped
};

/// Opens a target of a suite.
using OpenBench = std::function<Outcome<std::unique_ptr<Bench>>(const RigOptions& how)>;

struct MutationOptions {
  Profile profile = Profile::kFirmware;
  std::string filter{};  ///< a piece of the mutant's name; empty: all
  unsigned threads = 1;
  /// Whether a mutant is sought for each must-requirement that none of the first killers proved.
  bool proves_requirements = true;
  /// Asked before each case, from several threads: mutants from then on are not tried, and nothing
  /// is said of requirements.
  MustStop must_stop = [] { return false; };
};

/// A suite tried on its mutants.
struct MutationResult {
  std::vector<MutantFate> fates;             ///< in the order of `mutants_of`
  std::vector<std::string> broken_on_sound;  ///< cases that fail without any fault
  std::vector<const Requirement*> unproven;  ///< musts that no mutant breaks
  std::string_view equipment{};              ///< that of its entry
};

/// Runs cases on each mutant until one finds it: those that the section hints at first, then what
/// found the mutants of the section before, and at last in the order of a run. A survivor under the
/// document is excused if it breaks only what shipped devices are held to. The same result for the
/// same suite, whatever the number of threads. Problems: those of `open`, which makes a bench of
/// its own on an emulated target and is called from several threads.
[[nodiscard]] Outcome<MutationResult> run_mutants(const Suite& suite, const MutantsEntry& entry,
                                                  const OpenBench& open,
                                                  const MutationOptions& options);

/// A row for each mutant, and for each must-requirement without one; kill rates by section.
[[nodiscard]] Report to_report(const MutationResult& result, const Suite& suite,
                               const MutationOptions& options);

}  // namespace armjig
