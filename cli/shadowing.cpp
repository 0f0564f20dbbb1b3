// SPDX-License-Identifier: Apache-2.0
#include "cli/shadowing.hpp"

#include <fmt/core.h>

#include <chrono>
#include <string>
#include <utility>

#include "cli/diff.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

/// Of what goes on being different nobody reads more.
constexpr std::size_t kMostTold = 3;

}  // namespace

void add_shadow_options(CLI::App& command, ShadowOptions& options) {
  auto* shadow = command
                     .add_option("--shadow", options.target,
                                 "run an emulated device beside it, and say at once where they "
                                 "part: emulated:[?OPTIONS]")
                     ->type_name("TARGET");
  command.add_option("--rules", options.rules, "what may differ between both, as for diff")
      ->type_name("FILE")
      ->needs(shadow);
}

Outcome<std::unique_ptr<LiveShadow>> LiveShadow::open(const Device& device, const Target& beside,
                                                      const ShadowOptions& options) {
  if (options.target.empty()) return nullptr;
  const auto target = parse_target(options.target);
  if (!target) return tl::unexpected{target.error()};
  if (!target->is_emulated()) {
    return problem(ErrorCode::kBadTarget, "--shadow " + options.target,
                   "the one beside it is emulated: write emulated: or emulated:?OPTIONS");
  }
  auto rules = rules_beside(device, beside, options.rules);
  if (!rules) return tl::unexpected{rules.error()};
  return std::visit(
      [&](const auto& kind) -> Outcome<std::unique_ptr<LiveShadow>> {
        auto twin = cli::emulate(kind, target->options, target->text);
        if (!twin) return tl::unexpected{twin.error()};
        return std::unique_ptr<LiveShadow>{
            new LiveShadow{*std::move(twin), device, *std::move(rules)}};
      },
      device.port);
}

LiveShadow::LiveShadow(AnyHosted twin, const Device& device, ComparisonRules rules)
    : shadow_{std::make_unique<Shadow>(
          std::move(twin), device.make_dissector, std::move(rules),
          Shadow::Listener{
              .on_divergence =
                  [this](const Divergence& divergence) {
                    if (++told_ > kMostTold) return;
                    fmt::print(stderr, "armjig: shadow: {}\n", wording::line(describe(divergence)));
                  },
              .on_agreement =
                  [this](Instant time, const std::string& lane, std::size_t after) {
                    told_ = 0;
                    fmt::print(stderr, "armjig: shadow: {:.6f} s{}{}: both agree again, after {}\n",
                               std::chrono::duration<double>{time.time_since_epoch()}.count(),
                               lane.empty() ? "" : ", ", lane, after);
                  }})} {}

Exit LiveShadow::conclude() {
  shadow_->finish();
  const auto& counts = shadow_->counts();
  fmt::print(stderr, "armjig: shadow: {} messages, {} divergences, agreed again {} times\n",
             counts.messages, counts.divergences, counts.agreements);
  if (counts.messages == 0) return Exit::kNothing;
  return counts.divergences == 0 ? Exit::kPassed : Exit::kFindings;
}

}  // namespace armjig::cli
