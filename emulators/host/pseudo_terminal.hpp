// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/error.hpp"
#include "harness/link/descriptor.hpp"

namespace armjig {

/// A pseudo-terminal, from the device's side. Clients open `path()`; one that sets no mode itself
/// finds it raw, so that bytes pass unchanged.
///
/// Reading `master()` gives EIO, and polling POLLHUP, whenever no client has the other side open,
/// from the start on.
class PseudoTerminal {
 public:
  /// Problems: `kSystem`, `kNoPermission`, `kNotFound` (no devpts).
  [[nodiscard]] static Outcome<PseudoTerminal> open();

  /// Non-blocking.
  [[nodiscard]] const Descriptor& master() const noexcept { return master_; }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  /// For the next client: what the last one did not read is thrown away, its modes and its stopped
  /// output with it. What clients sent is kept. Does nothing if a client has locked the others out
  /// (TIOCEXCL) and never took that back.
  void reset() const noexcept;

 private:
  PseudoTerminal(Descriptor master, std::string path);

  Descriptor master_;
  std::string path_;
};

}  // namespace armjig
