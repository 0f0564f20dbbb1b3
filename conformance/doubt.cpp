// SPDX-License-Identifier: Apache-2.0
#include "conformance/doubt.hpp"

#include <fmt/core.h>

#include <chrono>
#include <utility>

namespace armjig {
namespace {

/// So often a case that was late once has to be in time.
constexpr int kTriesInTime = 2;

/// So often an emulated device has to be in time where one was late twice.
constexpr int kReferences = 3;

/// Answers of an emulated device that come later than that make a link slow.
constexpr Duration kSlowLink = std::chrono::milliseconds{20};

constexpr auto kOnBusyMachine = ", on a machine that has too much to do";

Judgement left_open(std::string why) { return {Verdict::kInconclusive, {}, std::move(why)}; }

}  // namespace

Doubt::Doubt(Bench& bench, const RunOptions& options, std::function<CaseResult(const Case&)> run)
    : bench_{bench}, options_{options}, run_{std::move(run)} {}

void Doubt::measure_link() {
  bench_.measure_noise();
  if (!options_.reference) return bench_.know_link(Duration{});
  if (const auto reference = open_reference()) {
    reference->measure_noise();
    bench_.know_link(reference->heard_noise());
    link_ = reference->heard_noise();
  }
}

/// None if it cannot be had, or does not answer.
std::shared_ptr<Bench> Doubt::open_reference() const {
  auto reference = options_.reference();
  if (reference == nullptr) return reference;
  reference->begin(options_.profile, options_.seed);
  return reference->is_alive() ? reference : nullptr;
}

bool Doubt::is_busy() const { return options_.is_busy && options_.is_busy(); }

/// On a link that is slow itself whatever fails may have been late.
bool Doubt::is_moment(const Judgement& judgement) const noexcept {
  return judgement.is_timing || link_ > kSlowLink;
}

bool Doubt::may_be_late(const Judgement& judgement) const {
  return is_moment(judgement) || is_busy();
}

bool Doubt::must_fail_again(const CaseResult& result, bool has_failed) const {
  return result.judgement.verdict == Verdict::kFail &&
         (is_moment(result.judgement) || (is_busy() && !has_failed));
}

bool Doubt::is_over() const { return bench_.error() || options_.must_stop(); }

CaseResult Doubt::settle(const Case& one, bool has_failed) {
  auto result = run_(one);
  if (!options_.reference || result.judgement.verdict != Verdict::kFail) return result;
  if (!must_fail_again(result, has_failed)) return compare(one, std::move(result), 1);
  const bool was_moment = is_moment(result.judgement);
  const auto once = wording_of(result.judgement);
  for (int again = 0; again < kTriesInTime; ++again) {
    result = run_(one);
    if (is_over()) return result;
    if (must_fail_again(result, has_failed)) return doubt_moment(one, std::move(result));
    if (result.judgement.verdict != Verdict::kPass) return result;
  }
  result.judgement.actual = fmt::format("once {}; {} times as it should be", once, kTriesInTime);
  if (was_moment) return result;
  result.judgement.verdict = Verdict::kInconclusive;
  result.judgement.actual += kOnBusyMachine;
  return result;
}

/// A moment that was missed twice. In a race, which chance may decide, and on a busy machine it has
/// to be missed again beside each emulated device that is in time.
CaseResult Doubt::doubt_moment(const Case& one, CaseResult result) {
  const bool is_race = result.judgement.is_race;
  if (!is_race && !is_busy()) return compare(one, std::move(result), kReferences);
  for (int i = 0; i < kReferences; ++i) {
    result = compare(one, std::move(result), 1);
    if (result.judgement.verdict != Verdict::kFail) return result;
    auto again = run_(one);
    if (is_over()) return again;
    if (again.judgement.verdict == Verdict::kFail) continue;
    if (again.judgement.verdict != Verdict::kPass) return again;
    result.judgement =
        left_open(fmt::format("{} times {}; then otherwise{}", 2 + i, wording_of(result.judgement),
                              is_race ? ", in a race" : kOnBusyMachine));
    return result;
  }
  return result;
}

/// Plays the case to emulated devices, which have to pass it.
CaseResult Doubt::compare(const Case& one, CaseResult result, int tries) {
  if (options_.on_wait) options_.on_wait(fmt::format("{}: on an emulated device", name_of(one)));
  for (int i = 0; i < tries && !options_.must_stop(); ++i) {
    const auto reference = open_reference();
    if (reference == nullptr) return result;
    reference->measure_noise();
    reference->know_link(link_);
    reference->begin(options_.profile, options_.seed);
    reference->bring_to(one.start);
    reference->begin(options_.profile, seed_of(one, options_.seed));
    one.run(*reference);
    const auto& judgement = reference->judgement();
    if (judgement.verdict != Verdict::kFail) continue;
    result.judgement = left_open(fmt::format(
        "an emulated device on such a link does not pass either: {}", wording_of(judgement)));
    return result;
  }
  return result;
}

}  // namespace armjig
