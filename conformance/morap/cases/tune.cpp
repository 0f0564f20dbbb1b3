// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

using enum ProgrammingStatus;
using enum TuneKind;

void success(NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 10 C1", kSuccess); }

void at_the_byte(NodeBench& node) {
  node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1", BusBench::End::kOpen);
  node.expect_programming(kSuccess);
}

CommandId selector_of(TuneKind kind) { return kind == kPiSpeed ? kReadSpeedSet : kReadPositionSet; }

template <TuneKind kind>
void tuned(NodeBench& node) {
  for (const auto& [request, set] : node.motor().tuned) {
    if (request.kind != kind) continue;
    node.about(fmt::format("inertia {}, pole {}", request.inertia, request.pole));
    node.tune(request.kind, request.inertia, request.pole);
    node.settle();
    node.expect_bytes(selector_of(kind), set);
  }
}

void expect_rate(NodeBench& node, TuneKind kind, float inertia, int rate_hz) {
  node.about(fmt::format("inertia {}", inertia));
  node.tune(kind, inertia, -9.0F);
  node.settle();
  const auto bytes = node.read(selector_of(kind), 3);
  const int actual = load_u16_le(slice<2>(Bytes{bytes}, 1));
  node.expect_true(actual == rate_hz, fmt::format("{} Hz", rate_hz), fmt::format("{} Hz", actual));
}

/// The inertia with which the motor's own pole is at `-pole`.
float inertia_of(const Motor& motor, double pole) {
  const auto m = motor.eeprom(0).motor;
  const auto constant = static_cast<double>(m.torque_constant) * static_cast<double>(m.gear_ratio);
  const auto resistance = static_cast<double>(m.resistance);
  const auto damping = static_cast<double>(m.efficiency) * constant * constant +
                       resistance * static_cast<double>(m.friction);
  return static_cast<float>(damping / (resistance * pole));
}

void position_rate(NodeBench& node) {
  expect_rate(node, kPdPosition, inertia_of(node.motor(), 71), 625);
  expect_rate(node, kPdPosition, inertia_of(node.motor(), 69), 400);
  expect_rate(node, kPidPosition, inertia_of(node.motor(), 71), 625);
  expect_rate(node, kPidPosition, inertia_of(node.motor(), 69), 400);
}

void speed_rate(NodeBench& node) {
  expect_rate(node, kPiSpeed, inertia_of(node.motor(), 152), 625);
  expect_rate(node, kPiSpeed, inertia_of(node.motor(), 148), 400);
  expect_rate(node, kPiSpeed, inertia_of(node.motor(), 102), 400);
  expect_rate(node, kPiSpeed, inertia_of(node.motor(), 98), 320);
}

void pole_of_motor(NodeBench& node) {
  const float inertia = inertia_of(node.motor(), 60);
  node.tune(kPdPosition, inertia, -100.0F);
  node.settle();
  const auto limited = node.read(kReadPositionSet, 31);
  node.tune(kPdPosition, inertia, -200.0F);
  node.settle();
  node.expect_same(node.read(kReadPositionSet, 31), limited);
  node.tune(kPdPosition, inertia, -55.0F);
  node.settle();
  node.expect_true(node.read(kReadPositionSet, 31) != limited, "another controller for -55",
                   "the same");
}

void at_tick(NodeBench& node) {
  node.tick();
  node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1");
  node.expect_bytes(kReadPositionSet, "00 71 02");
  node.tick();
  node.expect_bytes(kReadPositionSet, "00 90 01");
}

void positive_pole(NodeBench& node) {
  expect_outcome(node, "22 00 CD CC 4C 3E 00 00 80 3F", kFailure);
}
void fast_pole(NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 8F 02 48 C3", kFailure); }
void fastest_pole(NodeBench& node) {
  expect_outcome(node, "22 00 CD CC 4C 3E 00 00 48 C3", kSuccess);
}
void heavy(NodeBench& node) {
  expect_outcome(node, "22 00 00 00 30 41 00 00 10 C1", kFailure);
  expect_outcome(node, "22 00 01 00 20 41 00 00 10 C1", kFailure);
}
void heaviest(NodeBench& node) { expect_outcome(node, "22 00 00 00 20 41 00 00 80 BF", kSuccess); }
void negative_inertia(NodeBench& node) {
  expect_outcome(node, "22 00 CD CC 4C BE 00 00 10 C1", kFailure);
}
void unknown_kind(NodeBench& node) {
  expect_outcome(node, "22 03 CD CC 4C 3E 00 00 10 C1", kFailure);
  expect_outcome(node, "22 FF CD CC 4C 3E 00 00 10 C1", kFailure);
}

void failure_unused(NodeBench& node) {
  const auto position = node.read(kReadPositionSet, 31);
  const auto speed = node.read(kReadSpeedSet, 31);
  node.send_bytes("22 00 00 00 30 41 00 00 10 C1");
  node.send_bytes("22 02 CD CC 4C 3E 00 00 80 3F");
  node.settle();
  node.expect_same(node.read(kReadPositionSet, 31), position);
  node.expect_same(node.read(kReadSpeedSet, 31), speed);
}

void short_message(NodeBench& node) {
  expect_outcome(node, "22 00 CD CC 4C 3E 00 00 10", kNothing);
}
void surplus(NodeBench& node) {
  expect_outcome(node, "22 00 CD CC 4C 3E 00 00 10 C1 09", kSuccess);
}
void pieces(NodeBench& node) {
  node.send_bytes("22 00 CD CC 4C 3E");
  expect_outcome(node, "00 00 10 C1", kNothing);
}
void zero_pole(NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 00 00", kSuccess); }
void no_inertia(NodeBench& node) {
  node.needs_emulation();
  expect_outcome(node, "22 00 00 00 00 00 00 00 10 C1", kSuccess);
}

constexpr Case kCases[] = {
    programming("morap.tune.success", "0.2 kg m^2 and -9.", on<success>),
    programming("morap.tune.at-the-byte", "With a repeated start.", on<at_the_byte>),
    programming("morap.tune.pd", "Light and heavy loads, slow and fast poles.",
                on<tuned<kPdPosition>>),
    programming("morap.tune.pid", "Light and heavy loads, slow and fast poles.",
                on<tuned<kPidPosition>>),
    programming("morap.tune.pi", "Light and heavy loads, slow and fast poles.",
                on<tuned<kPiSpeed>>),
    programming("morap.tune.position-rate", "Around the border, with PD and PID.",
                on<position_rate>),
    programming("morap.tune.speed-rate", "Around both borders.", on<speed_rate>),
    programming("morap.tune.pole-of-motor", "Two that are faster, one that is not.",
                on<pole_of_motor>),
    programming("morap.tune.at-tick", "Read before and behind the tick.", on<at_tick>, kFresh),
    programming("morap.tune.positive-pole", "1.", on<positive_pole>),
    programming("morap.tune.fast-pole", "-200.01.", on<fast_pole>),
    programming("morap.tune.fastest-pole", "-200.", on<fastest_pole>),
    programming("morap.tune.heavy", "11, and the next above 10.", on<heavy>),
    programming("morap.tune.heaviest", "10.", on<heaviest>),
    programming("morap.tune.negative-inertia", "-0.2.", on<negative_inertia>),
    programming("morap.tune.unknown-kind", "3 and 255.", on<unknown_kind>),
    programming("morap.tune.failure-unused", "One of each controller.", on<failure_unused>),
    programming("morap.tune.short", "One byte is missing.", on<short_message>),
    programming("morap.tune.surplus", "One byte more.", on<surplus>),
    programming("morap.tune.pieces", "The pole in a write of its own.", on<pieces>),
    programming("morap.tune.zero-pole", "0.", on<zero_pole>),
    programming("morap.tune.no-inertia", "0, never run.", on<no_inertia>, kFresh),
};

}  // namespace

std::span<const Case> tune_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
