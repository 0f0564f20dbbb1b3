// SPDX-License-Identifier: Apache-2.0
#include "harness/report/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "harness/report/wording.hpp"

namespace armjig {
namespace {

constexpr std::size_t kMostPoses = 600;

/// Times and coordinates as JSON: `{"times":[...],"chains":[[x,y,z,x,y,z,...],...]}`.
std::string data_of(const Scene& scene) {
  const auto count = std::min(scene.poses.size(), kMostPoses);
  std::string times;
  std::string chains;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& pose =
        scene.poses[i * (scene.poses.size() - 1) / std::max<std::size_t>(count - 1, 1)];
    const auto* const comma = i == 0 ? "" : ",";
    fmt::format_to(std::back_inserter(times), "{}{:.2f}", comma, pose.seconds);
    fmt::format_to(std::back_inserter(chains), "{}[", comma);
    for (std::size_t p = 0; p < pose.chain.size(); ++p) {
      const auto& [x, y, z] = pose.chain[p];
      fmt::format_to(std::back_inserter(chains), "{}{:.1f},{:.1f},{:.1f}", p == 0 ? "" : ",", x, y,
                     z);
    }
    chains += ']';
  }
  return fmt::format("{{\"times\":[{}],\"chains\":[{}]}}", times, chains);
}

}  // namespace

std::string to_figure(const Scene& scene) {
  const auto title = wording::xml(wording::line(scene.title));
  if (scene.poses.empty()) {
    return fmt::format(
        "<figure class=\"plot card\">\n<figcaption>{}</figcaption>\n<p class=\"no-data\">no "
        "data</p>\n</figure>\n",
        title);
  }
  return fmt::format(
      "<figure class=\"plot scene card\" data-scene='{}'>\n<figcaption>{}</figcaption>\n"
      "<svg role=\"img\" aria-label=\"{}\"></svg>\n"
      "<div class=\"player\"><button type=\"button\">Play</button>\n"
      "<input type=\"range\" min=\"0\" value=\"0\" aria-label=\"Time\">\n<output></output></div>\n"
      "<p class=\"x-label\">Drag to turn. Lengths in {}.</p>\n"
      "<noscript><p class=\"no-data\">The drawing needs the page's script.</p></noscript>\n"
      "</figure>\n",
      data_of(scene), title, title, wording::xml(wording::line(scene.unit)));
}

}  // namespace armjig
