// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/campaign/script.hpp"
#include "emulators/sessions/dice.hpp"
#include "emulators/sessions/sessions.hpp"

namespace armjig::campaign {

/// What shows in no answer at once, such as where an arm was led, shows in what these are answered
/// with, or when.
struct Epilogue {
  std::span<const std::string_view> messages{};
  Duration pause{};         ///< between them
  std::int64_t one_in = 3;  ///< so many scripts ends with them
};

/// What scripts are made of: all that is known of a device.
struct Material {
  LinkKind kind{};  ///< of its link
  MakeDissector make_dissector{};
  DrawSession draw_session{};  ///< nullptr: scripts begin with what is harmless
  /// One harmless exchange. Each case ends with it, as the question whether the device is well.
  Script harmless;
  /// Makes lengths and checksums of a message right again, on a bus of one with the byte of the
  /// address; nullptr: it has none, or nobody can.
  void (*seal)(std::span<std::byte> message){};
  std::vector<std::uint32_t> addresses{};  ///< of a bus: who is there
  /// Leaves out of a script what may not be sent; empty: all may.
  std::function<void(Script& script)> permit{};
  bool has_hands = false;      ///< what is beside the link can be done
  bool has_operations = true;  ///< of a bus: transactions may have any form
  Duration longest{};          ///< of a script
  Spacing spacing{};
  Epilogue epilogue{};  ///< empty: all shows at once
};

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
  void set_number(KeptRecord& record, const Message& whole, std::span<const Field> fields,
                  std::int64_t number, float part) const;
  static bool put(Bytes message, KeptRecord& record);
  void seal(KeptRecord& record) const;
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
