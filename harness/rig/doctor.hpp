// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/rig/attached.hpp"

/// What on this machine is in the way of talking to real arms in time.
namespace armjig {

/// What the checks look at: files, and what only system calls tell. Tests make their own.
struct System {
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

  std::string root;  ///< stands in front of /dev, /etc, /proc, ...; empty for this machine
  std::string home;  ///< the user's, without `root`; empty: nobody said
  std::vector<SerialPort> ports;
  std::vector<std::string> groups;  ///< of the user, by name
  bool is_superuser = false;
  bool can_make_ptys = false;
  std::uint64_t realtime_priority = 0;  ///< the highest that the user may ask for
  std::uint64_t locked_memory = 0;      ///< bytes that the user may keep from being swapped out
};

/// This machine, as this process sees it.
[[nodiscard]] System this_system();

/// What one check found.
struct Finding {
  enum class State : std::uint8_t {
    kOk,
    kAdvice,   ///< works, but could be better
    kProblem,  ///< something will not work
  };
  std::string_view check;
  State state{};
  std::string text;  ///< one sentence without a full stop
  std::string fix;   ///< one line, mostly a command; empty for `kOk`
};

[[nodiscard]] std::string_view to_string(Finding::State state) noexcept;

/// Each check once or, for ports, once for each. Changes nothing.
[[nodiscard]] std::vector<Finding> examine(const System& system,
                                           std::span<const KnownBoard> boards);

/// The udev rules for boards. The Debian package installs them; elsewhere the user does.
[[nodiscard]] std::string udev_rules(std::span<const KnownBoard> boards);
inline constexpr std::string_view kUdevRulesFile = "60-armjig.rules";

}  // namespace armjig
