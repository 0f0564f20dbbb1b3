// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// What `armjig watch` knows of one device: how to ask it without doing anything to it, and how to
/// show what it answers. No I/O.
class Watched {
 public:
  Watched() = default;
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;
  virtual ~Watched() = default;

  /// The harmless message that is due at `now`; empty if the device speaks by itself.
  [[nodiscard]] virtual std::vector<std::byte> request(Instant now) = 0;

  /// Takes what came.
  virtual void receive(Instant now, Bytes bytes) = 0;

  /// Nothing more will come.
  virtual void finish() = 0;

  /// How many messages came.
  [[nodiscard]] virtual std::uint64_t answers() const = 0;

  /// Those of the last `receive`, a JSON object on a line each, without line ends.
  [[nodiscard]] virtual std::vector<std::string> json_lines() const = 0;

  // The newest one: on one line without line end, or on several. Empty before the first.
  [[nodiscard]] virtual std::string line() const = 0;
  [[nodiscard]] virtual std::string panel() const = 0;

  /// The link so far, on several lines.
  [[nodiscard]] virtual std::string link() const = 0;
};

/// A device that this room knows.
struct WatchedEntry {
  std::string_view device;
  double rate;  ///< questions, or looks, a second unless the user wants another one
  std::unique_ptr<Watched> (*make)(Duration period);
  Outcome<Rig> (*open)(const RigOptions& options);
};

/// All of them, by name.
[[nodiscard]] std::span<const WatchedEntry> watched_devices() noexcept;

}  // namespace armjig::cli
