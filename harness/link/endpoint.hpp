// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "harness/core/time.hpp"
#include "harness/link/lifeline.hpp"

namespace armjig {

/// What all ports have besides what passes through them. Time is the port's own: virtual for one in
/// memory, where waiting costs nothing, monotonic since opening for a real one. For one thread at a
/// time.
class Endpoint {
 public:
  Endpoint() = default;
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;
  virtual ~Endpoint() = default;

  [[nodiscard]] virtual Instant now() const = 0;

  /// The file behind a real port, for what has to outlive this process; none in memory, or without
  /// a connection.
  [[nodiscard]] virtual std::optional<Lifeline> lifeline() const { return std::nullopt; }

  /// Does at the device what its link cannot: sets a switch or an input, turns its power off and
  /// on. Names and values are the device's own. False: there is no such input, or nobody who could.
  [[nodiscard]] virtual bool touch(std::string_view input, std::int64_t value) {
    (void)input;
    (void)value;
    return false;
  }

  /// What is to be seen at the device and does not come over its link: where a servo stands,
  /// whether a lamp is lit. Names and values are the device's own. None: there is no such thing, or
  /// nobody who looks.
  [[nodiscard]] virtual std::optional<std::int64_t> observe(std::string_view output) {
    (void)output;
    return std::nullopt;
  }
};

}  // namespace armjig
