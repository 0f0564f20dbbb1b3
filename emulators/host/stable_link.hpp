// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/error.hpp"

namespace armjig {

/// A symbolic link with a name of the user's choice to a pseudo-terminal, whose own name changes
/// from run to run. It is removed with its owner, if it still leads there.
///
/// What stands at the path already is replaced only if it is a symbolic link into /dev/pts/ and
/// either dangles, which is what a killed emulator leaves behind, or leads to this very terminal,
/// whose number it had. A link to a terminal that lives belongs to somebody, another emulator or
/// socat, and is not touched; nor is anything that is not a link.
class StableLink {
 public:
  StableLink() = default;
  StableLink(StableLink&& other) noexcept;
  StableLink& operator=(StableLink&& other) noexcept;
  StableLink(const StableLink&) = delete;
  StableLink& operator=(const StableLink&) = delete;
  ~StableLink();

  /// At no moment is `path` absent or half made, once it was there. Problems: `kBadValue`
  /// (something stands there that is not ours to replace), `kBusy` (it leads to a terminal in use),
  /// `kNotFound` (no such folder), `kNoPermission`, `kSystem`.
  [[nodiscard]] static Outcome<StableLink> create(const std::string& path,
                                                  const std::string& terminal);

  /// Absolute; empty if there is no link.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  StableLink(std::string path, std::string terminal);

  std::string path_;
  std::string terminal_;
};

}  // namespace armjig
