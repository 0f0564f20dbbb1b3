// SPDX-License-Identifier: Apache-2.0
#include "conformance/bench.hpp"

#include <fmt/core.h>

namespace armjig {

std::string wording_of(const Judgement& judgement) {
  if (judgement.expected.empty()) return judgement.actual;
  return fmt::format("expected {}, got {}", judgement.expected, judgement.actual);
}

Duration Bench::noise() const noexcept {
  const auto own = longest_answer();
  const auto link = link_.value_or(Duration{});
  return heard_ - link > own ? own + link : heard_;
}

Duration Bench::link_noise() const noexcept { return link_ ? std::min(heard_, *link_) : noise(); }

void Bench::begin(Profile profile, std::uint64_t seed) {
  profile_ = profile;
  judgement_ = {};
  is_over_ = is_race_ = false;
  about_.clear();
  random_.seed(static_cast<std::uint32_t>(seed ^ (seed >> 32U)));
  forget_exchange();
}

void Bench::fail(std::string expected, std::string actual) {
  decide({Verdict::kFail, std::move(expected), std::move(actual)});
}

void Bench::fail_at(std::size_t byte, std::string expected, std::string actual) {
  decide({Verdict::kFail, std::move(expected), std::move(actual), false, byte});
}

void Bench::fail_by_silence(std::string expected, std::string actual) {
  decide({Verdict::kFail, std::move(expected), std::move(actual), true});
}

void Bench::skip(std::string reason) {
  Judgement judgement{Verdict::kSkipped, {}, std::move(reason)};
  judgement.is_left_out = true;
  decide(std::move(judgement));
}

void Bench::give_up(std::string reason) { decide({Verdict::kSkipped, {}, std::move(reason)}); }

void Bench::blame_rig(std::string reason) { decide({Verdict::kError, {}, std::move(reason)}); }

void Bench::leave_open(std::string reason) {
  decide({Verdict::kInconclusive, {}, std::move(reason)});
}

void Bench::expect_true(bool is_so, std::string_view wanted, std::string_view otherwise) {
  if (!is_so) fail(in_context(wanted), std::string{otherwise});
}

void Bench::expect_in_time(const InBounds& measured, std::string_view wanted,
                           std::string_view otherwise) {
  if (is_over_) return;
  const auto& [value, least, most, unit] = measured;
  const auto room = std::min(value - least, most - value) / (most - least);
  if (judgement_.margin.empty() || room < room_) {
    room_ = room;
    judgement_.margin =
        in_context(fmt::format("{:.1f} of {:.1f} to {:.1f} {}", value, least, most, unit));
  }
  if (value >= least && value <= most) return;
  Judgement judgement{Verdict::kFail, in_context(wanted), std::string{otherwise}};
  judgement.is_timing = true;
  judgement.margin = judgement_.margin;
  decide(std::move(judgement));
}

void Bench::expect_as_reference(std::uint64_t sessions) {
  if (is_over_) return;
  if (!play_sessions_) return skip("needs a reference beside the device, in virtual time");
  const auto seed = std::uint64_t{random()} << 32U | random();
  const auto parted = play_sessions_(seed, sessions);
  if (!parted) return blame_rig(describe(parted.error()));
  if (*parted) fail(in_context("what the reference beside it does"), **parted);
}

std::string Bench::in_context(std::string_view text) const {
  return about_.empty() ? std::string{text} : fmt::format("{} ({})", text, about_);
}

void Bench::decide(Judgement judgement) {
  if (is_over_) return;
  is_over_ = true;
  judgement_ = std::move(judgement);
  judgement_.is_race = is_race_;
  if (is_race_ && judgement_.verdict == Verdict::kFail) judgement_.is_timing = true;
}

}  // namespace armjig
