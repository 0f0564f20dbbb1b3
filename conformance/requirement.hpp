// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "harness/report/report.hpp"

namespace armjig {

/// Who has to obey.
enum class Role : std::uint8_t {
  kDevice,
  kHost,  ///< the program that talks to the device
};

/// Which of two authorities tells what is right where they disagree.
enum class Profile : std::uint8_t {
  kFirmware,    ///< what the shipped device does, quirks and all
  kDocumented,  ///< what its public document promises
};

/// The profiles in which a requirement holds.
enum class Profiles : std::uint8_t { kBoth, kFirmware, kDocumented };

[[nodiscard]] std::string_view to_string(Role role) noexcept;
[[nodiscard]] std::string_view to_string(Profile profile) noexcept;
[[nodiscard]] std::string_view to_string(Profiles profiles) noexcept;

[[nodiscard]] constexpr bool holds_in(Profiles profiles, Profile profile) noexcept {
  return profiles == Profiles::kBoth ||
         (profiles == Profiles::kFirmware) == (profile == Profile::kFirmware);
}

/// A sentence that a device, or the program that talks to it, has to obey. Ids are words, never
/// renumbered and never used again.
struct Requirement {
  std::string_view id;
  Level level{};
  std::string_view text;    ///< one sentence
  std::string_view source;  ///< where it is written or seen
  Profiles profiles = Profiles::kBoth;
  /// Of a requirement of one profile: the requirement of the other one about the same thing. A
  /// device that breaks the documented one and obeys this one deviates as known.
  std::string_view instead{};
  Role role = Role::kDevice;
  /// Why no case can check it on the wire; empty if one does.
  std::string_view unobservable{};
};

/// A row of a report about one, with nothing found.
[[nodiscard]] ReportRow row_about(const Requirement& requirement);

}  // namespace armjig
