// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

using enum ProgrammingStatus;

void other_kind(NodeBench& node) {
  expect_outcome(node, "20 02 71 02 01 00 00 80 3F 01 00 00 80 3F 01 00 00 00 00 00 00 00 00 08",
                 kFailure);
}

void zero_rate(NodeBench& node) { expect_of_zero_rate(node, kFailure); }

void zero_pole(NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 00 00", kFailure); }

void no_inertia(NodeBench& node) {
  node.needs_emulation();
  expect_outcome(node, "22 00 00 00 00 00 00 00 10 C1", kFailure);
}

template <CommandId id>
void does_nothing(NodeBench& node) {
  node.send(id, 0.0F);
  node.expect_status(MotorStatus::kDisabled);
  node.send(kDisable);
}

template <CommandId id>
void chooses_nothing(NodeBench& node) {
  node.send(kReadMotorStatus);
  node.send(id);
  node.expect_read_on("02 02");
}

void brake(NodeBench& node) {
  node.needs_emulation();
  node.send(kVoltage, 1.5F);
  node.pause(300ms);
  node.send(kDisable);
  node.send(kBrake15);
  node.pause(100ms);
  const float before = node.number(kReadAngle);
  node.pause(50ms);
  const float angle = node.number(kReadAngle) - before;
  node.expect_true(std::fabs(angle) < 0.001F, "a shaft at rest",
                   fmt::format("a turn of {} rad", angle));
}

constexpr Case one(std::string_view requirement, std::string_view rule, void (*run)(Bench&),
                   Start start, Hazard hazard) {
  return from(start, hazard, requirement, rule, run);
}

constexpr Case kCases[] = {
    one("morap.documented.other-kind", "Kind 2.", on<other_kind>, kProgrammable, Hazard::kProgram),
    one("morap.documented.zero-rate", "0 Hz.", on<zero_rate>, kFresh, Hazard::kProgram),
    one("morap.documented.zero-pole", "0.", on<zero_pole>, kProgrammable, Hazard::kProgram),
    one("morap.documented.no-inertia", "0.", on<no_inertia>, kFresh, Hazard::kProgram),
    one("morap.documented.direct-voltage", "0 V.", on<does_nothing<kDirectVoltage>>,
        Start::kDisabled, Hazard::kState),
    one("morap.documented.torque", "0 N m.", on<does_nothing<kTorque>>, Start::kDisabled,
        Hazard::kState),
    one("morap.documented.position-set", "The status is chosen before.",
        on<chooses_nothing<kReadPositionSet>>, Start::kDisabled, Hazard::kState),
    one("morap.documented.speed-set", "The status is chosen before.",
        on<chooses_nothing<kReadSpeedSet>>, Start::kDisabled, Hazard::kState),
    one("morap.documented.brake", "1.5 V, 0, 15.", on<brake>, kFree, Hazard::kMove),
};

}  // namespace

std::span<const Case> documented_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
