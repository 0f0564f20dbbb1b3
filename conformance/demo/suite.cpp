// SPDX-License-Identifier: Apache-2.0
#include "conformance/demo/suite.hpp"

#include <array>

#include "harness/wire/demo/demo.hpp"

namespace armjig::demo {
namespace {

using namespace std::chrono_literals;

constexpr std::array kRequirements{
    Requirement{"demo.query", Level::kMust, "A query is answered with the state.", "made up here"},
    Requirement{"demo.halt.while-halted", Level::kMust,
                "A device told to halt while halted stays halted.", "made up here"},
};

/// The field that says the state, in any reply.
const Field& state_field() { return reply_fields()[1]; }

Judgement expect_state(Bench& bench, State state) {
  const auto reply = bench.receive(100ms);
  const auto wanted = field_text(state_field(), static_cast<std::int64_t>(state));
  if (!reply) return fail(wanted, "silence");
  if (!reply->fault.empty()) return fail(wanted, reply->fault);
  const auto value = field_value(state_field(), reply->raw);
  if (value == static_cast<std::int64_t>(state)) return pass();
  return fail(wanted, field_text(state_field(), value));
}

constexpr std::array kCases{
    Case{.id = "demo.query",
         .requirement = "demo.query",
         .rule = "A halted device says so.",
         .run =
             [](Bench& bench) {
               bench.send(encode(Operation::kQuery));
               return expect_state(bench, State::kHalted);
             }},
    Case{.id = "demo.halt.while-halted",
         .requirement = "demo.halt.while-halted",
         .rule = "Halting twice is the same as once.",
         .run =
             [](Bench& bench) {
               bench.send(encode(Operation::kHalt));
               return expect_state(bench, State::kHalted);
             }},
};

bool prepare(Bench& bench) {
  bench.drain(10ms);
  bench.send(encode(Operation::kHalt));
  return bench.receive(100ms).has_value();
}

}  // namespace

Suite suite() noexcept { return {"demo", kRequirements, kCases, prepare}; }

}  // namespace armjig::demo
