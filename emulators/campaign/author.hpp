// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulators/campaign/edit.hpp"
#include "emulators/sessions/dice.hpp"

namespace armjig::campaign {

/// Writes scripts: sessions of the device drawn at random, and what is made of those that showed
/// something, by changes that no program means: other fields, bytes, cuts, orders, times,
/// repetitions.
class Author {
 public:
  /// `material` outlives this.
  explicit Author(const Material& material) : material_{material} {}

  /// The script of that seed. `worthy` are those that showed something.
  [[nodiscard]] Script draw(std::uint64_t seed, const std::vector<Script>& worthy) const;

 private:
  using Dice = sessions::Dice;
  using Change = void (Author::*)(Dice& dice, Script& script) const;

  [[nodiscard]] Script fresh(Dice& dice) const;
  [[nodiscard]] Script harmless_ones(Dice& dice) const;
  void change_field(Dice& dice, Script& script) const;
  void change_everywhere(Dice& dice, Script& script, const std::string& kind) const;
  void change_a_field(Dice& dice, KeptRecord& record) const;
  void spoil_field(Dice& dice, KeptRecord& record, const Message& whole, const Field& field) const;
  void change_some_bytes(Dice& dice, KeptRecord& record) const;
  void sweep(Dice& dice, Script& script) const;
  void splice(Dice& dice, Script& script, const Script& other) const;
  void change_bytes(Dice& dice, Script& script) const;
  void cut_bytes(Dice& dice, Script& script) const;
  void add_bytes(Dice& dice, Script& script) const;
  void split(Dice& dice, Script& script) const;
  void repeat(Dice& dice, Script& script) const;
  void leave_out(Dice& dice, Script& script) const;
  void swap(Dice& dice, Script& script) const;
  void move_time(Dice& dice, Script& script) const;
  void hurry(Dice& dice, Script& script) const;
  void fit(Dice& dice, Script& script) const;
  void end(Script& script) const;

  const Material& material_;
};

}  // namespace armjig::campaign
