// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// A wire log: a `golden-trace/1` file that grows line by line. `armjig decode` reads it back.
/// Lines are flushed as they are made, so that nothing is missing after a crash.
class LogFile {
 public:
  /// Problems: the file cannot be written.
  [[nodiscard]] static Outcome<LogFile> create(const std::string& path, std::string_view device);

  /// `keys` is what stands behind the time, JSON without the braces; `messages` ended there. A time
  /// in front of the last one, as clocks that were read one after the other may have it, is taken
  /// for that.
  void add(Instant time, std::string_view keys, std::span<const Message> messages = {});

 private:
  explicit LogFile(std::ofstream file);

  std::ofstream file_;
  Instant last_{};
};

}  // namespace armjig
