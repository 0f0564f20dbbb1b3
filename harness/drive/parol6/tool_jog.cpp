// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/tool_jog.hpp"

#include <fmt/core.h>

#include <chrono>
#include <string>

#include "harness/arm/models.hpp"
#include "harness/arm/orientation.hpp"
#include "harness/drive/parol6/stillness.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::drive {
namespace {

using namespace planning;
using Ending = Activity::Ending;

/// In mm and degrees, as the vendor's program shows it.
std::string tool_place(const JointSteps& position) {
  const auto pose = forward(arm::parol6_commander(), radians_of(position));
  const auto angles = angles_of(pose.rotation, arm::Convention::kCommander);
  return fmt::format("the tool is at {:.3f} {:.3f} {:.3f} mm, {:.3f} {:.3f} {:.3f} deg",
                     1000 * pose.position.x, 1000 * pose.position.y, 1000 * pose.position.z,
                     to_degrees(angles.rx), to_degrees(angles.ry), to_degrees(angles.rz));
}

class ToolJog final : public Activity {
 public:
  ToolJog(const CartesianJog& jog, std::optional<Duration> time) : jog_{jog}, time_{time} {}

 private:
  std::optional<Ending> advance(Drive& drive, Instant now) override {
    const auto& frame = *drive.telemetry();
    if (!began_) {
      if (!is_homed(frame)) {
        drive.idle();
        return Ending{false, "not homed: nobody knows where the tool is"};
      }
      began_ = now;
    }
    if (!is_stopping_) move_on(drive, now);
    const bool stands = stillness_.observe(now, frame.position) >= kToStand;
    if (!is_stopping_ || !stands) return std::nullopt;
    const auto place = tool_place(frame.position);
    return obstacle_.empty() ? Ending{true, place} : Ending{false, obstacle_ + "; " + place};
  }

  /// The next frame's speeds, or the beginning of the end.
  void move_on(Drive& drive, Instant now) {
    const bool is_over = time_ && now - *began_ >= *time_;
    const auto speeds = jogger_.speeds(jog_, drive.telemetry()->position);
    // A latched stop has ended this activity before.
    if (!is_over && speeds && drive.jog(*speeds)) return;
    if (!is_over && !speeds) obstacle_ = words_for(speeds.error(), now);
    is_stopping_ = true;
    drive.idle();
    stillness_ = {};
  }

  [[nodiscard]] std::string words_for(Refusal refusal, Instant now) const {
    refusal.time = std::chrono::duration<double>{now - *began_}.count();
    return describe(refusal);
  }

  CartesianJogger jogger_;
  CartesianJog jog_;
  std::optional<Duration> time_;
  std::optional<Instant> began_;
  bool is_stopping_ = false;
  std::string obstacle_;  ///< why it ends before its time
  Stillness<JointSteps> stillness_;
};

}  // namespace

Result<std::unique_ptr<Activity>> begin_tool_jog(Drive& drive, const CartesianJog& jog,
                                                 std::optional<Duration> time) {
  if (const auto asked = drive.jog({}); !asked) return tl::unexpected{asked.error()};
  return std::make_unique<ToolJog>(jog, time);
}

}  // namespace armjig::parol6::drive
