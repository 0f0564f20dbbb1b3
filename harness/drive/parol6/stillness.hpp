// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "harness/core/time.hpp"

namespace armjig::parol6::drive {

/// So long telemetry has to show the same places until the arm is said to stand.
inline constexpr Duration kToStand = std::chrono::milliseconds{50};

/// Since when something has stayed as it is.
template <class Value>
class Stillness {
 public:
  /// How long the value has been the same at `now`.
  Duration observe(Instant now, const Value& value) {
    if (!last_ || *last_ != value) since_ = now;
    last_ = value;
    return now - since_;
  }

 private:
  std::optional<Value> last_;
  Instant since_{};
};

}  // namespace armjig::parol6::drive
