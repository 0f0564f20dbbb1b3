// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/kinovazed_matrix.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "emulators/kinovazed/server.hpp"
#include "harness/core/nesting.hpp"

namespace armjig::kinovazed::replay {
namespace {

using namespace emulation;
using Json = nlohmann::json;
using namespace std::chrono_literals;
using enum State;

constexpr std::string_view kFormat = "state-command-matrix/1";
/// Replies are what comes by then.
constexpr Duration kReplies = 200ms;
/// So long before a heartbeat the command was sent.
constexpr Duration kBeforeBeat = 320ms;
/// By then the slow arm is anywhere.
constexpr Duration kRest = 30s;
constexpr std::string_view kBeat = "Heartbeat:";

struct Step {
  std::string_view line;
  Duration wait;  ///< until the next one, or until the command of the cell
};

constexpr Step kQuitEStop{"QuitEStop", 100ms};
constexpr Step kToIdle{"Initialize", 700ms};
constexpr Step kToSteering{"SetJoystickMode:XYZ", 700ms};
constexpr Step kToRetracted{"Retract", 3s};

struct Route {
  State state;
  std::array<Step, 4> steps;  ///< the rest is empty
};
constexpr std::array kRoutes{
    Route{kEmergencyStopped, {}},
    Route{kPoweredOff, {kQuitEStop}},
    Route{kInitializing, {kQuitEStop, Step{"Initialize", 100ms}}},
    Route{kIdle, {kQuitEStop, kToIdle}},
    Route{kRetracting, {kQuitEStop, kToIdle, Step{"Retract", 100ms}}},
    Route{kRetracted, {kQuitEStop, kToIdle, kToRetracted}},
    Route{kUnfolding, {kQuitEStop, kToIdle, kToRetracted, Step{"Unfold", 100ms}}},
    Route{kSettingMode, {kQuitEStop, kToIdle, Step{"SetJoystickMode:XYZ", 100ms}}},
    Route{kSteering, {kQuitEStop, kToIdle, kToSteering}},
    Route{kRunningSequence, {kQuitEStop, kToIdle, Step{"RunObjective:SuckDoor", 100ms}}},
    Route{kFrozen, {kQuitEStop, kToIdle, Step{"Freeze", 700ms}}},
};

/// The arm of the table is slow, and where it ends its initialization unless that is the state.
BenchOptions arm_for(State state) {
  return {.start_mode = state == kInitializing ? ArmMode::kNeverHomed : ArmMode::kReady,
          .initialise_s = 2.5,
          .unfold_s = 2.5,
          .retract_s = 2.5,
          .linear_m_s = 0.25,
          .rotation_rad_s = 1.0};
}

/// A server and its only client.
class Session {
 public:
  Session(const Route& route, Duration delay) : server_{ArmPort{BenchArm{arm_for(route.state)}}} {
    pass(60ms);
    client_ = server_.connect(now_).value_or(client_);
    pass(delay);
    for (const auto& step : route.steps) {
      if (!step.line.empty()) send(step.line);
      pass(step.wait);
    }
    server_.clear_sent();
  }

  void send(std::string_view line) {
    const auto text = std::string{line} + "\r\n";
    server_.receive(now_, client_, std::as_bytes(std::span{text}));
  }
  void pass(Duration time) {
    now_ += time;
    server_.advance_to(now_);
  }
  [[nodiscard]] State state() const { return server_.state(); }

  /// What the client got since the last question, a message each.
  std::vector<std::string> take_messages() {
    std::vector<std::string> messages;
    for (const auto& event : server_.sent()) {
      std::string text;
      for (const auto byte : event.bytes) text.push_back(static_cast<char>(byte));
      messages.push_back(text.substr(0, text.find('\r')));
    }
    server_.clear_sent();
    return messages;
  }

