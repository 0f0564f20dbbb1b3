// SPDX-License-Identifier: Apache-2.0
#include "cli/record_judge.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "cli/fuzz_material.hpp"
#include "harness/rig/judge.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;
using parol6::Command;
using parol6::CommandFrame;
using parol6::TelemetryFrame;
using Records = std::vector<KeptRecord>;

constexpr std::array kMiddle{Steps{0}, Steps{-30000}, Steps{60000},
                             Steps{0}, Steps{0},      Steps{32000}};

template <class Frame>
KeptRecord record_of(const Frame& frame, Direction direction, Duration time) {
  const auto bytes = encode(frame);
  return {.time = Instant{time},
          .kind = LinkKind::kStream,
          .direction = direction,
          .bytes = {bytes.begin(), bytes.end()}};
}
KeptRecord sent(Command command, Duration time) {
  return record_of(CommandFrame{.position = kMiddle, .command = command}, Direction::kToDevice,
                   time);
}
KeptRecord said(std::uint8_t homed, Duration time,
                std::uint8_t io = parol6::io_flag::kEstopReleased) {
  return record_of(TelemetryFrame{.position = kMiddle, .homed = homed, .io = io},
                   Direction::kFromDevice, time);
}

Records left_of(Records script, const Records& answers) {
  RecordJudge{parol6::rig::make_judge}.leave_out_refused(script, answers, Permissions::all());
  return script;
}

TEST(RecordJudge, LeavesOutWhatIsRefusedAtThatMoment) {
  const Records script{sent(Command::kGoTo, 10ms), sent(Command::kIdle, 20ms),
                       sent(Command::kGoTo, 40ms)};
  EXPECT_EQ(left_of(script, {said(0xFF, 5ms)}), script);
  EXPECT_EQ(left_of(script, {said(0x03, 5ms)}), Records{script[1]});
  EXPECT_EQ(left_of(script, {said(0x03, 5ms), said(0xFF, 30ms)}), (Records{script[1], script[2]}));
}

TEST(RecordJudge, LeavesOutAllThatFollowsIfTheDeviceWereStopped) {
  constexpr std::uint8_t kPressed = 0;
  const Records script{sent(Command::kGoTo, 10ms), sent(Command::kIdle, 20ms),
                       sent(Command::kIdle, 30ms)};
  const auto left = left_of(script, {said(0xFF, 5ms), said(0xFF, 15ms, kPressed)});
  EXPECT_TRUE(left == Records{script[0]}) << left.size();
}

/// Refuses every message because of where the device is, and tells how much it heard.
class AtABound final : public OneStopJudge {
 public:
  static inline int times_heard = 0;

  std::optional<Refusal> judge(Messages /*messages*/, const Permissions& /*granted*/) override {
    return Refusal{.cause = Refusal::Cause::kDevice};
  }
  void observe(Bytes /*bytes*/) override { ++times_heard; }
  [[nodiscard]] bool may_be_moving() const override { return false; }
};

TEST(RecordJudge, HearsOnABusWhatMayDependOnWhereTheDeviceIs) {
  RecordJudge judge{[]() -> std::unique_ptr<Judge> { return std::make_unique<AtABound>(); }};
  const KeptRecord write{.kind = LinkKind::kBus,
                         .direction = Direction::kToDevice,
                         .id = 0x10,
                         .bytes = {std::byte{1}}};
  AtABound::times_heard = 0;
  EXPECT_FALSE(judge.refusal_of(write, Permissions::all()));
  EXPECT_EQ(AtABound::times_heard, 1);
}

/// What a live board has when it was started: a go-to needs a homed arm, and homing takes long.
TEST(RecordJudge, KnowsOfACaseWhereItLeadsASoundDevice) {
  const auto& device = **find_device(shipped_devices(), "parol6");
  RigOptions live;
  live.target = parse_target("pty:/tmp/nowhere").value();
  live.permissions = Permissions::all();
  RigOptions model;
  model.target = parse_target("emulated:?profile=firmware").value();
  const auto material = material_of(device, live, model, 60s).value();
  const auto homing_for = [](Duration time) {
    campaign::Script script{sent(Command::kEnable, 10ms), sent(Command::kHome, 20ms)};
    for (auto at = 30ms; at < time; at += 10ms) script.push_back(sent(Command::kIdle, at));
    return script;
  };
  const auto with_go_to = [&](campaign::Script script) {
    const auto last = material.rehearse(script).back().bytes;
    const auto body = Bytes{last}.first<parol6::kTelemetryFrameSize>();
    const CommandFrame frame{.position = parol6::decode_telemetry(parol6::body_of(body)).position,
                             .command = Command::kGoTo};
    const auto time = script.back().time.time_since_epoch() + 10ms;
    script.push_back(record_of(frame, Direction::kToDevice, time));
    return script;
  };
  auto too_soon = with_go_to(homing_for(1s));
  auto homed = with_go_to(homing_for(40s));
  const auto whole = homed;
  material.permit_case(too_soon);
  material.permit_case(homed);
  EXPECT_TRUE(too_soon == homing_for(1s)) << too_soon.size();
  EXPECT_TRUE(homed == whole) << homed.size();
}

}  // namespace
}  // namespace armjig::cli
