// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/kinovazed_options.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "emulators/kinovazed/defects/faults.hpp"

namespace armjig::kinovazed {
namespace {

/// What options have said so far.
struct Settings {
  ServerOptions server;
  std::string plant = "jaco";
  std::optional<Duration> call_time;
  std::vector<Quirk> quirks;
  std::string fault;  ///< changes what all other options have made
};

template <class Value>
struct Choice {
  std::string_view name;
  Value value;
};

template <class Value, std::size_t size>
Outcome<Value> choose(const std::array<Choice<Value>, size>& choices, const std::string& where,
                      const std::string& text) {
  std::string names;
  for (const auto& choice : choices) {
    if (choice.name == text) return choice.value;
    names += (names.empty() ? "" : " or ") + std::string{choice.name};
  }
  return problem(ErrorCode::kBadValue, where, "write " + names);
}

constexpr std::array kProfiles{Choice<Behaviour>{"firmware", kFirmwareBehaviour},
                               Choice<Behaviour>{"documented", kDocumentedBehaviour}};
constexpr std::array kDeaths{Choice<OnDeath>{"stay", OnDeath::kStay},
                             Choice<OnDeath>{"restart", OnDeath::kRestart}};
constexpr std::array kRaces{Choice<RaceOrder>{"reply", RaceOrder::kReplyFirst},
                            Choice<RaceOrder>{"event", RaceOrder::kEventFirst},
                            Choice<RaceOrder>{"random", RaceOrder::kRandom}};

Outcome<Duration> parse_call_time(const std::string& where, const std::string& text) {
  std::uint32_t value{};
  const auto* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc{} && stop == end && value <= 100'000) {
    return std::chrono::microseconds{value};
  }
  return problem(ErrorCode::kBadValue, where,
                 "write the length of a call to the arm in microseconds, 0 to 100000");
}

Outcome<ObjectiveSet> read_objectives(const std::string& path) {
  std::ifstream in{path, std::ios::binary};
  if (!in) return problem(ErrorCode::kBadValue, path, "a readable file of objectives is needed");
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  if (in.bad()) return problem(ErrorCode::kBadValue, path, "it cannot be read to its end");
  return parse_objectives(text, path);
}

/// Puts a value in its place, or passes on why there is none.
template <class Value, class Place>
std::optional<Problem> put(Outcome<Value> value, Place& place) {
  if (!value) return value.error();
  place = *std::move(value);
  return std::nullopt;
}

std::optional<Problem> apply(const std::string& name, const std::string& value,
                             const std::string& where, Settings& settings) {
  const auto place = where + ", " + name + "=" + value;
  auto& server = settings.server;
  if (name == "profile") return put(choose(kProfiles, place, value), server.behaviour);
  if (name == "on-death") return put(choose(kDeaths, place, value), server.on_death);
  if (name == "race") return put(choose(kRaces, place, value), server.race);
  if (name == "objectives") return put(read_objectives(value), server.objectives);
  if (name == "call-us") return put(parse_call_time(place, value), settings.call_time);
  if (name == "fault") {
    settings.fault = value;
    return std::nullopt;
  }
  if (name == "plant") {
    settings.plant = value;
    if (value == "jaco" || value == "bench") return std::nullopt;
    return Problem{ErrorCode::kBadValue, place, "write jaco or bench"};
  }
  return Problem{ErrorCode::kUnknownOption, where + ", " + name,
                 "kinovazed has profile, plant, objectives, on-death, race, call-us and fault"};
}

}  // namespace

Outcome<DefectiveServer> make_server(const DeviceOptions& options, const std::string& where) {
  Settings settings;
  for (const auto& [name, value] : options) {
    if (auto wrong = apply(name, value, where, settings)) return tl::unexpected{*std::move(wrong)};
  }
  if (settings.call_time) settings.server.call_time = *settings.call_time;
  if (!settings.fault.empty()) {
    const auto added = add_fault(settings.fault, settings.server, settings.quirks);
    if (!added) return tl::unexpected{added.error()};
  }
  const auto plant = settings.plant == "bench" ? Plant{BenchArm{}} : Plant{JacoArm{}};
  return DefectiveServer{Server{ArmPort{plant}, std::move(settings.server)},
                         std::move(settings.quirks)};
}

}  // namespace armjig::kinovazed
