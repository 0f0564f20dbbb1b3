// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/kinovazed.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "emulators/kinovazed/defects/defective_server.hpp"
#include "emulators/kinovazed/server.hpp"
#include "emulators/replay/kept_record.hpp"
#include "emulators/replay/kinovazed_rules.hpp"
#include "emulators/replay/watched.hpp"
#include "emulators/replay/wrong_key.hpp"
#include "harness/core/hex.hpp"

namespace armjig::kinovazed::replay {
namespace {

using namespace emulation;
using Json = nlohmann::json;
using namespace std::chrono_literals;

/// What was recorded may come that much later before the replay gives it up.
constexpr Duration kPatience = 2s;
/// What the emulator sends that shortly before the end may come behind the end on a real machine.
constexpr Duration kGrace = 60ms;
/// Longer sessions would only cost time.
constexpr Duration kLongest = 1h;
/// Of one recording whose orders are tried.
constexpr std::uint32_t kMostRaces = 5;
constexpr std::string_view kTerminateNote = "server process is asked to terminate";

struct Recording {
  BenchOptions arm;
  bool is_arm_missing = false;
  std::optional<Duration> listening_since{};  ///< none: it never did
  std::string end;  ///< `server_after`, and `final_state` unless the process has ended
};

auto wrong(const Trace& trace, std::size_t line, std::string_view what) {
  return problem(ErrorCode::kMalformed, fmt::format("{}:{}", trace.path, line), std::string{what});
}

/// Reads the `arm` of a header.
class ArmReader : public WrongKey {
 public:
  explicit ArmReader(const Json& json) : json_{json} {}

  void number(const char* key, double least, double most, double& value) {
    const auto found = json_.find(key);
    if (found == json_.end()) return;
    if (found->is_number()) value = found->get<double>();
    if (!found->is_number() || !(value >= least && value <= most)) complain(key);
  }

