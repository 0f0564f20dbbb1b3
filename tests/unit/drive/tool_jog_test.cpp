// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/tool_jog.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <optional>
#include <string>

#include "emulators/parol6/arm.hpp"
#include "harness/arm/models.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/link/memory_stream.hpp"
#include "harness/motion/parol6/conversion.hpp"

namespace armjig::parol6::drive {
namespace {

using namespace planning;
using namespace std::chrono_literals;
using ::testing::HasSubstr;
using Ending = Activity::Ending;

/// A drive and an emulated arm on virtual time.
class ToolJogJig {
 public:
  ToolJogJig() {
    while (!drive.telemetry()) (void)loop.cycle();
  }

  void home() { (void)ending(*begin_home(drive)); }

  /// From standby, where the wrist is straight, to where the tool can move in every direction.
  void bend_wrist() {
    auto goal = drive.telemetry()->position;
    goal[4] = Steps{3200};
    JointSpeeds gentle;
    gentle.fill(StepsPerSecond{2000});
    (void)ending(*begin_go_to(drive, goal, gentle));
  }

  std::optional<Ending> ending(const std::unique_ptr<Activity>& activity) {
    const auto end = port.now() + 2min;
    while (port.now() < end && loop.cycle()) {
      if (auto ending = activity->step(drive, port.now(), drive.take_events())) return ending;
    }
    return std::nullopt;
  }

  [[nodiscard]] arm::Pose tool() const {
    return forward(arm::parol6_commander(), radians_of(drive.telemetry()->position));
  }

  MemoryStream<emulation::Arm> port{emulation::Arm{}};
  Drive drive;
  DriveLoop loop{port, drive};
};

constexpr CartesianJog kUp{JogFrame::kWorld, {.linear = {0, 0, 0.02}}};

TEST(ToolJog, MovesTheToolAlongAnAxisOfTheBaseForItsTime) {
  ToolJogJig jig;
  jig.home();
  const auto before = jig.tool();
  const auto ending = jig.ending(*begin_tool_jog(jig.drive, kUp, 1s));
  ASSERT_TRUE(ending && ending->is_success) << (ending ? ending->text : "");
  const auto way = jig.tool().position - before.position;
  // 20 mm/s for a second; speeds are whole steps/s, and the board counts from step to step.
  EXPECT_NEAR(way.z, 0.02, 0.0005);
  EXPECT_NEAR(way.x, 0, 0.0002);
  EXPECT_NEAR(way.y, 0, 0.0002);
  EXPECT_LT(to_degrees(angle_between(jig.tool().rotation, before.rotation)), 0.1);
}

TEST(ToolJog, TurnsTheToolAboutItsOwnAxisAndLeavesItsOriginWhereItIs) {
  ToolJogJig jig;
  jig.home();
  jig.bend_wrist();
  const auto before = jig.tool();
  const CartesianJog turn{JogFrame::kTool, {.angular = {0, 0, to_radians(10)}}};
  const auto ending = jig.ending(*begin_tool_jog(jig.drive, turn, 1s));
  ASSERT_TRUE(ending && ending->is_success) << (ending ? ending->text : "");
  const auto turned = rotation_vector(inverse(before.rotation) * jig.tool().rotation);
  EXPECT_NEAR(to_degrees(turned.z), 10, 0.2);
  EXPECT_NEAR(to_degrees(turned.x), 0, 0.1);
  EXPECT_NEAR(to_degrees(turned.y), 0, 0.1);
  EXPECT_LT(norm(jig.tool().position - before.position), 0.0005);
}

TEST(ToolJog, WithoutATimeGoesAsFarAsItCanAndStandsThere) {
  ToolJogJig jig;
  jig.home();
  const auto ending = jig.ending(*begin_tool_jog(jig.drive, kUp, std::nullopt));
  ASSERT_TRUE(ending);
  EXPECT_FALSE(ending->is_success);
  EXPECT_THAT(ending->text, HasSubstr("the tool is at"));
  const auto there = jig.drive.telemetry()->position;
  for (int i = 0; i < 50; ++i) (void)jig.loop.cycle();
  EXPECT_EQ(jig.drive.telemetry()->position, there);
}

TEST(ToolJog, NeedsAnArmThatWasHomed) {
  ToolJogJig jig;
  const auto before = jig.drive.telemetry()->position;
  const auto ending = jig.ending(*begin_tool_jog(jig.drive, kUp, 1s));
  ASSERT_TRUE(ending);
  EXPECT_FALSE(ending->is_success);
  EXPECT_THAT(ending->text, HasSubstr("not homed"));
  EXPECT_EQ(jig.drive.telemetry()->position, before);
}

}  // namespace
}  // namespace armjig::parol6::drive
