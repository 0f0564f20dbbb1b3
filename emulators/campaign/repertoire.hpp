// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulators/campaign/edit.hpp"
#include "emulators/campaign/rehearsal.hpp"

namespace armjig::campaign {

/// A kind of message where a session has one.
struct Setting {
  Script before;    ///< up to it
  Script exchange;  ///< it, and on a bus what is read after it
  Script back;      ///< the last that was sent before it: leads into the same state again
  Message message;  ///< that it is
  Script telling;   ///< on a bus: what asks for what it changes; empty: nothing does
  std::vector<Script> variants;  ///< the exchange with this message in other forms
  Duration rest = kStep;         ///< after what is before it
};

/// What can be said to a device, out of sessions: each kind of message where it is worth looking
/// at, what asks, and what makes it move.
class Repertoire {
 public:
  /// Of the messages in sessions drawn from that seed; none if there are no sessions. `material`
  /// outlives this.
  Repertoire(const Material& material, std::uint64_t seed);

  /// The most frequent first; of each one or two settings, in different states.
  [[nodiscard]] const std::vector<std::vector<Setting>>& kinds() const noexcept { return kinds_; }
  /// On a bus: the exchanges that ask, and do nothing else.
  [[nodiscard]] const std::vector<Script>& looks() const noexcept { return looks_; }
  /// On a bus: after it, what is read goes on changing; empty: after nothing.
  [[nodiscard]] const Script& motion() const noexcept { return motion_; }

  /// The message by which most moves, of those whose course does not depend on more than answers
  /// tell, after what makes it move; none: there is none.
  [[nodiscard]] const std::optional<Setting>& mover() const noexcept { return mover_; }

  /// Asks the device there all that can be asked.
  void look_at_all(Script& body, std::uint32_t address, Duration pause = kStep) const;

  [[nodiscard]] bool is_rehearsed() const { return rehearsal_.is_possible(); }
  /// What a sound device says if that is sent there, asked for all that it tells.
  [[nodiscard]] Rehearsal::Said said_after(const Setting& setting, const Script& exchange) const;

 private:
  struct Kind {
    std::size_t times{};        ///< that it was met
    std::vector<Script> looks;  ///< on a bus: exchanges that may ask
    std::vector<Setting> settings;
    std::map<std::size_t, Script> of_size;  ///< an exchange with each size of the message
  };
  /// Where a message may be looked at, and what a sound device says after it there.
  struct Trial {
    const Setting* setting{};
    Rehearsal::Said without;  ///< if it does not come: the state that it comes in
    std::size_t effect{};     ///< bytes that differ if it does
  };

  // What there is.
  [[nodiscard]] Script session_of(std::uint64_t seed) const;
  void note_messages(const Script& session, std::map<std::string, Kind>& found) const;
  void keep_permitted(std::vector<Setting>& settings) const;
  void find_looks(const std::map<std::string, Kind>& found);
  [[nodiscard]] bool is_look(const Script& exchange, const std::vector<Script>& others) const;
  void find_mover();
  void find_motion(const std::vector<Kind*>& kinds);
  [[nodiscard]] std::vector<Script> variants_of(const std::vector<Setting>& settings) const;

  // Where it is looked at.
  [[nodiscard]] std::vector<Setting> in_two_states(std::vector<Setting> all) const;
  [[nodiscard]] Setting led_to(Setting setting) const;
  [[nodiscard]] std::size_t effect_of(const Setting& setting) const;
  [[nodiscard]] Script telling_of(const Setting& setting) const;
  [[nodiscard]] std::vector<Setting> where_it_does_most(const std::vector<Setting>& all) const;

  const Material& material_;
  Rehearsal rehearsal_;
  std::vector<Script> samples_;  ///< an exchange of each kind
  std::vector<std::vector<Setting>> kinds_;
  std::vector<Script> looks_;
  Script motion_;
  std::optional<Setting> mover_;
};

/// The exchange with that number in the fields.
[[nodiscard]] Script with_number(const Material& material, const Setting& setting,
                                 std::span<const Field> fields, std::int64_t number);

}  // namespace armjig::campaign