 private:
  Server server_;
  Instant now_{};
  ConnectionId client_{};
};

std::vector<std::string> take_beats(std::vector<std::string>& messages) {
  const auto [begin, end] = std::ranges::stable_partition(
      messages, [](const std::string& message) { return !message.starts_with(kBeat); });
  std::vector<std::string> beats(begin, end);
  messages.erase(begin, end);
  for (auto& beat : beats) beat.erase(0, kBeat.size());
  return beats;
}

/// A server in a state, so that its next heartbeat is as far away as it was in the recordings.
Session session_in(const Route& route) {
  auto probe = Session{route, {}};
  Duration until_beat{};
  constexpr Duration kGlance = 10ms;
  for (bool has_beat = false; !has_beat && until_beat < 2 * pace::kBeat; until_beat += kGlance) {
    probe.pass(kGlance);
    auto messages = probe.take_messages();
    has_beat = !take_beats(messages).empty();
  }
  return Session{route, (until_beat - kBeforeBeat + pace::kBeat) % pace::kBeat};
}

/// By the keys of a cell.
Json answer_of(const Route& route, const std::string& command) {
  auto session = session_in(route);
  session.send(command);
  session.pass(kReplies);
  auto replies = session.take_messages();
  auto beats = take_beats(replies);
  const auto next_state = session.state();
  session.pass(kRest);
  auto later = session.take_messages();
  const auto later_beats = take_beats(later);
  beats.insert(beats.end(), later_beats.begin(), later_beats.end());
  const auto number = [](const std::string& beat) { return Json::parse(beat, nullptr, false); };
  return {{"replies", replies},
          {"next_state", to_string(next_state)},
          {"heartbeat_after", beats.empty() ? Json{} : number(beats.front())},
          {"later", later},
          {"settled_state", to_string(session.state())},
          {"settled_heartbeat", beats.empty() ? Json{} : number(beats.back())}};
}

Json sorted(const Json& list) {
  auto items = list.is_array() ? list.get<std::vector<Json>>() : std::vector<Json>{};
  std::ranges::sort(items);
  return items;
}

/// By the keys that the cell has.
std::optional<CellDifference> difference(const Json& cell, const Json& answer, std::string name) {
  Json recorded;
  Json actual;
  for (const auto& [key, value] : answer.items()) {
    if (!cell.contains(key)) continue;
    const bool may_swap = key == "replies" && cell.value("order_may_swap", Json{}) == true;
    recorded[key] = may_swap ? sorted(cell[key]) : cell[key];
    actual[key] = may_swap ? sorted(value) : value;
  }
  if (recorded == actual) return std::nullopt;
  return CellDifference{std::move(name), recorded.dump(), actual.dump()};
}

auto malformed(const std::string& where, std::string_view what) {
  return problem(ErrorCode::kMalformed, where, std::string{what});
}

}  // namespace

Outcome<TableVerdict> verify_matrix(std::string_view text, const std::string& where) {
  if (is_too_deep(text)) return malformed(where, kTooDeep);
  const auto table = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  const bool is_table = table.is_object() && table.value("format", Json{}) == kFormat &&
                        table.value("entries", Json{}).is_array();
  if (!is_table) return malformed(where, fmt::format("it is no table of form {}", kFormat));
  TableVerdict verdict;
  for (const auto& cell : table["entries"]) {
    ++verdict.cells;
    const auto place = fmt::format("{}, entry {}", where, verdict.cells);
    const auto text_of = [&cell](const char* key) {
      const auto value = cell.is_object() ? cell.value(key, Json{}) : Json{};
      return value.is_string() ? value.get<std::string>() : "";
    };
    const auto route = std::ranges::find_if(
        kRoutes, [&](const Route& one) { return to_string(one.state) == text_of("state"); });
    if (route == kRoutes.end()) return malformed(place, "it has no \"state\" of the server");
    const auto command = text_of("command");
    if (command.empty()) return malformed(place, "it has no \"command\"");
    auto found = difference(cell, answer_of(*route, command),
                            fmt::format("{}, {}", to_string(route->state), command));
    if (found) verdict.differences.push_back(*std::move(found));
  }
  return verdict;
}

}  // namespace armjig::kinovazed::replay
