// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/campaign/script.hpp"
#include "emulators/sessions/sessions.hpp"
#include "harness/compare/rules.hpp"

namespace armjig::campaign {

/// What shows in no answer at once, such as where an arm was led, shows in what these are answered
/// with, or when.
struct Epilogue {
  std::span<const std::string_view> messages{};
  Duration pause{};         ///< between them
  std::int64_t one_in = 3;  ///< so many scripts ends with them
};

/// What scripts are made of: all that is known of a device.
struct Material {
  LinkKind kind{};  ///< of its link
  MakeDissector make_dissector{};
  DrawSession draw_session{};  ///< nullptr: scripts begin with what is harmless
  /// One harmless exchange. Each case ends with it, as the question whether the device is well.
  Script harmless;
  /// Makes lengths and checksums of a message right again, on a bus of one with the byte of the
  /// address; nullptr: it has none, or nobody can.
  void (*seal)(std::span<std::byte> message){};
  std::vector<std::uint32_t> addresses{};  ///< of a bus: who is there
  /// Leaves out of a script what may not be sent; empty: all may.
  std::function<void(Script& script)> permit{};
  /// The same of a whole case, given where it leads a sound device that is as new; empty: nobody
  /// knows.
  std::function<void(Script& script)> permit_case{};
  /// Whether what comes of a message depends on more than answers tell; nullptr: of none.
  bool (*strays)(Bytes message){};
  /// The fields of answers that tell what comes of it.
  std::span<const std::string_view> astray_fields{};
  /// What was written for the device on purpose, as what the cases of its suite do, each from when
  /// it is new.
  std::vector<Script> written{};
  bool has_hands = false;      ///< what is beside the link can be done
  bool has_operations = true;  ///< of a bus: transactions may have any form
  /// A client that closes is known to have; else only, as over TCP at first, that it says no more.
  bool are_ends_told = true;
  Duration longest{};                                ///< of a script
  Duration longest_tour = std::chrono::seconds{60};  ///< of one that leads through states
  Spacing spacing{};
  Epilogue epilogue{};  ///< empty: all shows at once
  /// What a sound device that is as new says to a script, without waiting for it; empty: nobody
  /// knows.
  std::function<std::vector<KeptRecord>(const Script& script)> rehearse;
  ComparisonRules rules{};  ///< what is let pass of what it says
};

}  // namespace armjig::campaign
