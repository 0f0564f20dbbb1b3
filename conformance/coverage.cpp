// SPDX-License-Identifier: Apache-2.0
#include "conformance/coverage.hpp"

#include <algorithm>
#include <map>
#include <string_view>

namespace armjig {
namespace {

/// What was judged of a requirement's cases. One that broke it is enough; that it is obeyed takes
/// all that are within reach.
struct Judged {
  bool is_within = false;
  bool is_broken = false;
  bool is_open = false;

  void take(const ReportRow& row) noexcept {
    const bool is_broken_here = row.verdict == Verdict::kFail || row.verdict == Verdict::kFlaky;
    is_within = is_within || !row.is_left_out;
    is_broken = is_broken || is_broken_here;
    is_open = is_open || (!row.is_left_out && !is_broken_here && row.verdict != Verdict::kPass &&
                          row.verdict != Verdict::kDeviation);
  }
  [[nodiscard]] bool is_judged() const noexcept { return is_broken || (is_within && !is_open); }
};

void count(const Judged& judged, bool is_waived, Coverage& coverage) noexcept {
  ++coverage.all;
  if (judged.is_judged()) ++coverage.judged;
  if (!judged.is_within || is_waived) return;
  ++coverage.within;
  if (judged.is_judged()) ++coverage.judged_within;
}

bool binds(const Requirement& one, Profile profile) noexcept {
  return one.level == Level::kMust && one.role == Role::kDevice && holds_in(one.profiles, profile);
}

}  // namespace

Coverage coverage_of(const Suite& suite, Profile profile, std::span<const ReportRow> rows,
                     std::span<const Waiver> waivers) {
  std::map<std::string_view, Judged> judged;
  for (const auto& row : rows) {
    if (!row.requirement.empty()) judged[row.requirement].take(row);
  }
  Coverage coverage;
  for (const auto& chapter : suite.chapters) {
    for (const auto& one : chapter.requirements) {
      if (!binds(one, profile)) continue;
      const auto waiver = std::ranges::find(waivers, one.id, &Waiver::requirement);
      count(judged[one.id], waiver != waivers.end(), coverage);
    }
  }
  return coverage;
}

}  // namespace armjig
