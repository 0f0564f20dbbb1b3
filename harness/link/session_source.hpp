// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "harness/core/time.hpp"
#include "harness/link/session_port.hpp"

namespace armjig {

/// One server, and as many ports to it as are wanted: how several clients are had at once.
class SessionSource {
 public:
  SessionSource() = default;
  SessionSource(const SessionSource&) = delete;
  SessionSource& operator=(const SessionSource&) = delete;
  virtual ~SessionSource() = default;

  /// A port without a connection. Lives no longer than this. Each has a clock of its own; they only
  /// agree in how fast they are, with each other and with `now`.
  [[nodiscard]] virtual std::unique_ptr<SessionPort> make_port() = 0;

  [[nodiscard]] virtual Instant now() const = 0;

  /// Lets time pass while nobody reads.
  virtual void pause(Duration duration) = 0;

  /// Does at the server what no client can. False: nobody can here.
  [[nodiscard]] virtual bool touch(std::string_view input, std::int64_t value) = 0;
};

}  // namespace armjig
