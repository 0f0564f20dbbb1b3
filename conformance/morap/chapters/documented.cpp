// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr Requirement documented(std::string_view id, std::string_view text,
                                 std::string_view source, std::string_view instead) {
  return {id, Level::kMust, text, source, Profiles::kDocumented, instead};
}

/// Where the document is silent and we had to choose.
constexpr Requirement chosen(std::string_view id, std::string_view text, std::string_view source,
                             std::string_view instead) {
  return {id, Level::kShould, text, source, Profiles::kDocumented, instead};
}

using enum ProgrammingStatus;

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

constexpr Case one(std::string_view rule, CaseBody run, Start start, Hazard hazard) {
  return from(start, hazard, rule, run);
}

constexpr Clause kDocumentedClauses[] = {
    chosen("morap.documented.other-kind",
           "A message of another kind than 0 and 1 makes the programming status 3.",
           "reference, contradiction 12", "morap.program.other-kind"),
    one(
        "Kind 2.",
        [](NodeBench& node) {
          expect_outcome(node,
                         "20 02 71 02 01 00 00 80 3F 01 00 00 80 3F 01 00 00 00 00 00 00 00 00 08",
                         kFailure);
        },
        kProgrammable, Hazard::kProgram),

    chosen("morap.documented.zero-rate",
           "A message with a rate of 0 makes the programming status 3.",
           "reference, contradiction 13", "morap.program.zero-rate"),
    one(
        "0 Hz.", [](NodeBench& node) { expect_of_zero_rate(node, kFailure); }, kFresh,
        Hazard::kProgram),

    documented("morap.documented.zero-pole", "A tuning message with a pole of 0 is refused.",
               "document: poles are negative; reference, contradiction 15", "morap.tune.zero-pole"),
    one(
        "0.",
        [](NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 00 00", kFailure); },
        kProgrammable, Hazard::kProgram),

    chosen("morap.documented.no-inertia", "A tuning message without inertia is refused.",
           "reference, contradiction 15", "morap.tune.no-inertia"),
    one(
        "0.",
        [](NodeBench& node) {
          node.needs_emulation();
          expect_outcome(node, "22 00 00 00 00 00 00 00 10 C1", kFailure);
        },
        kFresh, Hazard::kProgram),

    chosen("morap.documented.direct-voltage", "Identifier 4 does nothing.",
           "document: not listed; reference, contradiction 2", "morap.direct.no-current-limit"),
    one("0 V.", on<does_nothing<kDirectVoltage>>, Start::kDisabled, Hazard::kState),

    chosen("morap.documented.torque", "Identifier 5 does nothing.",
           "document: not listed; reference, contradiction 2", "morap.status.enabled-by-torque"),
    one("0 N m.", on<does_nothing<kTorque>>, Start::kDisabled, Hazard::kState),

    chosen("morap.documented.position-set", "Identifier 138 chooses nothing.",
           "document: not listed; reference, contradiction 2", "morap.read.position-default"),
    one("The status is chosen before.", on<chooses_nothing<kReadPositionSet>>, Start::kDisabled,
        Hazard::kState),

    chosen("morap.documented.speed-set", "Identifier 139 chooses nothing.",
           "document: not listed; reference, contradiction 2", "morap.read.speed-default"),
    one("The status is chosen before.", on<chooses_nothing<kReadSpeedSet>>, Start::kDisabled,
        Hazard::kState),

    documented("morap.documented.brake", "Identifier 15 shorts the leads of a disabled motor.",
               "document, brake; reference, contradiction 1", "morap.brake.no-effect"),
    one(
        "1.5 V, 0, 15.",
        [](NodeBench& node) {
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
        },
        kFree, Hazard::kMove),
};

}  // namespace

Chapter documented_chapter() { return chapter("Where the document differs", kDocumentedClauses); }

}  // namespace armjig::morap::conformance
