// SPDX-License-Identifier: Apache-2.0
#include "conformance/bench.hpp"

#include <fmt/core.h>

namespace armjig {

void Bench::begin(Profile profile, std::uint64_t seed) {
  profile_ = profile;
  judgement_ = {};
  is_over_ = false;
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

void Bench::skip(std::string reason) { decide({Verdict::kSkipped, {}, std::move(reason)}); }

void Bench::leave_open(std::string reason) {
  decide({Verdict::kInconclusive, {}, std::move(reason)});
}

void Bench::expect_true(bool is_so, std::string_view wanted, std::string_view otherwise) {
  if (!is_so) fail(behind(wanted), std::string{otherwise});
}

std::string Bench::behind(std::string_view text) const {
  return about_.empty() ? std::string{text} : fmt::format("{} ({})", text, about_);
}

void Bench::decide(Judgement judgement) {
  if (is_over_) return;
  is_over_ = true;
  judgement_ = std::move(judgement);
}

}  // namespace armjig
