// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "emulators/campaign/campaign.hpp"
#include "harness/report/report.hpp"

namespace armjig::campaign {

/// A row for each finding, which fails unless it was known, and one for the cases; what the device
/// showed as a table. `repeat_of` gives the command that shows a finding again. `title` and `facts`
/// are for the caller to add to.
[[nodiscard]] Report to_report(const std::string& device, const CampaignState& state,
                               const std::function<std::string(const Finding&)>& repeat_of);

/// A campaign that ended before its time, and why: what was not played is not passed.
[[nodiscard]] ReportRow row_of_end(const std::string& device, const Problem& problem);

/// `1234 cases, 56.7 a second; 12 states, 34 transitions, 56 answers; 1 finding`.
[[nodiscard]] std::string progress_line(const CampaignState& state);

}  // namespace armjig::campaign
