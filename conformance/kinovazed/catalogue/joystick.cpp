// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.mode.settles", Level::kMust,
     "JoystickModeSet comes half a second behind a mode that moves.",
     "server, recording session-joystick-modes"},
    {"kinovazed.mode.no-mode", Level::kMust,
     "NoMode is confirmed at once and leads from steering to idle.", "server, transcript T22"},
    {"kinovazed.mode.no-mode-idle", Level::kMust,
     "NoMode in idle is confirmed at once, and idle stays.", "server, transcript T21"},
    {"kinovazed.mode.xyz", Level::kMust, "Mode XYZ can be set and steered in.",
     "document; server, recording session-joystick-modes"},
    {"kinovazed.mode.rotation", Level::kMust, "Mode Rotation can be set and steered in.",
     "document; server, recording session-joystick-modes"},
    {"kinovazed.mode.axis1to3", Level::kMust, "Mode Axis1to3 can be set and steered in.",
     "document; server, recording session-joystick-modes"},
    {"kinovazed.mode.axis4to6", Level::kMust, "Mode Axis4to6 can be set and steered in.",
     "document; server, recording session-joystick-modes"},
    {"kinovazed.mode.chain", Level::kMust,
     "From steering another mode can be set without leaving it first.", "server, transcript T24"},
    {"kinovazed.joystick.gate", Level::kMust, "Behind NoMode moves are Rejected.",
     "server, recording joystick-mode-gate"},
    {"kinovazed.joystick.behind-freeze", Level::kMust,
     "Behind Freeze and Unfreeze moves are Rejected until a mode is set again.",
     "server; reference 6.6"},
    {"kinovazed.joystick.behind-objective", Level::kMust,
     "Behind an objective moves are Rejected until a mode is set again.", "server, transcript T42"},
    {"kinovazed.joystick.any-number", Level::kMust,
     "Moves by any number of 32 bits are Accepted in steering.", "server, transcript T87"},
    {"kinovazed.joystick.stream", Level::kMust, "A stream of moves is answered move by move.",
     "server, transcript T27"},
    {"kinovazed.joystick.holds", Level::kMust, "A deflection moves the arm until the next one.",
     "server; reference 8.2"},
    {"kinovazed.joystick.client-lost", Level::kMust,
     "A deflection moves the arm on when its client has left.", "server, transcript S4"},
    {"kinovazed.joystick.scale", Level::kMust,
     "Numbers are taken times 0.0025, x and y negated, and not clamped; 400 is full "
     "deflection.",
     "server; reference 8.1", Profiles::kBoth, "", Role::kDevice,
     "no message tells where the arm is or how fast"},
    {"kinovazed.joystick.bounds", Level::kMust,
     "A deflection in x or y that leads beyond 0.79 or 0.84 m counts as 0, in every mode, by the "
     "last pose "
     "inside the workspace; the reply stays Accepted.",
     "server, transcript S17", Profiles::kBoth, "", Role::kDevice,
     "no message tells where the arm is"},
    {"kinovazed.joystick.int-min", Level::kMust, "The most negative number is not negated.",
     "server; reference 8.1", Profiles::kFirmware, "", Role::kDevice,
     "no message tells where the arm is"},
    {"kinovazed.mode.guard", Level::kMust,
     "A mode that is written within 500 ms of another one, by way of EStop, hangs the "
     "server.",
     "server, recording defect-mode-change-too-soon", Profiles::kFirmware,
     "kinovazed.mode.no-guard"},
    {"kinovazed.mode.no-guard", Level::kShould,
     "A mode that is written within 500 ms of another one, by way of EStop, is set like "
     "any other.",
     "document is silent; our choice", Profiles::kDocumented, "kinovazed.mode.guard"},
    {"kinovazed.mode.late-enough", Level::kMust,
     "The same way with more than 500 ms between the two modes is harmless.",
     "server, recording defect-mode-change-late-enough"},
};

}  // namespace

std::span<const Requirement> joystick_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
