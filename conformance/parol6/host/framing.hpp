// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "conformance/program_checker.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::programs {

/// Finds the frames in what a program sends and says what is wrong with the bytes that are none.
class Framing {
 public:
  using OnFrame = std::function<void(const CommandFrame& frame)>;

  Framing(Complain complain, Duration noise);

  void feed(Instant time, Bytes bytes, const OnFrame& on_frame);

 private:
  void judge_noise(Bytes noise, bool is_before_frame);
  void judge_stray(Bytes stray, bool is_before_frame);
  [[nodiscard]] bool is_reset(Bytes stray);
  void judge_duration(Instant time);

  Complain complain_;
  Duration most_;
  std::unique_ptr<Dissector> dissector_;
  std::vector<Message> messages_;
  std::size_t unfinished_ = 0;  ///< bytes that are in no message yet
  Instant begun_{};             ///< when the first of them came
  std::size_t excused_ = 0;     ///< bytes that belong to a frame of a wrong length
  bool has_flushed_ = false;    ///< since the last frame
};

}  // namespace armjig::parol6::programs
