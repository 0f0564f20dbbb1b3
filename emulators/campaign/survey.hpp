// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "emulators/campaign/edit.hpp"

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
    std::size_t times{};  ///< that it was met
    Script look;          ///< on a bus: an exchange that asks; empty: it does not
    std::vector<Setting> settings;
  };
  using Body = Script (Survey::*)(const Setting& setting) const;

  void collect(std::uint64_t seed);
  [[nodiscard]] Script session_of(std::uint64_t seed) const;
  void note_messages(const Script& session, std::map<std::string, Kind>& found) const;
  [[nodiscard]] static std::vector<Setting> in_two_states(std::vector<Setting> all);
  void plan();
  void plan(const Setting& setting, Body body);
  void plan_values(std::size_t state);
  [[nodiscard]] bool can_choose(const Setting& setting, const Field& field) const;
  [[nodiscard]] Script whole(const Setting& setting, const Script& body) const;
  [[nodiscard]] Script pairs(const Setting& setting) const;
  [[nodiscard]] Script some_copies(const Setting& setting) const;
  [[nodiscard]] Script many_copies(const Setting& setting) const;
  [[nodiscard]] Script lengths(const Setting& setting) const;
  [[nodiscard]] Script odd_bytes(const Setting& setting) const;
  [[nodiscard]] Script sizes(const Setting& setting) const;
  [[nodiscard]] Script long_gap(const Setting& setting) const;
  [[nodiscard]] Script values(const Setting& setting, const Field& field) const;
  void look(Script& body, std::size_t which) const;
  void look_at_all(Script& body) const;

  const Material& material_;
  std::vector<std::vector<Setting>> kinds_;  ///< of each some, in different states
  std::vector<Script> looks_;                ///< on a bus: the exchanges that ask
  std::vector<std::function<Script()>> cases_;
};

}  // namespace armjig::campaign
