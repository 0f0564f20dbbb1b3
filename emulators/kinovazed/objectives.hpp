// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "emulators/kinovazed/pose.hpp"
#include "harness/core/error.hpp"
#include "harness/wire/kinovazed/vocabulary.hpp"

namespace armjig::kinovazed::emulation {

/// What `RunObjective` runs: way-points in a frame.
struct ObjectivePath {
  Objective objective{};
  std::optional<Pose> origin;  ///< none: relative, the pose at the moment of the command
  std::vector<Pose> points;    ///< at least one
};

/// The objectives that a server knows, each at most once.
class ObjectiveSet {
 public:
  ObjectiveSet() = default;
  explicit ObjectiveSet(std::vector<ObjectivePath> paths) : paths_{std::move(paths)} {}

  [[nodiscard]] const ObjectivePath* find(Objective objective) const noexcept;
  [[nodiscard]] const std::vector<ObjectivePath>& paths() const noexcept { return paths_; }

 private:
  std::vector<ObjectivePath> paths_;
};

/// All nine, with the figures of the newest server (docs/spec/kinovazed.md, "Objectives").
[[nodiscard]] ObjectiveSet published_objectives();

/// Reads the server's file format: an array of `{"name", "is_abs", "origin", "sequence"}` with
/// poses
/// `{"X", "Y", "Z", "pitch", "yaw", "roll"}` in metres and radians. Objectives may be missing; of
/// two with one name the first counts. `where` names the text in problems, which are `kMalformed`
/// and say which element and which member.
[[nodiscard]] Outcome<ObjectiveSet> parse_objectives(std::string_view json,
                                                     const std::string& where);

}  // namespace armjig::kinovazed::emulation
