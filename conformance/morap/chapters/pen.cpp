// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/chapters.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr std::string_view kUnseen = "the pen answers nothing, and the suite has a node, not a pen";

constexpr Requirement pen(std::string_view id, Level level, std::string_view text,
                          std::string_view source) {
  return {.id = id, .level = level, .text = text, .source = source, .unobservable = kUnseen};
}

constexpr Clause kPenClauses[] = {
    pen("morap.pen.address", Level::kMust, "The pen acknowledges address 19.",
        "reference, pen; recording bus-nodes-and-pen"),

    pen("morap.pen.at-boot", Level::kMust, "At power-on the pen is retracted, at 45 degrees.",
        "vector P1"),

    pen("morap.pen.deploy", Level::kMust, "Command 1 deploys the pen, to 8 degrees.", "vector P2"),

    pen("morap.pen.retract", Level::kMust, "Command 2 retracts the pen, to 45 degrees.",
        "vector P3"),

    pen("morap.pen.position", Level::kMust,
        "Command 7 with a byte sets an angle between, 45 for 0 and 8 for 255, cut towards 45.",
        "vector P4; recording pen-set-position"),

    pen("morap.pen.position-missing", Level::kMust, "Command 7 without a byte retracts the pen.",
        "vector P5"),

    pen("morap.pen.unknown", Level::kMust, "Any other command retracts the pen.", "vector P6"),

    pen("morap.pen.poke", Level::kMust, "A write of nothing leaves the pen where it is.",
        "vector P7"),

    pen("morap.pen.buttons", Level::kMust,
        "While a button is held it wins over the bus; they are looked at every 50 ms.",
        "recording pen-buttons"),
};

}  // namespace

Chapter pen_chapter() { return chapter("Pen", kPenClauses); }

}  // namespace armjig::morap::conformance
