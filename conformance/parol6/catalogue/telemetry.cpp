// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6 {
namespace {

constexpr std::array kRequirements{
    Requirement{"parol6.telemetry.layout", Level::kMust,
                "Telemetry is 60 bytes, FF FF FF 38, payload, check 212, 01 02, and its spare flag "
                "bits are ones.",
                "document, packet table; firmware"},
    Requirement{"parol6.telemetry.constants", Level::kMust,
                "What the shipped board never computes stays the same: timeout error 100, gripper "
                "id 0, gripper speed 1, object detection 1.",
                "firmware", Profiles::kFirmware},
    Requirement{"parol6.telemetry.echo", Level::kMust,
                "Telemetry repeats the command byte of the frame that it answers.", "firmware"},
    Requirement{"parol6.telemetry.timing", Level::kMust,
                "The timing field counts 703,125 Hz ticks since the frame before, modulo 65536; "
                "dropped frames do not count.",
                "document, timing; arithmetic: 90 MHz / 128"},
    Requirement{"parol6.telemetry.idle-speed", Level::kMust,
                "An idle frame sets the speeds that telemetry reports from the next frame on, "
                "signed, 24 bits, most significant byte first, at most 50,000, without motion.",
                "firmware: idle loads the set speed", Profiles::kFirmware},
    Requirement{"parol6.telemetry.outputs", Level::kMust,
                "The answer shows both outputs as its own frame set them.",
                "firmware: outputs are written before the answer is made"},
};

}  // namespace

std::span<const Requirement> telemetry_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6
