// SPDX-License-Identifier: Apache-2.0
// Whole sessions with the emulated board: frames, splits, inputs, resets, CAN, at their times.
//
// Input: what falls when a session is drawn (`Roll`).
#include "fuzz/session.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace std::chrono_literals;
  armjig::fuzz::check_session(armjig::test::kDrawnDevices[0], {data, size}, 2s);
  return 0;
}
