// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/kinovazed/host/check.hpp"
#include "conformance/kinovazed/host/occasions.hpp"
#include "conformance/program_checker.hpp"

namespace armjig::kinovazed::programs {
namespace {

constexpr std::array kRequirements{
    // Lines.
    of_host("kinovazed.host.line-end", Level::kMust, "A client ends each line with CR LF.",
            "document, messages"),
    of_host("kinovazed.host.line-empty", Level::kMust,
            "A client sends no LF alone: an empty line has its CR.",
            "server, transcript T71: an LF that comes first takes the byte after it along"),
    of_host(
        "kinovazed.host.line-length", Level::kMust,
        "A line has fewer than 128 bytes in front of its LF.",
        "server; reference 2.12: after 128 the next line loses its first byte, and 1152 end the "
        "connection"),
    of_host("kinovazed.host.line-finished", Level::kMust,
            "A client finishes the line that it began before it leaves.",
            "server, transcript S1: what is left of it spoils the next client's first line"),
    of_host("kinovazed.host.line-ascii", Level::kMust,
            "Between two line ends stand printable ASCII bytes only.", "document: strictly ASCII"),
    of_host("kinovazed.host.bare-line", Level::kShould,
            "A line has no blanks around its pieces and no colon after the last one.",
            "server; reference 3.3: it forgives them in some places only"),
    of_host("kinovazed.host.known-words", Level::kMust,
            "A client sends only commands that the server has.",
            "document, commands; server: others are not even answered"),
    of_host("kinovazed.host.word-case", Level::kMust,
            "A client writes commands with the capitals that they have.",
            "document, commands; server, transcript T68"),
    of_host("kinovazed.host.argument-count", Level::kMust,
            "A command has as many arguments as belong to it.",
            "document, commands; server, transcripts T67 and T82"),
    of_host("kinovazed.host.mode-name", Level::kMust,
            "The argument of SetJoystickMode is one of the five modes.",
            "document, commands; reference 3.2", occasion::kMode),
    of_host("kinovazed.host.objective-name", Level::kMust,
            "An objective is named as the server has it.",
            "document, objectives; server, transcripts T49 and T50", occasion::kObjective),
    of_host("kinovazed.host.objective-documented", Level::kShould,
            "A client asks only for the seven objectives of the document.",
            "document, objectives; reference, contradiction C13", occasion::kObjective),
    of_host("kinovazed.host.number", Level::kMust,
            "A number is an integer: an optional sign, digits, and nothing else.",
            "server, transcripts T79 and T84: of 1.9 it takes the 1, of a word nothing",
            occasion::kJoystick),
    of_host("kinovazed.host.number-range", Level::kMust,
            "A number has at most 32 bits with its sign.", "server, transcript T86",
            occasion::kJoystick),
    of_host("kinovazed.host.deflection", Level::kShould,
            "A number of MoveJoystick is from -1000 to 1000.",
            "reference 8.2: 2.5 times the full deflection, and the server does not clamp",
            occasion::kJoystick),

    // Connections.
    of_host("kinovazed.host.one-connection", Level::kShould, "There is one connection at a time.",
            "server; reference 1.7: others wait unseen"),
    of_host("kinovazed.host.looks-first", Level::kShould,
            "On a new connection a client begins with EStop, or waits for a heartbeat.",
            "server, transcripts S4 and S5: states outlast connections, and events are lost in "
            "between"),
    of_host("kinovazed.host.silent-server", Level::kShould,
            "To a server that has said nothing for three seconds a client sends nothing but EStop.",
            "server; reference 11.2: a server that hangs keeps its connections",
            occasion::kSilence),
    of_host("kinovazed.host.leaves-answered", Level::kMust,
            "A client leaves only when its commands are answered.",
            "server, transcript S11: otherwise the server may never say anything again",
            occasion::kLeft),
    of_host("kinovazed.host.leaves-stick", Level::kMust,
            "A client lets the joystick go before it leaves.",
            "server, transcript S4: the arm would go on", occasion::kJoystickLeft),
    of_host("kinovazed.host.leaves-motion", Level::kShould,
            "A client leaves only when what it started is over.",
            "server, transcript S5: the arm goes on, and its event is lost", occasion::kLeft),

    // Pace.
    of_host(
        "kinovazed.host.one-at-a-time", Level::kShould,
        "A client waits for the answer to a command before the next one; EStop, a joystick that is "
        "let go, and a mode that ends an objective need not wait.",
        "server; reference 14.3: EStop waits for all that stands in front of it"),
    of_host("kinovazed.host.estop-once", Level::kShould,
            "A client sends no EStop while it waits for the answer to one.",
            "server; reference 1.18: thousands of them were worked off one by one",
            occasion::kEstop),
    of_host("kinovazed.host.stick-pace", Level::kShould,
            "A client sends at most 17 moves of the joystick in a second.",
            "server; reference 14.3: a real arm takes no more", occasion::kJoystick),

    // States.
    of_host(
        "kinovazed.host.initialize-first", Level::kMust,
        "From the emergency stop a client sends QuitEStop and Initialize, and nothing else before "
        "that.",
        "document, start-up; server, state table", occasion::kStop),
    of_host("kinovazed.host.sees-stop", Level::kMust,
            "A client that is shown an emergency stop that it did not ask for goes on as after its "
            "own.",
            "server, transcript S6: errors of the arm are told by the heartbeat only",
            occasion::kUnasked),
    of_host("kinovazed.host.waits-for-event", Level::kMust,
            "While the arm initializes, folds or unfolds a client sends nothing but EStop.",
            "document, interrupts; server, state table", occasion::kFold),
    of_host(
        "kinovazed.host.mode-settles", Level::kMust,
        "After SetJoystickMode a client waits for JoystickModeSet, unless it stops or retracts.",
        "document, interrupts; server, transcripts T30 and T31", occasion::kSettling),
    of_host("kinovazed.host.mode-pause", Level::kMust,
            "Between two joystick modes that steer lie 500 ms, whatever else comes between them.",
            "server, transcript S8: it hangs", occasion::kTwoModes),
    of_host(
        "kinovazed.host.stick-mode", Level::kMust,
        "A client moves the joystick only after JoystickModeSet, until something ends the mode.",
        "document, joystick; server, transcript T18; reference 6.6", occasion::kJoystick),
    of_host(
        "kinovazed.host.steering-exit", Level::kMust,
        "From a joystick mode a client goes to another mode or none, to an objective, to Freeze or "
        "EStop, and nowhere else.",
        "server, transcripts T28 and T29", occasion::kSteering),
    of_host("kinovazed.host.unfold-first", Level::kMust,
            "To a retracted arm a client sends Unfold, or EStop, before anything else.",
            "document, states; server, transcript T55", occasion::kRetracted),
    of_host("kinovazed.host.unfreeze-first", Level::kMust,
            "To a frozen arm a client sends Unfreeze, or EStop, before anything else.",
            "document, states; server, state table", occasion::kFreeze),
    of_host("kinovazed.host.nothing-to-undo", Level::kShould,
            "In idle there is nothing that Unfold, Unfreeze or QuitEStop could undo.",
            "server, transcripts T15 to T17", occasion::kIdle),

    // Objectives.
    of_host(
        "kinovazed.host.objective-runs", Level::kMust,
        "While an objective runs a client sends only EStop, SetJoystickMode or another objective.",
        "document, interrupts; server, state table", occasion::kRuns),
    of_host("kinovazed.host.objective-patience", Level::kShould,
            "A client ends an objective that runs for more than a minute.",
            "server; reference 9.2: one that cannot be reached runs for ever, and nobody is told",
            occasion::kRuns),
    of_host("kinovazed.host.active-objective", Level::kMust,
            "SetActiveObjective does not come while an objective runs.",
            "server, transcript S14: the arm goes on with the other one's points",
            occasion::kActiveObjective),
    of_host("kinovazed.host.chosen-objective", Level::kShould,
            "GetObjectivePosition comes only after an objective that was chosen or run.",
            "server, transcript T60: otherwise there is no such position",
            occasion::kObjectivePosition),
};

}  // namespace

std::span<const Requirement> host_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::programs
