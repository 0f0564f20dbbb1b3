// SPDX-License-Identifier: Apache-2.0
#include "cli/fuzz_suite.hpp"

#include <algorithm>
#include <utility>

#include "conformance/suite.hpp"

namespace armjig::cli {
namespace {

using campaign::Script;

Profile profile_of(const Target& target) {
  const auto found = target.options.find("profile");
  const bool is_documented =
      found != target.options.end() && found->second == to_string(Profile::kDocumented);
  return is_documented ? Profile::kDocumented : Profile::kFirmware;
}

/// One that is as new needs no power cycle to be so.
void forget_power_cycle(std::vector<KeptRecord>& records) {
  const auto last = std::ranges::find_if(records.rbegin(), records.rend(), campaign::is_by_hand);
  records.erase(records.begin(), last.base());
}

/// Empty: the device is not there.
Script script_of_case(const Device& device, const RigOptions& model, const Case& one) {
  constexpr std::uint64_t kSeed = 1;
  std::vector<KeptRecord> records;
  auto how = model;
  how.capture.listener = [&records](const CaptureRecord& record) {
    records.push_back(KeptRecord::from(record));
  };
  const auto bench = open_bench(device, how);
  if (!bench) return {};
  const auto profile = profile_of(model.target);
  (*bench)->begin(profile, kSeed);
  (*bench)->bring_to(one.start);
  forget_power_cycle(records);
  (*bench)->begin(profile, seed_of(one, kSeed));
  one.run(**bench);
  return campaign::with_ends(campaign::script_of(records));  // others come after it
}

}  // namespace

std::vector<Script> scripts_of_suite(const Device& device, const RigOptions& model, bool has_hands,
                                     Duration longest) {
  std::vector<Script> scripts;
  const auto suite = device.suite();
  for (const auto& chapter : suite.chapters) {
    for (const auto& one : chapter.cases) {
      if (one.is_search || one.hazard == Hazard::kCrash) continue;
      auto script = script_of_case(device, model, one);
      const bool is_within_reach = has_hands || std::ranges::none_of(script, campaign::is_by_hand);
      const bool is_short = campaign::length_of(script) <= longest;
      if (!script.empty() && is_within_reach && is_short) scripts.push_back(std::move(script));
    }
  }
  return scripts;
}

}  // namespace armjig::cli
