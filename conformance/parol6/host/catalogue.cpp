// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/parol6/host/check.hpp"
#include "conformance/parol6/host/occasions.hpp"
#include "conformance/program_checker.hpp"

namespace armjig::parol6::programs {
namespace {

constexpr std::array kRequirements{
    // Bytes.
    of_host("parol6.host.frame-length", Level::kMust, "A host sends frames of length 52 only.",
            "document, packet table"),
    of_host("parol6.host.frame-end", Level::kMust, "Every frame of a host ends with 01 02.",
            "document, end bytes; firmware: others are dropped without a word"),
    of_host("parol6.host.frame-whole", Level::kMust,
            "A host finishes the frame that it began before it begins another.",
            "firmware: a frame cut short takes the next one with it"),
    of_host("parol6.host.stray-start", Level::kMust,
            "No further FF stands directly in front of a frame.",
            "firmware: the third FF of the frame becomes a length of 255"),
    of_host(
        "parol6.host.stray-bytes", Level::kShould,
        "A host sends nothing between its frames but what resets a receiver: at least 256 equal "
        "bytes, perhaps with a frame of 255 zeros after them.",
        "document, packet table; firmware: a frame cut short takes the next one with it"),
    of_host(
        "parol6.host.frame-check", Level::kShould,
        "The check byte of a frame is 212, as in the document, or 228, as the known hosts send.",
        "document, check; GUI; Python API"),
    of_host("parol6.host.frame-prompt", Level::kShould,
            "The pieces of a frame come within the 10 ms of its period.",
            "arithmetic: the board acts on a frame with its last byte"),
    // Fields.
    of_host("parol6.host.known-codes", Level::kMust, "A host sends only codes that have a meaning.",
            "document, commands; firmware: others stop all joints"),
    of_host("parol6.host.no-demo", Level::kShould, "A host does not send code 69.",
            "firmware: it runs all joints, also while disabled, and is in no document"),
    of_host("parol6.host.spare-outputs", Level::kShould,
            "In in_out only OUT1 and OUT2 are ever set.", "firmware: the rest is ignored"),
    of_host("parol6.host.timeout", Level::kShould,
            "The timeout byte is 0 or more than the 10 ms between two frames.",
            "document, timeout: a shorter one stops the arm between frames"),
    of_host("parol6.host.gripper-id", Level::kMust, "The gripper id is at most 15.",
            "firmware: four bits are sent, and all eight compared with the answer"),
    of_host("parol6.host.gripper-position", Level::kMust, "A gripper position is from 0 to 255.",
            "firmware: the upper byte is lost"),
    of_host("parol6.host.gripper-speed", Level::kMust, "A gripper speed is from 0 to 255.",
            "firmware: the upper byte is lost"),
    of_host("parol6.host.gripper-current", Level::kShould,
            "A gripper current is from 0 to 1300 mA.", "document, gripper"),
    of_host("parol6.host.gripper-mode", Level::kMust, "The gripper mode is 0, 1 or 2.",
            "firmware: others send the set-points with every frame"),
    of_host("parol6.host.gripper-mode-once", Level::kMust,
            "A calibration or clear-error of the gripper stands in one frame only.",
            "firmware: each such frame starts it anew; GUI; Python API", occasion::kGripperMode),
    of_host("parol6.host.gripper-forgotten", Level::kMust,
            "Gripper set-points that change together with a calibration or clear-error change once "
            "more afterwards.",
            "firmware: they count as sent and never are", occasion::kGripperMode),
    of_host("parol6.host.gripper-clear-stopped", Level::kShould,
            "A clear-error of the gripper comes without the stop flag.",
            "gripper: with it the error is back at once", occasion::kGripperClear),
    of_host("parol6.host.gripper-calibrated", Level::kShould,
            "A gripper is sent to another position only once it says that it is calibrated.",
            "gripper: it does not move before", occasion::kGripperMove),
    of_host("parol6.host.gripper-activated", Level::kShould,
            "Another gripper position comes with the flags activate and go-to.",
            "gripper: it sleeps without them", occasion::kGripperMove),
    // Pace.
    of_host("parol6.host.rate-fast", Level::kShould, "A host sends at most 125 frames in a second.",
            "document: 100 Hz; firmware: answering takes the time of stepping", occasion::kSecond),
    of_host("parol6.host.rate-slow", Level::kShould,
            "A host that is there sends at least 80 frames in a second.", "document: 100 Hz",
            occasion::kSecond),
    of_host(
        "parol6.host.jitter", Level::kShould,
        "Of the frames of a second at most five come less than 5 ms or more than 15 ms after the "
        "one before.",
        "arithmetic: set-points of 10 ms, and a go-to law that closes the distance in 10 ms",
        occasion::kSecond),
    of_host("parol6.host.gap-in-motion", Level::kMust,
            "While it has joints move, a host leaves no more than 100 ms between two frames.",
            "firmware: nothing times out, and the emergency stop is only reported",
            occasion::kMotion),
    of_host("parol6.host.silent-in-motion", Level::kMust,
            "A host stops the joints before it falls silent.",
            "firmware: after the last frame of a jog it jogs for ever", occasion::kMotion),
    // Conduct.
    of_host("parol6.host.looks-first", Level::kMust,
            "A host moves nothing before it has seen telemetry.",
            "firmware: only telemetry tells of the emergency stop", occasion::kMove),
    of_host("parol6.host.overwritten", Level::kMust,
            "A frame that commands something is not followed by another command before the board "
            "could act on it.",
            "firmware: of frames in one pass only the last one acts", occasion::kCommand),
    of_host("parol6.host.move-disabled", Level::kMust,
            "A host homes, jogs or goes only while the board is enabled.",
            "firmware: it does nothing then, and clear error does not enable", occasion::kMove),
    of_host("parol6.host.go-to-unhomed", Level::kMust,
            "A host sends go-to only when all joints are homed.",
            "firmware: before, counters begin where the arm was switched on; Python API",
            occasion::kGoTo),
    of_host("parol6.host.home-held", Level::kMust,
            "A home command is given for at most a second; idle frames let it go on.",
            "firmware: held until the end it starts the next run", occasion::kHome),
    of_host("parol6.host.home-disturbed", Level::kMust,
            "While the arm homes, a host sends nothing but idle, home or disable.",
            "firmware: what ends homing leaves stages behind that spoil the next", occasion::kHome),
    of_host(
        "parol6.host.estop-disables", Level::kMust,
        "Within 100 ms of telemetry that shows the emergency stop pressed, a host sends disable.",
        "firmware: the stop is only reported; GUI; Python API", occasion::kEstop),
    of_host("parol6.host.estop-stays", Level::kMust,
            "While the emergency stop is pressed, a host that has disabled enables and moves "
            "nothing.",
            "firmware: the board would obey", occasion::kEstop),
    of_host("parol6.host.go-to-range", Level::kMust,
            "The positions of a go-to lie within the ranges of the joints, or on the way back into "
            "them.",
            "GUI; Python API; firmware: the board knows no limits", occasion::kHomedGoTo),
    of_host("parol6.host.go-to-pace", Level::kMust,
            "A go-to asks of no joint more speed than the known hosts do.",
            "GUI; Python API; arithmetic: the board closes the distance at 50 times it a second",
            occasion::kHomedGoTo),
    of_host("parol6.host.go-to-rest", Level::kShould,
            "A go-to that is held at one place has speed 0.",
            "arithmetic: it settles a hundredth of the speed beside its target", occasion::kGoTo),
    of_host("parol6.host.jog-pace", Level::kMust,
            "A jog asks of no joint more speed than the known hosts do.", "GUI; Python API",
            occasion::kJog),
    of_host("parol6.host.jog-bound", Level::kMust,
            "A homed joint at its bound is not jogged further out.",
            "GUI; firmware: the board knows no limits", occasion::kHomedJog),
    of_host("parol6.host.idle-speed", Level::kShould, "Idle frames have speeds of 0.",
            "firmware: others show up in telemetry as if joints moved"),
    of_host("parol6.host.no-effect", Level::kShould,
            "A jog or go-to that is held for half a second moves something, unless it is where it "
            "should be.",
            "arithmetic: a speed against the distance can cancel it", occasion::kMotion),
};

}  // namespace

std::span<const Requirement> host_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::programs
