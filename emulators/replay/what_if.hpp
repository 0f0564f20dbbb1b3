// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "emulators/replay/perturbed.hpp"
#include "harness/core/error.hpp"
#include "harness/core/overhearer.hpp"

/// What a link could do to a talk so that it goes wrong: single pieces lost, doubled, late or
/// swapped, first one, then two, until a rule is broken that was not broken before.
namespace armjig {

/// A rule that was broken.
struct Breakage {
  Instant time{};
  std::string rule;  ///< the id of a requirement, or `device`, `program`, `apart`
  std::string what;  ///< one sentence
};

/// Judges what passes in one trial.
class TrialJudge : public Overhearer {
 public:
  /// Nothing more will pass. What was broken, in order of time.
  [[nodiscard]] virtual std::vector<Breakage> finish() = 0;
};
using MakeTrialJudge = std::function<std::unique_ptr<TrialJudge>()>;

/// What the device said: bytes that left together, on a connection or from an address.
struct SaidPiece {
  Instant time{};
  std::uint32_t lane{};
  std::vector<std::byte> bytes;
};

/// A talk, perturbed or not.
struct TrialResult {
  std::vector<PassedPiece> passed;  ///< of which a perturbation can be made
  std::vector<SaidPiece> said;      ///< the whole of it, or from a little before it was perturbed
  std::vector<Breakage> broken;
};

/// Has the talk with these perturbations. From any thread, many at once, if the search is told to
/// do so.
using Trial = std::function<Outcome<TrialResult>(const std::vector<Perturbation>& wanted)>;

/// For how long a device says something else than without the perturbation.
struct Apart {
  Instant from{};
  Instant to{};
  bool is_to_the_end = false;       ///< still when the recording ends
  std::vector<std::string> fields;  ///< of the first that differ, `NAME: WITHOUT, WITH`
};

/// Compares what was said last at each time; none: it is always the same.
[[nodiscard]] std::optional<Apart> apart(const std::vector<SaidPiece>& without,
                                         const std::vector<SaidPiece>& with,
                                         MakeDissector make_dissector);

struct WhatIfHow {
  /// How long what is late is held back.
  Duration delay = std::chrono::milliseconds{100};
  std::size_t most = 2;   ///< perturbations together, 1 or 2
  std::size_t reach = 8;  ///< the second of two is among so many pieces after the first
  /// What is found has to be found so many times more; for talks that are not always the same.
  int confirmations = 0;
  std::set<std::string, std::less<>> ignored;  ///< rules that may be broken
  /// Asked before each trial.
  std::function<bool()> must_stop = [] { return false; };
  /// Calls the second with 0 to `count - 1`, on any threads.
  std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)> for_each =
      [](std::size_t count, const std::function<void(std::size_t)>& work) {
        for (std::size_t i = 0; i < count; ++i) work(i);
      };
};

struct WhatIfAnswer {
  struct Found {
    std::vector<Perturbation> perturbations;
    std::vector<Instant> times;  ///< of their pieces when nothing is perturbed
    Breakage broken;             ///< the first rule
    TrialResult after;
  };
  TrialResult undisturbed;
  std::optional<Found> found;  ///< the shortest; of those losses first, and the earliest
  std::size_t tried{};
  bool is_complete = true;  ///< false: it was stopped before all was tried
};

/// Rules that are broken without any perturbation do not count. Problems: those of a trial.
[[nodiscard]] Outcome<WhatIfAnswer> what_if(const Trial& trial, const WhatIfHow& how);

/// `one lost 'command' of the host at 12.400 s`, two with `and` between.
[[nodiscard]] std::string describe(const WhatIfAnswer::Found& found);

}  // namespace armjig
