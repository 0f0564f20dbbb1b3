// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "emulators/campaign/script.hpp"
#include "harness/compare/recording_diff.hpp"

namespace armjig::campaign {

/// What was said as messages.
[[nodiscard]] RecordedMessages messages_of(const std::vector<KeptRecord>& said,
                                           MakeDissector make_dissector);

/// Messages of some recording, which has to live longer.
using MessagesInOrder = std::vector<const RecordedMessage*>;

/// All that were said in that lane under this name, malformed in that way, or well-formed.
[[nodiscard]] MessagesInOrder all_named(std::string_view name, std::string_view fault,
                                        const std::string& lane, const RecordedMessages& said);

/// The state of a device as its messages told it last, of those since `begin`.
[[nodiscard]] std::uint64_t state_told(const RecordedMessages& messages, Instant begin);

/// What a device has shown so far: its states, as far as its messages tell them, which follows on
/// which, and how its answers differ. It stands in for the coverage of code that nobody has.
class Shown {
 public:
  /// Whether there is something new in what it said.
  bool add(const RecordedMessages& messages);

  [[nodiscard]] std::size_t states() const noexcept { return states_.size(); }
  [[nodiscard]] std::size_t transitions() const noexcept { return transitions_.size(); }
  [[nodiscard]] std::size_t answers() const noexcept { return answers_.size(); }

 private:
  using Marks = std::unordered_set<std::uint64_t>;
  Marks states_;
  Marks transitions_;
  Marks answers_;
};

}  // namespace armjig::campaign
