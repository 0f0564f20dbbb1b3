// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "conformance/suite.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// Excuses one requirement of a device for a while.
struct Waiver {
  std::string requirement;
  std::string reason;
  std::chrono::year_month_day expires;  ///< the last day on which it holds
};

/// Reads a waiver file, `{"schema": "armjig.waivers/1", "waivers": [{"requirement": ID,
/// "reason": TEXT, "expires": "2027-01-31"}, ...]}`. `where` names it in problems, which are
/// `kMalformed`: no such requirement in the suite, one excused twice, no reason, expired before
/// `today`.
[[nodiscard]] Outcome<std::vector<Waiver>> parse_waivers(std::string_view text, const Suite& suite,
                                                         std::chrono::year_month_day today,
                                                         const std::string& where);

/// The same from a file. Problems: those above, and `kCannotRead`.
[[nodiscard]] Outcome<std::vector<Waiver>> read_waivers(const std::string& path, const Suite& suite,
                                                        std::chrono::year_month_day today);

/// `2027-01-31`.
[[nodiscard]] std::string to_string(std::chrono::year_month_day day);

}  // namespace armjig
