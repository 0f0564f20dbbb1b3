// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.telemetry.outputs", Level::kMust,
     "The answer shows both outputs as its own frame set them.",
     "firmware: outputs are written before the answer is made"},
    {"parol6.io.output-bits", Level::kMust,
     "OUT1 is bit 20 and OUT2 bit 10, in commands and in telemetry, and neither sets the other.",
     "document, packet tables; firmware"},
    {"parol6.io.other-bits", Level::kMust,
     "The other bits of in_out set nothing: IN1, IN2 and the stop come from pins.",
     "firmware: only OUT1 and OUT2 are used"},
    {"parol6.io.outputs-always", Level::kMust,
     "Outputs follow every frame, whatever its command, also while the board is disabled.",
     "firmware: they are written when a frame is accepted"},
    {"parol6.io.outputs-moving", Level::kMust,
     "Outputs follow every frame while joints move, and their change does not disturb the motion.",
     "firmware: they are written when a frame is accepted"},
    {"parol6.io.sampled", Level::kMust,
     "IN1, IN2 and the emergency stop are the levels at the moment when the frame is accepted.",
     "firmware: pins are read when a frame is accepted"},
    {"parol6.io.in1-bit", Level::kMust, "IN1 is bit 80 of io, 1 when it is high.",
     "document, packet table; firmware, vector F10"},
    {"parol6.io.in2-bit", Level::kMust, "IN2 is bit 40 of io, 1 when it is high.",
     "document, packet table; firmware, vector F10"},
    {"parol6.io.estop-bit", Level::kMust,
     "The emergency stop is bit 08 of io: 1 is released, 0 pressed.",
     "document, packet table; firmware, vector F10"},
    {"parol6.io.inputs-always", Level::kMust,
     "Inputs are shown in every answer, whatever the command, also while the board is disabled.",
     "firmware: pins are read when a frame is accepted"},
    {"parol6.io.estop-reported", Level::kMust,
     "A pressed emergency stop is reported and stops no joint.", "firmware", Profiles::kFirmware,
     "parol6.io.estop-disables"},
    {"parol6.io.estop-disables", Level::kMust,
     "A pressed emergency stop stops all joints and disables the board.",
     "document: the stop is a safety function", Profiles::kDocumented, "parol6.io.estop-reported"},
    {"parol6.io.estop-ignored-by-enable", Level::kMust,
     "The board can be enabled while the emergency stop is pressed.", "firmware",
     Profiles::kFirmware, "parol6.io.estop-holds"},
    {"parol6.io.estop-holds", Level::kMust,
     "Nothing enables the board while the emergency stop is pressed.",
     "document: the stop is a safety function", Profiles::kDocumented,
     "parol6.io.estop-ignored-by-enable"},
    {"parol6.io.estop-ignored-by-homing", Level::kMust,
     "Homing goes on while the emergency stop is pressed.", "firmware", Profiles::kFirmware,
     "parol6.io.estop-ends-homing"},
    {"parol6.io.estop-ends-homing", Level::kMust,
     "A pressed emergency stop ends homing, and releasing it does not resume it.",
     "document: the stop is a safety function", Profiles::kDocumented,
     "parol6.io.estop-ignored-by-homing"},
    {"parol6.io.estop-released-stays-disabled", Level::kMust,
     "Releasing the emergency stop does not enable the board by itself.",
     "document: the user has to enable again", Profiles::kDocumented, "parol6.io.estop-reported"},
};

}  // namespace

std::span<const Requirement> io_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
