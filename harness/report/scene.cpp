// SPDX-License-Identifier: Apache-2.0
#include "harness/report/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/report/wording.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoses = 600;

/// `{"times":[...],"chains":[[x,y,z,x,y,z,...],...]}`: hundredths of seconds, tenths of a unit.
std::string data_of(const Scene& scene) {
  const auto count = std::min(scene.poses.size(), kMostPoses);
  auto times = Json::array();
  auto chains = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    const auto& pose =
        scene.poses[i * (scene.poses.size() - 1) / std::max<std::size_t>(count - 1, 1)];
    times.push_back(std::nearbyint(pose.seconds * 100) / 100);
    auto& chain = chains.emplace_back(Json::array());
    for (const auto& [x, y, z] : pose.chain) {
      for (const double length : {x, y, z}) chain.push_back(std::nearbyint(length * 10) / 10);
    }
  }
  return Json{{"times", std::move(times)}, {"chains", std::move(chains)}}.dump();
}

}  // namespace

std::string to_figure(const Scene& scene) {
  const auto title = wording::html(wording::line(scene.title));
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
      data_of(scene), title, title, wording::html(wording::line(scene.unit)));
}

}  // namespace armjig
