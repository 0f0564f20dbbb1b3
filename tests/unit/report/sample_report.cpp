// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/report/sample_report.hpp"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

namespace armjig::test {
namespace {

using namespace std::chrono_literals;

ReportRow row(Verdict verdict, std::string name, std::string summary) {
  ReportRow row;
  row.verdict = verdict;
  row.name = std::move(name);
  row.summary = std::move(summary);
  row.requirement = row.name;
  row.demand = "The board does what the sentence says.";
  row.source = "section 4.2 of the made-up manual";
  row.repeat = "armjig conformance parol6 --target emulated: --filter " + row.name;
  row.duration = 12345us;
  return row;
}

constexpr auto kEvidence =
    "12.000 ms to_device   command, 52 bytes\n"
    "          FF FF FF 34 00 00 27 10 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
    "7B\n"
    "          command            123 (jog)\n"
    "          speed.j1           10000 steps/s\n"
    "13.250 ms from_device telemetry, 60 bytes\n"
    "          FF FF FF 38 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 10 27 00 00 00 "
    "00\n"
    "          speed.j1           4135 steps/s\n";

double sine(double turns) { return std::sin(2 * std::numbers::pi * turns); }

Series wave(std::string name, Shape shape, double frequency, double phase, int points) {
  Series series{.name = std::move(name), .shape = shape};
  for (int i = 0; i < points; ++i) {
    const double t = 60.0 * i / points;
    series.points.push_back({t, 45 * sine(frequency * (t - phase)) + sine(0.73 * t)});
  }
  return series;
}

/// Round trips that are mostly quick and have a long tail.
Series tail_of_latency() {
  Series series{.name = "round trips", .shape = Shape::kBars};
  for (int bin = 0; bin < 60; ++bin) {
    const double ms = 0.1 * std::pow(1.1, bin);
    const double bulk = 4e5 * std::exp(-std::pow(std::log(ms / 0.55) / 0.22, 2));
    const double late = 900 * std::exp(-std::pow(std::log(ms / 4) / 0.5, 2));
    series.points.push_back({ms, std::floor(bulk + late)});
  }
  return series;
}

Plot tracking() {
  Plot plot{.title = "J1 follows its command",
            .x = {.label = "time / s"},
            .y = {.label = "angle / degrees"}};
  plot.series = {wave("commanded", Shape::kSteps, 0.05, 0, 6000),
                 wave("measured", Shape::kLine, 0.05, 0.6, 6000)};
  auto& gap = plot.series[1].points;  // the link was down
  for (std::size_t i = 3000; i < 3150; ++i) gap[i].y = std::numeric_limits<double>::quiet_NaN();
  return plot;
}

Plot late_sends() {
  Plot plot{.title = "Late sends", .x = {.label = "time / s"}, .y = {.label = "late by / ms"}};
  Series dots{.name = "late", .shape = Shape::kDots};
  for (int i = 0; i < 40; ++i) {
    dots.points.push_back({std::fmod(i * 17.3, 60), 0.2 + 0.15 * (i * 7 % 13)});
  }
  const Series limit{.name = "limit", .points = {{0, 2}, {60, 2}}};
  plot.series = {dots, limit};
  return plot;
}

}  // namespace

Report one_of_each() {
  Report report;
  report.title = "Conformance of parol6";
  report.facts = {{"target", "emulated:?profile=firmware"}, {"seed", "42"}, {"armjig", "0.1.0"}};
  report.rows = {
      row(Verdict::kPass, "parol6.frame.burst", "A burst of 32 frames is answered frame by frame."),
      row(Verdict::kFail, "parol6.telemetry.layout", "Speeds are big-endian."),
      row(Verdict::kDeviation, "parol6.frame.check", "A wrong check byte is ignored."),
      row(Verdict::kFlaky, "parol6.telemetry.timing", "The answer comes within a millisecond."),
      row(Verdict::kSkipped, "parol6.estop.latch", "Estop latches."),
      row(Verdict::kInconclusive, "parol6.estop.release", "Release alone does not move anything."),
      row(Verdict::kError, "parol6.alive", "no sign of life after parol6.estop.release")};
  auto& fail = report.rows[1];
  fail.expected = "speed.j1 of 10000 steps/s";
  fail.actual = "speed.j1 of 4135 steps/s";
  fail.evidence = kEvidence;
  report.rows[2].expected = "no answer";
  report.rows[2].actual = "an answer, as the firmware profile gives";
  report.rows[3].level = Level::kShould;
  report.rows[3].actual = "late in 3 of 20 runs";
  report.rows[4].actual = "motion needs --allow move";
  report.rows[5].actual = "nothing had moved before either";
  report.rows[6].requirement.clear();
  report.rows[6].expected = "an answer to a good message";
  report.rows[6].actual = "silence";
  return report;
}

Report nasty_report() {
  auto report = one_of_each();
  const std::string text = kNasty + "\nnext line\r\n\ttab " + std::string(5000, 'M');
  report.title += text;
  for (auto& [name, value] : report.facts) {
    name += text;
    value += text;
  }
  for (auto& row : report.rows) {
    for (auto* member : {&row.name, &row.summary, &row.requirement, &row.demand, &row.source,
                         &row.expected, &row.actual, &row.evidence, &row.repeat}) {
      *member += text;
    }
  }
  Plot plot{.title = text, .x = {.label = text}, .y = {.label = text}};
  plot.series = {{.name = text, .points = {{0, 1}, {1, 2}}}};
  report.sections = {{.title = text,
                      .text = text,
                      .table = {.columns = {text, "n"}, .rows = {{text, "1"}, {text, "2"}}},
                      .plots = {plot}}};
  return report;
}

/// Two sticks, of which the outer one goes round.
Scene waving_arm() {
  Scene scene{"An arm & its tool", "mm", {}};
  for (int i = 0; i <= 100; ++i) {
    const double angle = 0.06 * i;
    scene.poses.push_back(
        {0.05 * i, {{}, {0, 0, 300}, {200 * std::cos(angle), 200 * std::sin(angle), 320}}});
  }
  return scene;
}

Report drive_report() {
  auto report = one_of_each();
  report.title = "Drive run of parol6, 60 s at 100 Hz";
  report.started = std::chrono::sys_days{std::chrono::year{2026} / 3 / 29} + 14h + 5min + 9s;
  report.facts.emplace_back("impairment", "loss=1%,delay=normal(2ms,1ms),split=random");
  const Plot latency{.title = "Round trips",
                     .x = {.label = "round trip / ms", .scale = Scale::kLog},
                     .y = {.label = "count", .scale = Scale::kLog},
                     .series = {tail_of_latency()}};
  Plot jitter{.title = "Distance between sends",
              .x = {.label = "time / s"},
              .y = {.label = "distance / ms"}};
  for (int joint = 1; joint <= 6; ++joint) {
    auto series = wave("J" + std::to_string(joint), Shape::kLine, 0.03 * joint, joint, 400);
    for (auto& point : series.points) point.y = 10 + point.y / 500 + 0.1 * joint;
    jitter.series.push_back(std::move(series));
  }
  report.sections = {
      {.title = "Motion", .plots = {tracking(), jitter}, .scenes = {waving_arm()}},
      {.title = "Latency",
       .text = "Each send is compared with its deadline on the monotonic clock. The worst is the "
               "worst of all, not of a sample.",
       .table = {.columns = {"stage", "median", "99.9 %", "worst", "remark"},
                 .rows = {{"send after deadline", "0.021 ms", "0.180 ms", "1.4 ms", ""},
                          {"round trip", "0.55 ms", "4.1 ms", "18.2 ms", "one USB reset"}}},
       .plots = {latency, late_sends(), {.title = "Reconnects", .x = {.label = "time / s"}}}}};
  return report;
}

}  // namespace armjig::test
