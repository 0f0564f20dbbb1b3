// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/cause.hpp"

#include <algorithm>
#include <utility>

namespace armjig::campaign {
namespace {

bool explains(const Finding& one, const Finding& other) {
  if (one.size == 0) return false;
  return std::ranges::any_of(one.symptom.ways(), [&](const std::string& way) {
    return std::ranges::binary_search(other.shows, way);
  });
}

}  // namespace

bool have_one_cause(const Finding& one, const Finding& other) {
  return one.known == other.known && (explains(one, other) || explains(other, one));
}

std::vector<Cause> causes_of(const std::vector<Finding>& findings) {
  std::vector<const Finding*> by_size;
  by_size.reserve(findings.size());
  for (const auto& finding : findings) by_size.push_back(&finding);
  std::ranges::stable_sort(by_size, {}, &Finding::size);
  std::vector<Cause> causes;
  for (const auto* const finding : by_size) {
    const auto cause = std::ranges::find_if(
        causes, [finding](const Cause& one) { return have_one_cause(*one.finding, *finding); });
    if (cause == causes.end()) {
      causes.push_back({.finding = finding});
    } else {
      cause->further.push_back(finding);
    }
  }
  std::ranges::sort(causes, {}, &Cause::finding);  // as they are in `findings`
  return causes;
}

}  // namespace armjig::campaign
