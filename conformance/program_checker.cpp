// SPDX-License-Identifier: Apache-2.0
#include "conformance/program_checker.hpp"

#include <algorithm>

namespace armjig {
namespace {

using namespace std::chrono_literals;

/// After a look that was missed a program has as long to catch up as that took, within these.
constexpr Duration kShortestRecovery = 20ms;
constexpr Duration kLongestRecovery = 1s;
/// Of a machine without time there may be many.
constexpr std::size_t kMostSpans = 4096;

}  // namespace

void ProgramChecker::overlook(Instant from, Instant to) {
  overlooked_ += to - from;
  spans_.push_back({from, to + std::clamp(to - from, kShortestRecovery, kLongestRecovery)});
  if (spans_.size() > kMostSpans) spans_.pop_front();
}

Duration ProgramChecker::overlooked_since(Instant since) const noexcept {
  Duration sum{};
  auto counted = since;  // spans may overlap
  for (const auto& span : spans_) {
    const auto from = std::max(span.from, counted);
    const auto to = std::min(span.to, now_);
    if (to < from) continue;
    sum += std::max(to - from, Duration{1});
    counted = to;
  }
  return sum;
}

bool ProgramChecker::take(std::string_view requirement, std::string what,
                          const std::optional<Timing>& timing) {
  if (timing && overlooked_since(timing->since) > timing->beyond) {
    doubts_.insert(requirement);
    return false;
  }
  offences_.push_back({now_, requirement, std::move(what)});
  return true;
}

bool ProgramChecker::had_occasion(const Requirement& requirement) const {
  if (requirement.occasion.empty()) return messages() > 0;
  return occasions_.contains(requirement.occasion) || occasions_.contains(requirement.id);
}

}  // namespace armjig
