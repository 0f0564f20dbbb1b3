// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/morap/host/check.hpp"
#include "conformance/morap/host/occasions.hpp"
#include "conformance/program_checker.hpp"

namespace armjig::morap::programs {
namespace {

constexpr std::array kRequirements{
    // Writes.
    of_host("morap.host.addresses", Level::kShould,
            "A master writes to addresses 10 to 17 as to nodes and to no others up to 1F but the "
            "pen's.",
            "document, addresses; reference, contradiction 3", occasion::kNode),
    of_host("morap.host.known-ids", Level::kMust,
            "A master sends only identifiers that have a meaning.", "document, commands",
            occasion::kNode),
    of_host("morap.host.whole-command", Level::kMust,
            "A master sends all bytes of a command in one write.", "firmware, writing",
            occasion::kNode),
    of_host("morap.host.overlong-number", Level::kMust,
            "A master sends no more than four bytes after an identifier with a number.",
            "firmware: they are written over other memory", occasion::kNumber),
    of_host("morap.host.surplus", Level::kShould,
            "A master sends nothing after a complete command.", "document: one write, one command",
            occasion::kNode),
    of_host("morap.host.no-brake", Level::kShould,
            "A master does not rely on identifiers 14 and 15.", "reference, contradiction 1",
            occasion::kNode),
    of_host("morap.host.no-direct-voltage", Level::kShould,
            "A master drives with identifier 3 and not with 4, which limits no current.",
            "reference, section 12.1", occasion::kNumber),
    of_host("morap.host.finite", Level::kMust, "References and angles of a master are numbers.",
            "reference, section 12.1", occasion::kNumber),
    of_host("morap.host.voltage", Level::kShould, "A master asks for no more than 20 V.",
            "reference, section 12.2", occasion::kNumber),
    // Calibration.
    of_host("morap.host.calibrates-first", Level::kMust,
            "A master calibrates a node before it sends a reference.",
            "document; firmware: it would start with the calibration", occasion::kReference),
    of_host("morap.host.calibrates-disabled", Level::kMust,
            "A master disables a node before it calibrates it.",
            "reference, commands: the voltage bursts", occasion::kCalibration),
    of_host("morap.host.ends-disabled", Level::kShould,
            "At the end of a session no node is left enabled.",
            "reference, applications: all end with 31 or 0", occasion::kReference),
    // Parameters.
    of_host("morap.host.checksum", Level::kMust, "The checksum of a parameter message is right.",
            "document, checksum", occasion::kSet),
    of_host("morap.host.counts", Level::kMust,
            "A parameter message has one to four coefficients of each.",
            "reference, section 12.2: running with none corrupts memory", occasion::kSet),
    of_host("morap.host.kind", Level::kMust, "The kind of a parameter message is 0 or 1.",
            "document, programming", occasion::kSet),
    of_host("morap.host.rate", Level::kMust, "The rate of a parameter message is 1 to 1500 Hz.",
            "reference, section 12.2", occasion::kSet),
    of_host("morap.host.coefficients", Level::kMust,
            "The coefficients of a parameter message are numbers.", "reference, section 12.1",
            occasion::kSet),
    of_host("morap.host.program-pause", Level::kMust,
            "Between two messages that change parameters a master waits for 10 ms.",
            "reference, parser: the second overwrites the first", occasion::kTwoPrograms),
    of_host("morap.host.program-status", Level::kShould,
            "A master reads the programming status before it enables a node that it programmed.",
            "document, programming; reference, section 12.2", occasion::kProgram),
    of_host("morap.host.tune-kind", Level::kMust, "The kind of a tuning message is 0, 1 or 2.",
            "document, tuning", occasion::kTuning),
    of_host("morap.host.tune-inertia", Level::kMust,
            "The inertia of a tuning message is above 0 and at most 10.",
            "reference, tuner; contradiction 15", occasion::kTuning),
    of_host("morap.host.tune-pole", Level::kMust,
            "The pole of a tuning message is at least -200 and below 0.",
            "document, tuning; reference, tuner", occasion::kTuning),
    // Reads.
    of_host("morap.host.read-size", Level::kShould,
            "A master reads no more bytes than the chosen value has.",
            "reference, contradiction 6: what follows is other memory", occasion::kRead),
    // The pen.
    of_host("morap.host.pen-commands", Level::kMust, "A master sends the pen only 1, 2 and 7.",
            "reference, pen: others retract", occasion::kPen),
    of_host("morap.host.pen-surplus", Level::kMust,
            "A master sends the pen no byte that a command does not need.",
            "reference, pen: it hangs", occasion::kPen),
    of_host("morap.host.pen-pause", Level::kShould,
            "A master leaves 25 ms between two commands to the pen.", "reference, pen",
            occasion::kTwoPens),
    of_host("morap.host.pen-read", Level::kMust, "A master does not read from the pen.",
            "reference, pen: it may hold the clock for ever", occasion::kPen),
};

}  // namespace

std::span<const Requirement> host_requirements() noexcept { return kRequirements; }

}  // namespace armjig::morap::programs
