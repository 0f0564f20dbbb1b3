// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace armjig {

struct ScenePoint {
  double x{};
  double y{};
  double z{};  ///< up
};

/// An arm as sticks from base to tool, at one time.
struct ScenePose {
  double seconds{};
  std::vector<ScenePoint> chain{};
};

/// Something that moves in space, to be looked at from all sides and at any time. Only the page has
/// it: what can be said in words and numbers belongs into tables and plots as well.
struct Scene {
  std::string title{};
  std::string unit{};              ///< of all coordinates
  std::vector<ScenePose> poses{};  ///< in order of time, each with as many points
};

/// The scene as a `<figure>` of HTML for our page, whose script draws it; a slider sets the time.
/// Of many poses, some hundred are kept, the first and the last among them.
[[nodiscard]] std::string to_figure(const Scene& scene);

}  // namespace armjig
