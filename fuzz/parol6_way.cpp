// SPDX-License-Identifier: Apache-2.0
// Any row of go-to set-points: it is judged the same whenever it begins, a joint that stays asks
// for nothing, and what is within the bounds leads nowhere out of them.
//
// Input: steps. A byte of choices: a pause in its low half, bit 7: the way ends here, else where
// one joint is led to follows, and how fast.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fuzz/input.hpp"
#include "fuzz/require.hpp"
#include "harness/wire/parol6/go_to_way.hpp"
#include "harness/wire/parol6/joint_bounds.hpp"
#include "harness/wire/parol6/joints.hpp"

namespace armjig::fuzz::parol6_way {
namespace {

using namespace parol6;
using namespace std::chrono_literals;

bool is_same(const std::vector<GoToWay::Excess>& one, const std::vector<GoToWay::Excess>& other) {
  if (one.size() != other.size()) return false;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (describe(one[i]) != describe(other[i]) || one[i].joint != other[i].joint) return false;
  }
  return true;
}

void check_places(const GoToWay& way, const CommandFrame& frame, const JointSteps& known) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& bounds = kJointBounds[j];
    const auto place = frame.position[j];
    const bool is_within = place >= bounds.lower && place <= bounds.upper;
    require(!is_within || !way.leads_out(j, bounds, place, known[j]),
            "what is within the bounds leads nowhere out of them");
  }
}

void check_joint(const Joint& joint, const JointBounds& bounds, Steps place, StepsPerSecond speed) {
  require(joint.position(joint.angle(place)) == place, "an angle is its place again");
  require(joint.speed(joint.speed(speed)) == speed, "so is a speed");
  require(!bounds.forbid(place, speed) || place <= bounds.lower || place >= bounds.upper,
          "within its bounds a joint may be driven");
}

void check_excess(const std::vector<GoToWay::Excess>& found, const CommandFrame& frame,
                  const CommandFrame& before, bool is_begin) {
  for (const auto& excess : found) {
    require(excess.joint < kJointCount, "it is a joint's");
    require(excess.since.has_value() != is_begin, "what begins a way has no set-point before");
    const auto j = excess.joint;
    require(
        is_begin || frame.position[j] != before.position[j] || frame.speed[j] != before.speed[j],
        "a joint that stays asks for nothing");
  }
}

void check_way(Input input) {
  constexpr auto kLater = 12'345ms;
  GoToWay way{of_joints(&Joint::max_speed)};
  auto later = way;
  auto known = kStandby;
  CommandFrame frame{.position = kStandby, .command = Command::kGoTo};
  Instant now{};
  for (bool is_begin = true; !input.is_empty();) {
    const auto choices = input.u8();
    now += (choices & 0x0F) * 3ms;
    if ((choices & 0x80) != 0) {
      way.end();
      later.end();
      is_begin = true;
      known = frame.position;
      continue;
    }
    const auto before = frame;
    const std::size_t joint = (choices >> 4) % kJointCount;
    frame.position[joint] = Steps{frame.position[joint].value + input.i16()};
    frame.speed[joint] = StepsPerSecond{input.i16()};
    check_places(way, frame, known);
    check_joint(kJoints[joint], kJointBounds[joint], frame.position[joint], frame.speed[joint]);
    const auto found = way.go_on(now, frame, known);
    require(is_same(found, later.go_on(now + kLater, frame, known)),
            "a way is judged the same whenever it begins");
    check_excess(found, frame, before, is_begin);
    require(way.stray(now, known) == later.stray(now + kLater, known), "so is who strays");
    is_begin = false;
  }
}

}  // namespace
}  // namespace armjig::fuzz::parol6_way

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::parol6_way::check_way(armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
