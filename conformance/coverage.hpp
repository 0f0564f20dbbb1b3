// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/suite.hpp"
#include "conformance/waivers.hpp"
#include "harness/report/report.hpp"

namespace armjig {

/// How much of what binds a device in a profile (its must requirements) these rows of cases judged.
/// A requirement is judged if one of its cases failed, or if all within reach were judged; what a
/// waiver names is not within reach.
[[nodiscard]] Coverage coverage_of(const Suite& suite, Profile profile,
                                   std::span<const ReportRow> rows,
                                   std::span<const Waiver> waivers);

}  // namespace armjig
