// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "emulators/campaign/script.hpp"
#include "emulators/campaign/symptom.hpp"

/// Scripts that show the same defect in another place: in one of several fields of a kind, as of
/// the joints `position.j1` and `position.j2`, or in the whole of what was cut.
namespace armjig::campaign {

/// The script as it would be for the other joints: where its messages have fields that end with the
/// number of `part` and with another one, their values are exchanged. One script for each number;
/// none if that changes nothing. `seal` makes messages right again; it may be empty.
[[nodiscard]] std::vector<Script> for_siblings(const Script& script, std::string_view part,
                                               MakeDissector make_dissector,
                                               void (*seal)(std::span<std::byte> message));

/// The script with reads of a bus that are long enough for any message, in place of those that cut
/// it short; the same if there is none.
[[nodiscard]] Script with_whole_reads(Script script);

/// Whether both are wrong in the same manner: by as much, or by the same factor, give or take one
/// in twenty; in parts that differ in their number alone.
[[nodiscard]] bool are_alike(const Symptom& one, const Symptom& other);

}  // namespace armjig::campaign
