// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "emulators/campaign/material.hpp"

namespace armjig::campaign {

/// After that time what moves is under way.
inline constexpr Duration kSpeedUp = std::chrono::milliseconds{60};
/// What is said for so long is not taken for what is said before and after, as far as rules let
/// messages come early or late.
inline constexpr Duration kWatched = std::chrono::milliseconds{220};

/// What a sound device says to scripts (`Material::rehearse`), whatever came before them. Where
/// nobody can say, nothing is said.
class Rehearsal {
 public:
  /// What is said after each of the pasts.
  using Said = std::vector<std::string>;

  /// `material` outlives this.
  explicit Rehearsal(const Material& material) : material_{material}, pasts_(1) {}

  [[nodiscard]] bool is_possible() const { return static_cast<bool>(material_.rehearse); }

  /// From now on all is played twice: after these, and after the same in another order. A device
  /// that a survey is on has had all kinds of messages before.
  void begin_after(const std::vector<Script>& samples);

  /// The bytes of the answers to the questions, half a second after `before` led somewhere and
  /// `exchange` was sent there.
  [[nodiscard]] Said said_after(const Script& before, const Script& exchange,
                                const Script& questions) const;

  /// Whether something that is said goes on changing after the script, more than `Material::rules`
  /// let pass, whatever came before; the question is asked again and again. Not after a script that
  /// is not permitted.
  [[nodiscard]] bool goes_on_after(const Script& script, const Script& question) const;

  /// The name of the last message that is said to the script alone.
  [[nodiscard]] std::string last_said(const Script& script) const;

 private:
  [[nodiscard]] std::vector<KeptRecord> heard(const Script& script) const;
  [[nodiscard]] bool goes_on(const Script& past, const Script& script,
                             const Script& question) const;

  const Material& material_;
  std::vector<Script> pasts_;
};

/// Bytes that differ, as far as both go; the fewest of any past.
[[nodiscard]] std::size_t difference_of(const Rehearsal::Said& some, const Rehearsal::Said& others);

}  // namespace armjig::campaign
