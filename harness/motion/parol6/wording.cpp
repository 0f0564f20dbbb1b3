// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/planner.hpp"

namespace armjig::parol6::planning {
namespace {

std::string name_of(const Refusal& refusal) {
  return refusal.joint ? fmt::format("j{}", *refusal.joint + 1) : "a joint";
}

/// A move whose target is wrong is so before it begins.
std::string moment(double time) { return time > 0 ? fmt::format(" at {:.2f} s", time) : ""; }

std::string_view place_of(SingularityNote::Kind kind) noexcept {
  switch (kind) {
    case SingularityNote::Kind::kShoulder:
      return "the wrist is above the base's axis";
    case SingularityNote::Kind::kElbow:
      return "the elbow is stretched or folded";
    case SingularityNote::Kind::kWrist:
      return "axes 4 and 6 are in line";
  }
  return {};
}

}  // namespace

std::string describe(const Refusal& refusal) {
  const auto [reason, joint, value, limit, time] = refusal;
  switch (reason) {
    case Refusal::Reason::kOutOfLimits:
      return fmt::format("{} would be at {:.3f} deg{}, its range ends at {:.3f} deg",
                         name_of(refusal), value, moment(time), limit);
    case Refusal::Reason::kTooFast:
      return fmt::format("{} would need {:.0f} steps/s{}, it can do {:.0f}", name_of(refusal),
                         value, moment(time), limit);
    case Refusal::Reason::kTooMuchAcceleration:
      return fmt::format("{} would need {:.0f} steps/s^2, it can do {:.0f}", name_of(refusal),
                         value, limit);
    case Refusal::Reason::kUnreachable:
      return fmt::format("no posture reaches the pose{}", moment(time));
    case Refusal::Reason::kSingular:
      if (!joint) return "near a singularity the tool cannot move that way";
      return fmt::format("near a singularity {} would leap at {:.2f} s", name_of(refusal), time);
    case Refusal::Reason::kNotConverged:
      return fmt::format("the commander's inverse kinematics does not converge at {:.2f} s", time);
    case Refusal::Reason::kSignFlip:
      return fmt::format("{} would change its sign at {:.2f} s, at which the commander stops",
                         name_of(refusal), time);
    case Refusal::Reason::kImpossibleDuration:
      return fmt::format("a move cannot take {} s", value);
    case Refusal::Reason::kPercentOutOfRange:
      return fmt::format("{} is not between 0 and 100 %", value);
    case Refusal::Reason::kBeyondFrame:
      return fmt::format("{} would be told more{} than the 24 bits of a frame hold",
                         name_of(refusal), moment(time));
    case Refusal::Reason::kNoTurn:
      return "the commander would turn the tool once round to where it is, and loses its "
             "orientation on the way";
  }
  return {};
}

std::string describe(const SingularityNote& note) {
  return fmt::format(
      "singular at {:.2f} s: {}, joints {:.2f} {:.2f} {:.2f} {:.2f} {:.2f} {:.2f} deg", note.time,
      place_of(note.kind), to_degrees(note.joints[0]), to_degrees(note.joints[1]),
      to_degrees(note.joints[2]), to_degrees(note.joints[3]), to_degrees(note.joints[4]),
      to_degrees(note.joints[5]));
}

}  // namespace armjig::parol6::planning
