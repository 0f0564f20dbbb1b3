// SPDX-License-Identifier: Apache-2.0
#include "conformance/bench.hpp"

#include <utility>

namespace armjig {

void Bench::begin(Profile profile, std::uint64_t seed) {
  profile_ = profile;
  judgement_ = {};
  is_over_ = false;
  random_.seed(static_cast<std::uint32_t>(seed ^ (seed >> 32U)));
  forget_exchange();
}

void Bench::fail(std::string expected, std::string actual) {
  decide({Verdict::kFail, std::move(expected), std::move(actual)});
}

void Bench::fail_by_silence(std::string expected, std::string actual) {
  decide({Verdict::kFail, std::move(expected), std::move(actual), true});
}

void Bench::skip(std::string reason) { decide({Verdict::kSkipped, {}, std::move(reason)}); }

void Bench::leave_open(std::string reason) {
  decide({Verdict::kInconclusive, {}, std::move(reason)});
}

void Bench::decide(Judgement judgement) {
  if (is_over_) return;
  is_over_ = true;
  judgement_ = std::move(judgement);
}

}  // namespace armjig
