// SPDX-License-Identifier: Apache-2.0
// A firmware author's unit test: an emulated board without any I/O.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "emulators/parol6/arm.hpp"
#include "harness/wire/parol6/frame.hpp"

int main() {
  using namespace armjig::parol6;
  using namespace std::chrono_literals;

  emulation::Arm arm;
  arm.receive(armjig::at(5ms), encode(CommandFrame{.command = Command::kIdle}));
  arm.advance_to(armjig::at(10ms));
  if (arm.sent().size() != 1 || arm.sent().front().bytes.size() != kTelemetryFrameSize) return 1;

  TelemetryBytes bytes{};
  std::ranges::copy(arm.sent().front().bytes, bytes.begin());
  const auto telemetry = decode_telemetry(body_of(bytes));
  std::printf("the board answered command %d\n", static_cast<int>(telemetry.echo));
  return telemetry.echo == Command::kIdle && encode(telemetry) == bytes ? 0 : 1;
}
