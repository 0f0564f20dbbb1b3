// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/link/session_port.hpp"

namespace armjig {

/// One server, and as many ports to it as are wanted: how several clients are had at once.
class SessionSource : public Endpoint {
 public:
  /// A port without a connection. Lives no longer than this. All have one clock, that of `now`, so
  /// that what one client heard can be before or after what another one did.
  [[nodiscard]] virtual std::unique_ptr<SessionPort> make_port() = 0;

  /// Lets time pass while nobody reads.
  virtual void pause(Duration duration) = 0;
};

}  // namespace armjig