 private:
  const Json& json_;
};

Outcome<Recording> read_header(const Trace& trace) {
  const auto header = Json::parse(trace.header, nullptr, /*allow_exceptions=*/false);
  Recording recording;
  const auto arm = header.value("arm", Json::object());
  if (!arm.is_object()) return wrong(trace, 1, "\"arm\" is not an object");
  ArmReader reader{arm};
  double mode = static_cast<double>(recording.arm.start_mode);
  reader.number("start_mode", 0, 100'000, mode);
  reader.number("initialise_s", 1e-6, 1e6, recording.arm.initialise_s);
  reader.number("unfold_s", 1e-6, 1e6, recording.arm.unfold_s);
  reader.number("retract_s", 1e-6, 1e6, recording.arm.retract_s);
  reader.number("to_ready_s", 1e-6, 1e6, recording.arm.to_ready_s);
  reader.number("linear_m_s", 1e-6, 1e6, recording.arm.linear_m_s);
  reader.number("rotation_rad_s", 1e-6, 1e6, recording.arm.rotation_rad_s);
  reader.number("position_noise", 0, 1, recording.arm.position_noise);
  const auto missing = arm.value("missing_at_start", Json(false));
  if (!missing.is_boolean())
    return wrong(trace, 1, "\"arm.missing_at_start\" is not true or false");
  recording.is_arm_missing = missing.get<bool>();
  recording.arm.start_mode = static_cast<ArmMode>(std::lround(mode));
  const auto since = header.value("listening_since_ms", Json(0));
  const auto after = header.value("server_after", Json{});
  const auto state = header.value("final_state", Json{});
  if (!reader.wrong_key().empty()) {
    return wrong(trace, 1, fmt::format("\"arm.{}\" is out of range", reader.wrong_key()));
  }
  const bool never_listened = recording.is_arm_missing && since.is_null();
  if (!never_listened && (!since.is_number() || std::abs(since.get<double>()) > 3.6e6)) {
    return wrong(trace, 1, "\"listening_since_ms\" is out of range");
  }
  if (!after.is_string() || !(state.is_string() || (never_listened && state.is_null()))) {
    return wrong(trace, 1, "\"server_after\" or \"final_state\" is missing");
  }
  if (!never_listened) {
    recording.listening_since = std::chrono::duration_cast<Duration>(
        since.get<double>() * std::chrono::duration<double, std::milli>{1});
  }
  recording.end = after.get<std::string>();
  if (recording.end == "ended") return recording;
  recording.end += ' ';
  recording.end += state.is_string() ? state.get<std::string>()
                                     : std::string{to_string(State::kEmergencyStopped)};
  return recording;
}

Server make_server(const Recording& recording, std::uint32_t late_repairs) {
  ArmPort arm{BenchArm{recording.arm}};
  if (recording.is_arm_missing) arm.unplug();
  return Server{std::move(arm), {.late_repairs = late_repairs}};
}

/// The moment on the server's clock that is 0 in the recording: the server begins to listen 50 ms
/// and one look at the arm after its last attempt to open it, and attempts are repeated.
Instant start_of(const Recording& recording) {
  constexpr Duration kOpening = pace::kOpen + 4 * 600us;
  if (!recording.listening_since) return {};
  auto listens = at(kOpening);
  while (listens.time_since_epoch() < *recording.listening_since) {
    listens += pace::kOpen + pace::kRetryAtStart;
  }
  return listens - *recording.listening_since;
}

/// One recording on its way through a server.
class Player {
 public:
  Player(const Trace& trace, const Recording& recording, std::uint32_t late_repairs)
      : trace_{trace}, server_{make_server(recording, late_repairs)}, start_{start_of(recording)} {
    server_.advance_to(start_);
  }

  /// Answers what the player stumbled over.
  std::optional<Problem> play(const Onlooker<Server>& watch = {}) {
    for (const auto& event : trace_.events) {
      const auto is_good = event.dir == "from_device" ? expect(event) : take(event);
      if (!is_good) {
        return Problem{ErrorCode::kMalformed, fmt::format("{}:{}", trace_.path, event.line),
                       "not a line that a kinovazed recording can have"};
      }
      if (watch) watch(server_, event.time);
      line_before_ = event.time;
    }
    arrive();
    collect();
    return std::nullopt;
  }

  [[nodiscard]] std::uint32_t repair_races() const noexcept { return server_.repair_races(); }

  [[nodiscard]] Replayed result(const Recording& recording) {
    Replayed replayed{std::move(recorded_), {}};
    for (auto& event : actual_) {
      const auto close = closed_.find(event.id);
      const bool is_unseen =
          close != closed_.end() && event.dir != "connect" && event.time >= close->second;
      if (!is_unseen) replayed.actual.push_back(std::move(event));
    }
    drop_surplus_at_the_end(replayed);
    TraceEvent end;
    end.line = 1;  // the header says it
    end.dir = "end";
    end.name = recording.end;
    replayed.recorded.push_back(end);
    end.name = life_name(server_.life());
    if (server_.life() != Server::Life::kEnded) {
      end.name += fmt::format(" {}", to_string(server_.state()));
    }
    replayed.actual.push_back(end);
    return replayed;
  }

 private:
  static std::string_view life_name(Server::Life life) {
    switch (life) {
      case Server::Life::kHung:
        return "hung";
      case Server::Life::kEnded:
        return "ended";
      default:
        return "running";
    }
  }

  bool expect(const TraceEvent& event) {
    ++awaited_[event.id];
    record(event);
    return true;
  }

  void record(const TraceEvent& event) {
    auto copy = event;
    copy.value = microseconds(at(event.time - stimulus_recorded_));
    recorded_.push_back(std::move(copy));
  }

  bool take(const TraceEvent& event) {
    const auto json = Json::parse(event.json.empty() ? "{}" : event.json, nullptr, false);
    const auto text = json.is_object() ? json.value("text", Json{}) : Json{};
    const auto name = text.is_string() ? text.get<std::string>() : "";
    if (event.dir == "disconnect" && name.starts_with("device-")) {
      ++awaited_[event.id];
      auto end = event;
      end.name = "end";  // end-of-file and reset count as one: unread bytes decide which it is
      record(end);
      return true;
    }
    if (event.dir == "note" && name != kTerminateNote) return true;
    wait_for_turn(event);
    stimulus_recorded_ = event.time;
    stimulus_ = now_;
    if (event.dir == "connect") return connect(event, name);
    if (event.dir == "to_device") return send(event);
    if (event.dir == "disconnect") return disconnect(event, name);
    if (event.dir == "arm") return change_arm(json);
    if (event.dir == "note") server_.terminate(now_);
    return event.dir == "note";
  }

  /// Lets what was recorded so far arrive, and time pass as it did.
  void wait_for_turn(const TraceEvent& event) {
    arrive();
    const auto due = start_ + event.time.time_since_epoch();
    now_ = std::max({now_, due, arrived_ + (event.time - line_before_)});
    if (now_ > reached_) {
      server_.advance_to(now_);
      collect();
    }
    reached_ = now_;
    arrived_ = now_;
  }

  void arrive() {
    const auto patience = std::max(now_, start_ + line_before_.time_since_epoch()) + kPatience;
    while (!has_arrived()) {
      const auto next = server_.next_event();
      if (!next || *next > patience) break;
      server_.advance_to(*next);
      collect();
      now_ = reached_ = std::max(now_, *next);
      arrived_ = now_;
    }
  }

  [[nodiscard]] bool has_arrived() const {
    return std::ranges::all_of(awaited_, [&](const auto& entry) {
      const auto [connection, count] = entry;
      const auto came = came_.find(connection);
      return came != came_.end() && came->second >= count;
    });
  }

  void collect() {
    for (const auto& sent : server_.sent()) {
      TraceEvent event;
      event.time = at(sent.time - start_);
      event.id = number_of(sent.connection);
      event.value = microseconds(at(sent.time - stimulus_));
      event.dir = sent.kind == SessionEvent::Kind::kData ? "from_device" : "disconnect";
      event.name = sent.kind == SessionEvent::Kind::kData ? "" : "end";
      event.bytes = sent.bytes;
      ++came_[event.id];
      actual_.push_back(std::move(event));
    }
    server_.clear_sent();
  }

  bool connect(const TraceEvent& event, const std::string& outcome) {
    if (outcome != "ok" && outcome != "refused") return false;
    auto expected = event;
    expected.name = outcome;
    expected.json.clear();
    recorded_.push_back(expected);
    const auto id = server_.connect(now_);
    expected.name = id ? "ok" : "refused";
    connections_[event.id] = id;
    expected.time = at(now_ - start_);
    actual_.push_back(std::move(expected));
    return true;
  }

  bool send(const TraceEvent& event) {
    const auto id = connections_.find(event.id);
    if (id == connections_.end()) return false;
    if (id->second) server_.receive(now_, *id->second, event.bytes);
    return true;
  }

  bool disconnect(const TraceEvent& event, std::string_view how) {
    const auto id = connections_.find(event.id);
    if (id == connections_.end()) return false;
    if (!id->second) return how.starts_with("client-");
    if (how == "client-half-close") {
      server_.half_close(now_, *id->second);
      return true;
    }
    closed_[event.id] = at(now_ - start_);
    if (how == "client-close") server_.close(now_, *id->second);
    if (how == "client-reset") server_.reset(now_, *id->second);
    return how == "client-close" || how == "client-reset";
  }

  bool change_arm(const Json& json) {
    const auto event = json.value("event", Json{});
    const auto whole = [&](const char* key, int otherwise) {
      const auto found = json.find(key);
      return found != json.end() && found->is_number_integer() ? found->get<int>() : otherwise;
    };
    bool is_good = true;
    server_.touch(now_, [&](ArmPort& arm) {
      if (event == "fail") {
        const auto call = json.value("call", Json{});
        const auto name = call.is_string() ? call.get<std::string>() : "";
        const auto known = find_word<ArmCall>(kArmCallNames, name);
        is_good = known.has_value();
        if (known) arm.fail(*known, {whole("skip", 0), whole("count", 1)});
      } else if (event == "clear_failures") {
        arm.clear_failures();
      } else if (event == "unplug") {
        arm.unplug();
      } else if (event == "plug") {
        arm.plug();
      } else if (event == "current" && json.value("value", Json{}).is_number()) {
        std::get<BenchArm>(arm.plant()).set_current_sum(json["value"].get<float>());
      } else if (event == "mode") {
        std::get<BenchArm>(arm.plant()).set_mode(static_cast<ArmMode>(whole("value", 0)));
      } else {
        is_good = false;
      }
    });
    return is_good;
  }

  [[nodiscard]] std::uint32_t number_of(ConnectionId id) const {
    const auto found =
        std::ranges::find(connections_, id, [](const auto& entry) { return entry.second; });
    return found == connections_.end() ? id : found->first;
  }

  /// What came in the last moments may have come behind the end of the recording.
  void drop_surplus_at_the_end(Replayed& replayed) const {
    const auto end = at(now_ - start_) - kGrace;
    std::map<std::uint32_t, std::size_t> wanted;
    for (const auto& event : replayed.recorded) ++wanted[event.id];
    std::map<std::uint32_t, std::size_t> seen;
    std::erase_if(replayed.actual, [&](const TraceEvent& event) {
      return ++seen[event.id] > wanted[event.id] && event.time >= end;
    });
  }

  const Trace& trace_;
  Server server_;
  Instant start_;                ///< 0 of the recording, on the server's clock
  Instant now_ = start_;         ///< on the server's clock
  Instant reached_ = start_;     ///< by the server
  Instant arrived_ = start_;     ///< when the line before was carried out or came
  Instant line_before_{};        ///< in the recording
  Instant stimulus_ = start_;    ///< the last line of a client or the arm
  Instant stimulus_recorded_{};  ///< the same in the recording
  std::map<std::uint32_t, std::size_t> awaited_;
  std::map<std::uint32_t, std::size_t> came_;
  std::map<std::uint32_t, std::optional<ConnectionId>> connections_;  ///< none: refused
  std::map<std::uint32_t, Instant> closed_;
  std::vector<TraceEvent> recorded_;
  std::vector<TraceEvent> actual_;
};

}  // namespace

Outcome<DefectiveServer> set_up(const Trace& recording) {
  return read_header(recording).map([](const Recording& header) {
    return DefectiveServer{
        make_server(header, 0), {}, Instant{-start_of(header).time_since_epoch()}};
  });
}

DeviceTouches touches_of(std::string_view event) {
  if (text_in(event, "dir") != "arm") return {};
  const auto what = text_in(event, "event");
  if (what == "plug") return {{"arm.plugged", 1}};
  if (what == "unplug") return {{"arm.plugged", 0}};
  if (what == "mode") return {{"arm.mode", number_in(event, "value", 0)}};
  if (what == "current") return {{"arm.current", std::llround(real_in(event, "value", 0) * 1000)}};
  if (what == "fail" && number_in(event, "skip", 0) == 0) {
    return {{"arm.fail." + text_in(event, "call"), number_in(event, "count", 1)}};
  }
  DeviceTouches touches;
  if (what == "clear_failures") {
    for (const auto& call : kArmCallNames) touches.push_back({fmt::format("arm.fail.{}", call), 0});
  }
  return touches;
}

Outcome<Replayed> replay_watched(const Trace& trace, const Onlooker<Server>& watch) {
  const auto recording = read_header(trace);
  if (!recording) return tl::unexpected{recording.error()};
  Player player{trace, *recording, 0};
  if (auto failure = player.play(watch)) return tl::unexpected{*std::move(failure)};
  return player.result(*recording);
}

Outcome<Replayed> replay(const Trace& trace) {
  const auto recording = read_header(trace);
  if (!recording) return tl::unexpected{recording.error()};
  if (!trace.events.empty() && trace.events.back().time > at(kLongest)) {
    return wrong(trace, trace.events.back().line, "it is longer than an hour");
  }
  Player player{trace, *recording, 0};
  if (auto failure = player.play()) return tl::unexpected{*std::move(failure)};
  auto replayed = player.result(*recording);
  // Where threads of the original race, either order is right.
  const auto orders = std::uint32_t{1} << std::min(player.repair_races(), kMostRaces);
  for (std::uint32_t late_repairs = 1; late_repairs < orders; ++late_repairs) {
    if (!session_difference(replayed.recorded, replayed.actual)) break;
    Player other{trace, *recording, late_repairs};
    if (other.play()) break;
    auto another = other.result(*recording);
    if (!session_difference(another.recorded, another.actual)) return another;
  }
  return replayed;
}

std::string write(std::string_view line, const TraceEvent& actual) {
  using Ordered = nlohmann::ordered_json;
  auto json = Ordered::parse(line.empty() ? "{}" : line, nullptr, /*allow_exceptions=*/false);
  if (actual.dir == "end") {
    const auto blank = actual.name.find(' ');
    json["server_after"] = actual.name.substr(0, blank);
    if (blank != std::string::npos) json["final_state"] = actual.name.substr(blank + 1);
  } else if (actual.dir == "connect") {
    json["text"] = actual.name;
  } else {
    // Rounded up: what comes just before a client's line must not seem to come after it.
    json["t_ms"] =
        std::chrono::ceil<std::chrono::milliseconds>(actual.time).time_since_epoch().count();
    json["dir"] = actual.dir;
    json["conn"] = actual.id;
    if (actual.dir == "from_device") {
      json["hex"] = to_hex(actual.bytes);
    } else {
      json["text"] = "device-eof";
    }
  }
  return json.dump();
}

}  // namespace armjig::kinovazed::replay
