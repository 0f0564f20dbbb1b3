// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/objectives.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/core/nesting.hpp"

namespace armjig::kinovazed::emulation {
namespace {

using Json = nlohmann::json;

/// Reads the members of a file; remembers the first that is wrong.
class FileReader {
 public:
  Pose pose(const Json& object, const std::string& place) {
    constexpr std::array<const char*, 6> kNames{"X", "Y", "Z", "pitch", "yaw", "roll"};
    std::array<float, 6> values{};
    if (!object.is_object()) {
      complain(place, "is not a pose: an object with X, Y, Z, pitch, yaw, roll");
      return {};
    }
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      const auto found = object.find(kNames[i]);
      if (found == object.end() || !found->is_number()) {
        complain(place + "." + kNames[i], "is missing or not a number");
        return {};
      }
      values[i] = found->get<float>();
      if (!std::isfinite(values[i])) complain(place + "." + kNames[i], "is too large");
    }
    return {values[0], values[1], values[2], values[3], values[4], values[5]};
  }

  ObjectivePath path(const Json& element, const std::string& place) {
    ObjectivePath path;
    if (!element.is_object()) {
      complain(place, "is not an object");
      return path;
    }
    const auto name = element.value("name", Json{});
    const auto objective = name.is_string()
                               ? find_word<Objective>(kObjectiveNames, name.get<std::string>())
                               : std::nullopt;
    if (!objective) complain(place + ".name", "is not the name of an objective");
    path.objective = objective.value_or(Objective::kCurrent);
    const auto is_absolute = element.value("is_abs", Json{});
    if (!is_absolute.is_boolean()) complain(place + ".is_abs", "is neither true nor false");
    const auto origin = pose(element.value("origin", Json{}), place + ".origin");
    if (is_absolute == true) path.origin = origin;
    const auto sequence = element.value("sequence", Json{});
    if (!sequence.is_array() || sequence.empty()) {
      complain(place + ".sequence", "is not an array of at least one pose");
      return path;
    }
    for (std::size_t i = 0; i < sequence.size(); ++i) {
      path.points.push_back(pose(sequence[i], fmt::format("{}.sequence[{}]", place, i)));
    }
    return path;
  }

  void complain(const std::string& place, std::string_view what) {
    if (complaint_.empty()) complaint_ = fmt::format("{} {}", place, what);
  }
  [[nodiscard]] const std::string& complaint() const noexcept { return complaint_; }

 private:
  std::string complaint_;
};

}  // namespace

const ObjectivePath* ObjectiveSet::find(Objective objective) const noexcept {
  const auto found = std::ranges::find(paths_, objective, &ObjectivePath::objective);
  return found == paths_.end() ? nullptr : &*found;
}

ObjectiveSet published_objectives() {
  using enum Objective;
  const Pose here{};
  const Pose antenna{-0.249F, 0.173F, 0.968F, 0.936F, -0.9F, 2.146F};
  const Pose bottle{-0.248F, 0.173F, 0.968F, 0.936F, -0.9F, 2.146F};
  const Pose pull_shut{-0.00805134F, 0.102024F, -0.0952875F, -0.554631F, 0.595608F, 0.0525117F};
  return ObjectiveSet{{
      {kCurrent, {}, {here}},
      {kHome, here, {{0.0480667F, -0.330291F, 0.472718F, 1.71265F, -0.13907F, -0.113034F}}},
      {kHandle,
       Pose{0.12F, -0.723F, 0.551F, 1.491F, -0.066F, 0.002F},
       {{-0.031F, 0.085F, -0.175F, -0.027F, -0.028F, 0.02F},
        {-0.04F, 0.08F, -0.025F, -0.009F, -0.068F, 0.006F}}},
      {kOpenDoor,
       {},
       {here,
        {-0.003F, 0.008F, 0.F, -0.027F, -0.008F, 0.713F},
        {-0.033F, 0.015F, -0.197F, -0.06F, 0.192F, 0.598F},
        {-0.063F, 0.F, -0.19F, -0.059F, 0.069F, -1.543F},
        {-0.07F, 0.083F, -0.188F, -0.053F, 0.055F, -1.555F},
        {0.171F, 0.03F, -0.319F, -0.006F, 0.614F, -0.106F},
        {0.163F, -0.191F, -0.039F, 0.023F, 0.216F, -0.125F}}},
      {kPullDoor,
       {},
       {here,
        {-0.45F, -0.08F, -0.272F, 1.006F, -1.298F, 0.902F},
        {-0.576F, -0.031F, -0.375F, 1.013F, -1.427F, 0.919F}}},
      {kSuckDoor, Pose{-0.591887F, -0.115275F, 0.734826F, 0.365464F, -1.14581F, 1.3918F}, {here}},
      {kAntenna, antenna, {here, pull_shut}},
      {kFindBottle, antenna, {here, pull_shut}},
      {kPlaceBottle, bottle, {here, pull_shut}},
  }};
}

Outcome<ObjectiveSet> parse_objectives(std::string_view json, const std::string& where) {
  if (is_too_deep(json)) return problem(ErrorCode::kMalformed, where, std::string{kTooDeep});
  const auto file = Json::parse(json, nullptr, /*allow_exceptions=*/false);
  if (!file.is_array()) {
    return problem(ErrorCode::kMalformed, where,
                   file.is_discarded() ? "it is not JSON" : "it is not a JSON array of objectives");
  }
  FileReader reader;
  std::vector<ObjectivePath> paths;
  for (std::size_t i = 0; i < file.size(); ++i) {
    auto path = reader.path(file[i], fmt::format("[{}]", i));
    if (std::ranges::find(paths, path.objective, &ObjectivePath::objective) == paths.end()) {
      paths.push_back(std::move(path));
    }
  }
  if (!reader.complaint().empty()) {
    return problem(ErrorCode::kMalformed, where, reader.complaint());
  }
  return ObjectiveSet{std::move(paths)};
}

}  // namespace armjig::kinovazed::emulation
