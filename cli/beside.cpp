// SPDX-License-Identifier: Apache-2.0
#include "cli/beside.hpp"

#include <fmt/core.h>

#include "cli/fuzz_material.hpp"
#include "emulators/campaign/campaign.hpp"

namespace armjig::cli {
namespace {

using campaign::CampaignOptions;
using campaign::CampaignState;

/// In what both differ first; none: in nothing.
std::optional<std::string> difference_in(const CampaignState& state) {
  if (!state.findings.empty()) return state.findings.front().sentence;
  if (state.unsettled == 0) return std::nullopt;
  return "the same session does not always show it: " + state.last_unsettled;
}

}  // namespace

PlaySessions sessions_beside(const Device& device, const Target& target, const Device& reference,
                             const BesideHow& beside) {
  RigOptions how;
  how.target = target;
  RigOptions model;
  model.target = sound_target(target.options);
  return [&device, &reference, how, model, beside](
             std::uint64_t seed, std::uint64_t count) -> Outcome<std::optional<std::string>> {
    auto material = material_of(reference, how, model, kLongestEmulated);
    if (!material) return tl::unexpected{material.error()};
    material->has_hands = beside.has_hands;
    material->are_ends_told = beside.are_ends_told;
    const auto stage = stage_of(device, how, reference, model, {}, kHorizon);
    const CampaignOptions options{
        .seed = seed,
        .most_cases = count,
        .judging = {device.make_dissector, {.time_tolerance = beside.tolerance}, kHorizon},
        .most_attempts = beside.most_attempts,
        .most_shrinking = Duration::max(),
        .stops_at_first = true};
    CampaignState state;
    if (const auto done = run_campaign(*stage, *material, options, state, {}); !done) {
      return tl::unexpected{done.error()};
    }
    auto difference = difference_in(state);
    if (difference) {
      *difference +=
          fmt::format(" (armjig fuzz {} --target '{}' --model '{}' --seed {} --cases {})",
                      device.name, how.target.text, model.target.text, seed, state.cases);
    }
    return difference;
  };
}

}  // namespace armjig::cli
