// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
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
  /// Of role host: what a program has to do before it can break it, in words; empty: any message.
  std::string_view occasion{};
};

/// Where a requirement stands in a document; lines count from 1.
struct DocumentLine {
  std::string_view requirement;
  std::uint32_t line{};
};

/// What has the sentences of a device's requirements, for reports that point there.
struct Document {
  /// A URI from the root of the project that the document belongs to; empty: there is none.
  std::string_view path{};
  std::span<const DocumentLine> lines{};
};

/// A document of docs/spec, by its path there, with its lines when this was built.
[[nodiscard]] Document shipped_document(std::string_view path) noexcept;

[[nodiscard]] constexpr Requirement must(std::string_view id, std::string_view text,
                                         std::string_view source,
                                         Profiles profiles = Profiles::kBoth,
                                         std::string_view instead = {}) noexcept {
  return {id, Level::kMust, text, source, profiles, instead};
}
/// The same arguments as of `must`.
template <class... More>
[[nodiscard]] constexpr Requirement should(const More&... more) noexcept {
  auto requirement = must(more...);
  requirement.level = Level::kShould;
  return requirement;
}

/// One that no case can check on the wire.
[[nodiscard]] constexpr Requirement unobservable(std::string_view why, Requirement one) noexcept {
  one.unobservable = why;
  return one;
}

/// A row of a report about one, with nothing found.
[[nodiscard]] ReportRow row_about(const Requirement& requirement, const Document& document);

}  // namespace armjig
