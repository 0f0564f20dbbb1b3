// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/bytes.hpp"

namespace armjig {

/// How a process that inherits the file of a port sends a last message when nothing else of the
/// program is left.
struct Lifeline {
  int descriptor{};
  /// Sends what one `write`, `send` or transaction would. A bus message has the byte with address
  /// and direction first, and is a write. Does nothing but system calls, and may fail: call it
  /// again.
  void (*send)(int descriptor, Bytes message) noexcept {};
  bool is_plain = true;  ///< what is read and written on the file is what the port reads and writes
};

}  // namespace armjig
