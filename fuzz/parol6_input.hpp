// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/input.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::fuzz {

/// A command, mostly one of `codes`, and where and how fast it leads which joints. Answers the byte
/// that says which: bit 0 is joint 1, and the upper two mean nothing here.
inline std::uint8_t draw_motion(Input& input, std::span<const parol6::Command> codes,
                                parol6::CommandFrame& frame) {
  const auto code = input.u8();
  frame.command = code < 0xF0 ? codes[code % codes.size()] : parol6::Command{code};
  const auto joints = input.u8();
  for (std::size_t j = 0; j < parol6::kJointCount; ++j) {
    if ((joints >> j & 1) == 0) continue;
    frame.speed[j] = StepsPerSecond{input.i16()};
    frame.position[j] = Steps{input.i16()};
  }
  return joints;
}

}  // namespace armjig::fuzz
