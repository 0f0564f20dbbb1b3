// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "emulators/campaign/exercises.hpp"
#include "emulators/campaign/repertoire.hpp"

namespace armjig::campaign {

/// Everything that is known of a device, once: what was written for it, and each kind of message in
/// some states, and of each the values of its fields, itself many times, what is cut off it or
/// added to it, and every other kind after it, apart and in one piece. Where time is dear, chance
/// comes after that.
class Survey {
 public:
  /// Of the messages in sessions drawn from that seed. `material` outlives this.
  Survey(const Material& material, std::uint64_t seed);

  Survey(const Survey&) = delete;
  Survey& operator=(const Survey&) = delete;
  ~Survey() = default;

  [[nodiscard]] std::size_t size() const noexcept { return cases_.size(); }
  [[nodiscard]] Script at(std::size_t number) const { return cases_[number].script(); }
  /// All that can be asked of all who are there, and does nothing else; empty: there is no more
  /// than the harmless question.
  [[nodiscard]] Script questions() const;
  /// Those come after all others.
  void put_last(const std::function<bool(const Script& script)>& is_one);

 private:
  using Exercise = Script (Exercises::*)(const Setting& setting) const;
  using OfField = Script (Exercises::*)(const Setting& setting, const Field& field) const;
  struct Case {
    std::function<Script()> script;
    std::size_t fields = 0;  ///< of the message that it is about
  };

  void plan();
  void plan_all(const Setting& setting, const std::vector<Script>& bodies);
  void put_short_ones_first(std::size_t begin);
  bool plan(const Setting& setting, Exercise exercise);
  /// None: there is nothing of the kind on this link, or that the guard lets pass.
  [[nodiscard]] std::optional<Case> case_of(const Setting& setting, Exercise exercise) const;
  [[nodiscard]] std::vector<Case> plan_values(std::size_t state, OfField of_field);
  [[nodiscard]] std::vector<Case> tour_cases();
  [[nodiscard]] bool matters_first(const Setting& setting, const Field& field);
  [[nodiscard]] bool matters(const Setting& setting, const Field& field);
  [[nodiscard]] Script whole(const Setting& setting, const Script& body) const;

  const Material& material_;
  Repertoire repertoire_;
  const Setting nowhere_{};  ///< of what begins where the device is
  Exercises exercises_;
  std::vector<Setting> seldom_;  ///< of the tour
  /// What `matters` found.
  std::map<std::pair<const Setting*, const Field*>, bool> matter_;
  std::vector<Case> cases_;
};

}  // namespace armjig::campaign
