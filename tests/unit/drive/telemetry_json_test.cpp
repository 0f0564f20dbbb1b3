// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/telemetry_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/report/validity.hpp"

namespace armjig::parol6::drive {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

constexpr auto kSchema = "docs/schemas/telemetry.schema.json";

/// A homed arm with IN1 high and a closed gripper, as in section 1.6 of the reference.
const TelemetryFrame kFrame{
    .position = {Steps{10242}, Steps{-32002}, Steps{57907}, Steps{0}, Steps{0}, Steps{31998}},
    .speed = {StepsPerSecond{1500}},
    .homed = 0xFF,
    .io = 0x8F,
    .temperature_error = 0x03,
    .position_error = 0x03,
    .timing = 7032,
    .timeout_error = 100,
    .echo = Command::kIdle,
    .gripper = {.position = 119, .speed = 1, .current = Milliamperes{-200}, .status = 0xE1}};

TEST(TelemetryJson, HasAllOfAFrame) {
  const auto json = Json::parse(to_json(at(1234567ns), kFrame, {}));
  EXPECT_EQ(json["schema"], "armjig.telemetry/1");
  EXPECT_EQ(json["t_us"], 1234);
  EXPECT_EQ(json["joints"][0], Json::parse(R"({"position_steps": 10242, "position_deg": 90.017578,
      "speed_steps_s": 1500, "speed_deg_s": 13.183594, "homed": true})"));
  EXPECT_EQ(json["inputs"]["in1"], true);
  EXPECT_EQ(json["outputs"]["out1"], false);
  EXPECT_EQ(json["estop_pressed"], false);
  EXPECT_EQ(json["timing_us"], 10001.066);
  EXPECT_EQ(json["echo"]["text"], "255 (idle)");
  EXPECT_EQ(json["gripper"]["current_ma"], -200);
  EXPECT_EQ(json["gripper"]["object"], "while_closing");
}

TEST(TelemetryJson, IsValidWhateverTheBoardSends) {
  DriveStatistics link{.sent = 3, .answered = 2, .lost = 1, .bad = 7};
  link.round_trip.record(110us);
  for (const int byte : {0x00, 0x55, 0xFF}) {
    TelemetryBytes bytes;
    bytes.fill(static_cast<std::byte>(byte));
    const auto frame = decode_telemetry(body_of(bytes));
    EXPECT_TRUE(test::is_valid_json(to_json(at(1s), frame, link), kSchema)) << byte;
  }
  EXPECT_TRUE(test::is_valid_json(to_json(at(1s), kFrame, {}), kSchema));
}

}  // namespace
}  // namespace armjig::parol6::drive
