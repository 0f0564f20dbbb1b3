// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/capture/trace.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// Remembers the first key of a recording that is missing or out of range; for what reads them.
class WrongKey {
 public:
  void complain(std::string_view key) {
    if (wrong_key_.empty()) wrong_key_ = key;
  }
  /// Empty: none.
  [[nodiscard]] const std::string& wrong_key() const noexcept { return wrong_key_; }
  /// For a key of the header.
  [[nodiscard]] auto refuse(const Trace& trace) const {
    return problem(ErrorCode::kMalformed, trace.path + ":1",
                   '"' + wrong_key_ + "\" is missing or out of range");
  }

 private:
  std::string wrong_key_;
};

}  // namespace armjig
