// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "emulators/campaign/campaign.hpp"

namespace armjig::campaign {

/// Whether both are one defect, as far as can be told from outside: the shortest script of one
/// shows what the other was found by, too. What shows whatever is done says nothing of that, and
/// what is known is not one with what is news.
[[nodiscard]] bool have_one_cause(const Finding& one, const Finding& other);

/// A defect: the shortest of its findings, and the further ways in which it showed.
struct Cause {
  const Finding* finding{};
  std::vector<const Finding*> further{};
};

/// The findings by their causes, in the order in which their shortest ones were found. Each goes
/// with the shortest that it has one cause with, so that a way in which two defects show does not
/// make one of them. They belong to `findings`.
[[nodiscard]] std::vector<Cause> causes_of(const std::vector<Finding>& findings);

}  // namespace armjig::campaign
