// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "conformance/program_checker.hpp"
#include "harness/core/bytes.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"

namespace armjig::kinovazed::programs {

/// Judges what one client writes by its lines alone, and finds the commands in them.
class Lines {
 public:
  using OnCommand = std::function<void(const Command& command)>;

  /// `on_command` gets what the shipped server understands.
  void feed(Bytes bytes, const OnCommand& on_command, const Complain& complain);
  /// The client sends no more.
  void end(const Complain& complain) const;

  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  LineSplitter splitter_;
  std::size_t count_ = 0;    ///< of lines
  bool is_endless_ = false;  ///< the line that is coming was judged as too long
};

}  // namespace armjig::kinovazed::programs
