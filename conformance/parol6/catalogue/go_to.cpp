// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.goto.arrives", Level::kMust,
     "A go-to without commanded speeds ends exactly at its target and stays there.",
     "document, following law; firmware"},
    {"parol6.goto.own-joint", Level::kMust,
     "The position field of a joint is the target of that joint and of no other.",
     "document, packet table; firmware"},
    {"parol6.goto.all-together", Level::kMust, "In a go-to all joints run at once.", "firmware"},
    {"parol6.goto.signed", Level::kMust, "Targets are signed: a joint can be sent below 0.",
     "firmware"},
    {"parol6.goto.big-endian", Level::kMust, "Targets have 24 bits, most significant byte first.",
     "firmware"},
    {"parol6.goto.law", Level::kMust,
     "The speed of a go-to is the mean of the commanded speed and of 100 times the distance, "
     "halved toward zero, recomputed in every pass.",
     "firmware, vector B12, and the document's description"},
    {"parol6.goto.halved-toward-zero", Level::kMust,
     "At its target a joint with a commanded speed of 1 or -1 stands still.",
     "firmware: integer division cuts off toward zero"},
    {"parol6.goto.balance", Level::kMust,
     "A joint whose commanded speed leads away from its target rests where the two balance, a "
     "hundredth of that speed beyond.",
     "arithmetic: commanded speed + 100 * distance = 0"},
    {"parol6.goto.feed", Level::kMust,
     "A commanded speed along the way makes a go-to faster by its half.",
     "firmware, and the document's description"},
    {"parol6.goto.new-target", Level::kMust,
     "Another target on the way takes effect with its frame.", "firmware"},
    {"parol6.goto.no-overshoot", Level::kMust,
     "A go-to without commanded speeds does not go beyond its target.",
     "arithmetic: the last steps are made at 50 steps/s"},
    {"parol6.goto.last-steps", Level::kMust,
     "Near its target a joint takes its last step at 50 steps/s, 20 ms after the one before or "
     "later.",
     "firmware, vector B13"},
    {"parol6.goto.sticky", Level::kMust, "One frame of a go-to is enough to arrive.",
     "firmware: the last command byte is kept"},
    {"parol6.goto.stops", Level::kMust, "An idle frame stops a go-to where it is.", "firmware"},
    {"parol6.goto.keeps-homed", Level::kMust, "A go-to leaves the homed bits as they are.",
     "firmware"},
    {"parol6.goto.clamp", Level::kMust, "A go-to to a far target runs at 50,000 steps/s.",
     "firmware", Profiles::kFirmware, "parol6.goto.clamp-of-table"},
    {"parol6.goto.clamp-of-table", Level::kMust,
     "A go-to to a far target runs at the joint's maximum in the GUI's table.",
     "document: maxima of the GUI", Profiles::kDocumented, "parol6.goto.clamp"},
    {"parol6.goto.unlimited", Level::kMust,
     "A go-to drives a homed joint beyond its range without stopping.",
     "firmware: it knows no joint limits"},
};

}  // namespace

std::span<const Requirement> go_to_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
