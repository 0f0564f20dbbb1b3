// SPDX-License-Identifier: Apache-2.0
// The KinovaZED server with a realistic arm, its clients, and somebody beside it: lines are whole
// and known, times never decrease, and a copy of the server goes on to the same bytes.
//
// Input: a byte of choices (the server's options), then steps (fuzz/hosted.hpp). The first client
// is there from the start.
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/kinovazed/defects/defective_server.hpp"
#include "fuzz/hosted.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/kinovazed/vocabulary.hpp"

namespace armjig::fuzz::kinovazed_arm {
namespace {

using namespace kinovazed;
using namespace std::chrono_literals;
using namespace emulation;

constexpr auto kHands = std::to_array<std::string_view>(
    {"arm.held", "arm.at.x", "arm.at.y", "arm.at.z", "arm.at.pitch", "arm.at.yaw", "arm.at.roll",
     "arm.joystick.x", "arm.joystick.y", "arm.joystick.z", "arm.joystick.wrist-x",
     "arm.joystick.home", "arm.mode", "arm.current", "arm.plugged", "arm.fail.position_read",
     "arm.fail.target_write", "arm.fail.arm_open", "restart"});

std::string number_from(Input& input) {
  constexpr std::array kNumbers{"1", "-1", "0.5", "0.3", "-0.3", "2", "", "x", "1e3", "nan"};
  const auto choice = input.u8();
  return choice < 0xC0 ? kNumbers[choice % 6] : kNumbers[choice % kNumbers.size()];
}

std::vector<std::byte> line_from(Input& input) {
  const auto choice = input.u8();
  const auto verb = static_cast<Verb>(choice % kVerbNames.size());
  std::string line{to_string(verb)};
  if (verb == Verb::kSetJoystickMode) line += ":" + std::string{kModeNames[input.u8() % 5]};
  if (names_objective(verb)) {
    line += ":" + std::string{kObjectiveNames[input.u8() % kObjectiveNames.size()]};
  }
  if (verb == Verb::kMoveJoystick || verb == Verb::kGetObjectivePosition) {
    for (int i = 0; i < 3; ++i) line += (i == 0 ? ":" : ",") + number_from(input);
  }
  line += (choice & 0xF0) == 0xF0 ? "\n" : "\r\n";
  const auto bytes = std::as_bytes(std::span{line});
  return {bytes.begin(), bytes.end()};
}

constexpr Surroundings kAround{kHands, line_from, make_dissector};

DefectiveServer server_from(std::uint8_t choices) {
  ServerOptions options;
  if ((choices & 1) != 0) options.behaviour = kDocumentedBehaviour;
  if ((choices & 2) != 0) options.on_death = OnDeath::kRestart;
  if ((choices & 4) != 0) options.call_time = 2ms;
  JacoArm arm;
  if ((choices & 8) == 0) arm.set_mode(ArmMode::kReady);
  return DefectiveServer{Server{ArmPort{arm}, options}};
}

void check_session(Input input) {
  auto server = server_from(input.u8());
  const auto begin = wait_until_listening(server);
  (void)server.connect(begin);
  (void)check_hosted(server, begin, input, 30s, kAround);
}

}  // namespace
}  // namespace armjig::fuzz::kinovazed_arm

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::kinovazed_arm::check_session(
      armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
