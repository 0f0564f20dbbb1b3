// SPDX-License-Identifier: Apache-2.0
// A program in a test: what it sends is judged as by `armjig emulate parol6 --check`.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include <armjig/conformance/parol6/host/check.hpp>
#include <armjig/conformance/program_check.hpp>
#include <armjig/emulators/parol6/arm.hpp>
#include "jogger.hpp"

using namespace armjig;
using namespace std::chrono_literals;

/// Runs a program with a board for so many periods of 10 ms, in no time.
template <class Program>
Report judge(Program program, int periods) {
  ProgramCheck check{parol6::programs::program_check(), {}, [](const Offence&) {}};
  const auto board = check.watch(make_hosted(parol6::emulation::Arm{}));
  std::optional<parol6::TelemetryFrame> seen;
  for (int i = 0; i < periods; ++i) {
    const auto now = at(1s + i * 10ms);
    board->receive(now, encode(program.next(seen)));
    board->advance_to(now + 9ms);
    parol6::TelemetryBytes bytes{};
    std::ranges::copy(board->sent().back().bytes, bytes.begin());
    seen = parol6::decode_telemetry(parol6::body_of(bytes));
    board->clear_sent();
  }
  return check.finish();
}

TEST(Jogger, KeepsTheRules) {
  const auto report = judge(Jogger{Degrees{5}}, 100);
  EXPECT_EQ(conclusion_of(report), Conclusion::kPassed) << to_text(report);
}

/// It jogs on for ever.
struct Careless {
  parol6::CommandFrame next(const std::optional<parol6::TelemetryFrame>& /*seen*/) {
    return {.speed = {StepsPerSecond{1000}}, .command = parol6::Command::kJog};
  }
};

TEST(Careless, IsFoundOut) {
  const auto report = judge(Careless{}, 100);
  const auto looks = std::ranges::find(report.rows, "parol6.host.looks-first", &ReportRow::name);
  EXPECT_EQ(looks->verdict, Verdict::kFail);
}
