// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr auto kHidden = "the CAN between board and gripper cannot be seen on the serial link";

constexpr Requirement kRequirements[] = {
    {"parol6.gripper.before-answer", Level::kMust,
     "Before the gripper's first answer telemetry has gripper position 0, current 2 mA, status 01.",
     "firmware"},
    {"parol6.gripper.latest", Level::kMust,
     "Telemetry shows what the gripper answered to the frame before.",
     "firmware: every frame asks the gripper"},
    {"parol6.gripper.follows", Level::kMust,
     "Set-points in mode 0 move a calibrated gripper to their position, and telemetry shows it "
     "there.",
     "document, gripper; firmware; gripper"},
    {"parol6.gripper.position-map", Level::kMust,
     "Position bytes 0 to 255 map linearly to the way from open to closed, and the answer maps "
     "back.",
     "gripper"},
    {"parol6.gripper.status-bits", Level::kMust,
     "The status shows activated, go-to and calibrated in bits 80, 40 and 01.",
     "gripper, passed through by the firmware"},
    {"parol6.gripper.calibrates", Level::kMust,
     "Mode 1 calibrates the gripper, which the status shows at the end.",
     "document, gripper; firmware; gripper"},
    {"parol6.gripper.idle-until-changed", Level::kMust,
     "After calibration or clear-error the gripper stands until a set-point changes.",
     "gripper and firmware: unchanged set-points are only polls"},
    {"parol6.gripper.change-of-position", Level::kMust,
     "A changed gripper position sends the set-points.", "firmware"},
    {"parol6.gripper.change-of-speed", Level::kMust,
     "A changed gripper speed sends the set-points.", "firmware"},
    {"parol6.gripper.change-of-current", Level::kMust,
     "A changed gripper current sends the set-points.", "firmware"},
    {"parol6.gripper.change-of-command", Level::kMust,
     "A changed gripper command byte sends the set-points.", "firmware"},
    {"parol6.gripper.clear-mode", Level::kMust, "Mode 2 takes the stop error of the gripper back.",
     "document, gripper; firmware; gripper"},
    {"parol6.gripper.other-modes", Level::kMust,
     "Modes from 3 on send the set-points with every frame, also unchanged ones.", "firmware"},
    {"parol6.gripper.forgotten-set-point", Level::kMust,
     "Set-points that arrive together with a calibration or a clear-error count as sent although "
     "they were not.",
     "firmware, vector G3", Profiles::kFirmware, "parol6.gripper.remembered-set-point"},
    {"parol6.gripper.remembered-set-point", Level::kShould,
     "Set-points that arrive together with a calibration or a clear-error are sent with the next "
     "frame in mode 0.",
     "document is silent; our choice", Profiles::kDocumented, "parol6.gripper.forgotten-set-point"},
    {"parol6.gripper.position-low-byte", Level::kMust,
     "The low byte of the gripper position goes to the gripper: 300 is 44.", "firmware"},
    {"parol6.gripper.speed-low-byte", Level::kMust,
     "The low byte of the gripper speed goes to the gripper: 256 is 0.", "firmware"},
    {"parol6.gripper.speed-map", Level::kMust,
     "Speed byte b means b * 79960 / 255 + 40 counts/s, in integers.", "gripper"},
    {"parol6.gripper.current-whole", Level::kMust,
     "Both bytes of the gripper current go to the gripper.", "firmware"},
    {"parol6.gripper.current-signed", Level::kMust,
     "The gripper's current is shown as it was answered, signed: negative while it closes.",
     "firmware; gripper"},
    {"parol6.gripper.current-any", Level::kMust, "A current beyond 1300 mA is passed on.",
     "firmware", Profiles::kFirmware, "parol6.gripper.current-range"},
    {"parol6.gripper.current-range", Level::kMust,
     "A commanded current beyond 0 to 1300 mA is passed on as the nearest of the two.",
     "document, gripper", Profiles::kDocumented, "parol6.gripper.current-any"},
    {"parol6.gripper.whose-answer", Level::kMust,
     "Only an answer from the node of the latched frame is taken; an id above 15 never matches.",
     "firmware, vector G1"},
    {"parol6.gripper.id-low-bits", Level::kMust,
     "Of the gripper id the low four bits say who is asked: 16 moves node 0.",
     "firmware, vector G1"},
    {"parol6.gripper.other-node", Level::kMust,
     "Set-points for another node do not move the gripper, and telemetry keeps what it showed.",
     "firmware, vector G2"},
    {"parol6.gripper.while-disabled", Level::kMust,
     "Set-points reach the gripper also while the board is disabled.",
     "firmware: sent when a frame is accepted"},
    {"parol6.gripper.any-code", Level::kMust,
     "Set-points reach the gripper whatever the command of their frame is.",
     "firmware: sent when a frame is accepted"},
    {"parol6.gripper.while-moving", Level::kMust,
     "Set-points reach the gripper while joints jog, go or home, and do not disturb them.",
     "firmware: sent when a frame is accepted"},
    {"parol6.gripper.moves-when", Level::kMust,
     "The gripper moves only if activated, told to go and calibrated.", "gripper"},
    {"parol6.gripper.object-code", Level::kMust,
     "An object that stops the closing gripper is object 1, with the low bit in 20; on the way it "
     "is 0, at the position 3.",
     "gripper; drives before 2025-09-29 have 1 and 2 the other way round"},
    {"parol6.gripper.stop", Level::kMust,
     "The stop flag stops the gripper and latches the stop error in status bit 02.", "gripper"},
    {"parol6.gripper.clear-error", Level::kMust,
     "Clear-error ends a calibration and leaves the drive idle.", "gripper"},
    {"parol6.gripper.one-frame", Level::kMust,
     "Each accepted serial frame sends exactly one CAN frame, chosen by mode and by whether "
     "anything changed.",
     "firmware", Profiles::kBoth, "", Role::kDevice, kHidden},
    {"parol6.gripper.calibration", Level::kMust,
     "Calibration opens with 500 mA at speed byte 40 until velocity is at most 700 counts/s and "
     "the current within 90 mA of 500 for 3200 interrupts, waits 20 ms, closes the same way, and "
     "is given up after 150,000 interrupts; after it the drive is idle.",
     "gripper", Profiles::kBoth, "", Role::kDevice, kHidden},
};

}  // namespace

std::span<const Requirement> gripper_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
