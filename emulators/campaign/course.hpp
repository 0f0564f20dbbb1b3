// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "emulators/campaign/repertoire.hpp"

namespace armjig::campaign {

/// On a stream: what a deed begins that takes its time and goes by where the device really is, as
/// homing does, and what the guard lets pass only after it. Nothing where nobody knows what a sound
/// device says, or where a device is that nobody can make new: how long it takes depends on that.
class Courses {
 public:
  /// Of the messages of such deeds. Both outlive this.
  Courses(const Material& material, const Repertoire& repertoire);

  /// Each of them to its end, and then what may be sent only there: with numbers that go on from
  /// those which the device told, leg by leg, and another message after each leg.
  [[nodiscard]] std::vector<Script> steered() const;

 private:
  /// What the device told last, by the names of its fields.
  using Told = std::map<std::string, std::int64_t, std::less<>>;
  /// A message in which fields have the names of what the device tells.
  struct Wheel {
    const Setting* setting{};
    std::vector<Field> places;  ///< that may not be far from what is told
    std::vector<Field> numbers;
    std::vector<Field> bits;  ///< that are not told
  };

  [[nodiscard]] Told told_after(const Script& script) const;
  /// Empty: it does not open that.
  [[nodiscard]] Script steered(const Setting& closed, const Setting& deed) const;
  /// The deed and the other right after it, for half as long again as it takes until the device
  /// tells nothing new; none: it goes on and on.
  [[nodiscard]] std::optional<Script> to_its_end(const Setting& deed, const Setting& other) const;
  [[nodiscard]] Script permitted(Script script) const;
  [[nodiscard]] bool is_permitted_after(const Script& before, const Script& exchange) const;
  [[nodiscard]] Script with(const Wheel& wheel, const Told& numbers) const;
  /// None: it is not about what is told, or not permitted there.
  [[nodiscard]] std::optional<Wheel> wheel_of(const Setting& setting, const Script& before,
                                              const Told& told) const;
  [[nodiscard]] Script legs(const Wheel& wheel, Told at, const Script& back) const;

  const Material& material_;
  std::vector<const Setting*> deeds_;
  std::vector<const Setting*> others_;  ///< that may be sent anywhere
  std::vector<const Setting*> closed_;  ///< that may not
};

}  // namespace armjig::campaign
