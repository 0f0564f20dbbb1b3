// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "emulators/campaign/edit.hpp"
#include "emulators/campaign/rehearsal.hpp"

namespace armjig::campaign {

/// Everything that is known of a device, once: each kind of message in some states, and of each the
/// values of its fields, itself many times, what is cut off it or added to it, and every other kind
/// after it, apart and in one piece. Where time is dear, chance comes after that.
class Survey {
 public:
  /// Of the messages in sessions drawn from that seed. `material` outlives this.
  Survey(const Material& material, std::uint64_t seed);

  Survey(const Survey&) = delete;
  Survey& operator=(const Survey&) = delete;
  ~Survey() = default;

  [[nodiscard]] std::size_t size() const noexcept { return cases_.size(); }
  [[nodiscard]] Script at(std::size_t number) const { return cases_[number](); }

 private:
  /// A kind of message where a session has one.
  struct Setting {
    Script before;    ///< up to it
    Script exchange;  ///< it, and on a bus what is read after it
    Script back;      ///< the last that was sent before it: leads into the same state again
    Message message;  ///< that it is
  };
  struct Kind {
    std::size_t times{};        ///< that it was met
    std::vector<Script> looks;  ///< on a bus: exchanges that may ask
    std::vector<Setting> settings;
  };
  using Body = Script (Survey::*)(const Setting& setting) const;
  using OfField = Script (Survey::*)(const Setting& setting, const Field& field) const;
  using Case = std::function<Script()>;

  /// Where a message may be looked at, and what a sound device says after it there.
  struct Trial {
    const Setting* setting{};
    Rehearsal::Said without;  ///< if it does not come: the state that it comes in
    std::size_t effect{};     ///< bytes that differ if it does
  };

  // What there is.
  void collect(std::uint64_t seed);
  [[nodiscard]] Script session_of(std::uint64_t seed) const;
  void note_messages(const Script& session, std::map<std::string, Kind>& found) const;
  void keep_permitted(std::vector<Setting>& settings) const;
  void find_looks(const std::map<std::string, Kind>& found);
  [[nodiscard]] bool is_look(const Script& exchange, const std::vector<Script>& others) const;
  void find_motion(const std::vector<Kind*>& kinds);
  [[nodiscard]] std::vector<Script> variants_of(const std::vector<Setting>& settings) const;

  // Where it is looked at.
  [[nodiscard]] std::vector<Setting> in_two_states(std::vector<Setting> all) const;
  [[nodiscard]] Setting led_to(Setting setting) const;
  [[nodiscard]] std::size_t effect_of(const Setting& setting) const;
  [[nodiscard]] std::vector<Setting> where_it_does_most(const std::vector<Setting>& all) const;
  [[nodiscard]] Rehearsal::Said said_after(const Setting& setting, const Script& exchange) const;

  // What is tried, in which order.
  void plan();
  void plan(const Setting& setting, Body body);
  [[nodiscard]] std::vector<Case> plan_values(std::size_t state, OfField of_field);
  [[nodiscard]] bool can_choose(const Setting& setting, const Field& field) const;
  [[nodiscard]] bool matters(const Setting& setting, const Field& field);
  [[nodiscard]] Script whole(const Setting& setting, const Script& body) const;

  // What each case is.
  [[nodiscard]] Script pairs(const Setting& setting) const;
  [[nodiscard]] Script some_copies(const Setting& setting) const;
  [[nodiscard]] Script many_copies(const Setting& setting) const;
  [[nodiscard]] Script spoiled_copies(const Setting& setting) const;
  [[nodiscard]] Script sums(const Setting& setting) const;
  [[nodiscard]] Script lengths(const Setting& setting) const;
  [[nodiscard]] Script odd_bytes(const Setting& setting) const;
  [[nodiscard]] Script sizes(const Setting& setting) const;
  [[nodiscard]] Script long_gap(const Setting& setting) const;
  [[nodiscard]] Script values(const Setting& setting, const Field& field) const;
  [[nodiscard]] Script watched_lengths(const Setting& setting) const;
  [[nodiscard]] Script watched_pairs(const Setting& setting) const;
  [[nodiscard]] Script watched_values(const Setting& setting, const Field& field) const;
  [[nodiscard]] Script with_number(const Setting& setting, std::span<const Field> fields,
                                   std::int64_t number) const;
  [[nodiscard]] Script with_bits(const Setting& setting, const Field& field,
                                 std::int64_t bits) const;
  [[nodiscard]] bool can_be_watched() const;
  void add_watched(Script& body, const Script& odd) const;
  void look(Script& body, std::size_t which) const;
  void look_at_all(Script& body, std::uint32_t address, Duration pause = kStep) const;

  const Material& material_;
  Rehearsal rehearsal_;
  std::vector<std::vector<Setting>> kinds_;  ///< of each some, in different states
  std::vector<Script> looks_;                ///< on a bus: the exchanges that ask
  std::vector<Script> samples_;              ///< an exchange of each kind
  Script motion_;  ///< on a bus: after it, what is read goes on changing; empty: after nothing
  /// What `matters` found.
  std::map<std::pair<const Setting*, const Field*>, bool> matter_;
  std::vector<Case> cases_;
};

}  // namespace armjig::campaign
