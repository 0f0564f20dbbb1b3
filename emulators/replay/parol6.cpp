// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/parol6.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "emulators/parol6/board.hpp"
#include "emulators/replay/kept_record.hpp"
#include "emulators/replay/watched.hpp"
#include "emulators/replay/wrong_key.hpp"
#include "harness/core/hex.hpp"

namespace armjig::parol6::replay {
namespace {

using namespace emulation;
using Json = nlohmann::json;

struct Recording {
  BoardTiming timing;
  Plant plant;
  Instant end{};
  bool has_can = false;
};

class HeaderReader : public WrongKey {
 public:
  template <class Integer>
  Integer integer(const Json& object, const char* key, Integer least, Integer most) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number_integer()) {
      complain(key);
      return least;
    }
    const bool fits = found->is_number_unsigned()
                          ? std::in_range<Integer>(found->get<std::uint64_t>())
                          : std::in_range<Integer>(found->get<std::int64_t>());
    const auto value = fits ? found->get<Integer>() : Integer{};
    if (!fits || value < least || value > most) complain(key);
    return std::clamp(value, least, most);
  }

  Level level(const Json& object, const char* key) {
    return integer<int>(object, key, 0, 1) == 1 ? Level::kHigh : Level::kLow;
  }
};

void read_joint(HeaderReader& reader, const Json& json, Plant& plant) {
  if (!json.is_object()) return reader.complain("plant.joints");
  const auto j = reader.integer<std::size_t>(json, "joint", 1, kJointCount) - 1;
  auto& axis = plant.axes[j];
  axis.position = Steps{reader.integer<std::int32_t>(json, "start", INT32_MIN, INT32_MAX)};
  axis.limit.threshold =
      Steps{reader.integer<std::int32_t>(json, "threshold", INT32_MIN, INT32_MAX)};
  axis.limit.closed_level = reader.level(json, "active_level");
  const auto side = json.value("side", Json{});
  if (side == "<=") {
    axis.limit.side = LimitSwitch::Side::kAtOrBelow;
  } else if (side == ">=") {
    axis.limit.side = LimitSwitch::Side::kAtOrAbove;
  } else {
    reader.complain("side");
  }
}

Plant read_plant(HeaderReader& reader, const Json& header) {
  Plant plant;
  const auto json = header.value("plant", Json::object());
  const auto joints = json.is_object() ? json.value("joints", Json{}) : Json{};
  const auto inputs = json.is_object() ? json.value("inputs", Json{}) : Json{};
  if (!joints.is_array() || joints.size() != kJointCount) {
    reader.complain("plant.joints");
    return plant;
  }
  for (const auto& joint : joints) read_joint(reader, joint, plant);
  if (!inputs.is_object()) {
    reader.complain("plant.inputs");
    return plant;
  }
  plant.inputs.in1 = reader.level(inputs, "in1");
  plant.inputs.in2 = reader.level(inputs, "in2");
  plant.inputs.estop = reader.level(inputs, "estop");
  return plant;
}

Outcome<Recording> read_header(const Trace& trace) {
  const auto header = Json::parse(trace.header, nullptr, /*allow_exceptions=*/false);
  HeaderReader reader;
  Recording recording;
  recording.timing.pass_period =
      std::chrono::microseconds{reader.integer<std::uint32_t>(header, "loop_us", 1, 1'000'000)};
  recording.timing.micros_at_start =
      reader.integer<std::uint32_t>(header, "micros_at_t0", 0, UINT32_MAX);
  recording.timing.timer_at_start =
      Ticks{reader.integer<std::uint32_t>(header, "tim2_at_t0", 0, UINT32_MAX)};
  recording.timing.timer_bits = reader.integer<std::uint8_t>(header, "tim2_bits", 1, 32);
  // "Passes start while virtual time is below": the last moment is just before.
  const auto duration_us =
      reader.integer<std::int64_t>(header, "duration_us", 0, INT64_C(9'000'000'000'000'000));
  recording.end = at(std::chrono::microseconds{duration_us} - Duration{1});
  recording.plant = read_plant(reader, header);
  const auto can = header.value("can_recorded", Json(false));
  if (!can.is_boolean()) reader.complain("can_recorded");
  recording.has_can = can == true;
  if (!reader.wrong_key().empty()) return reader.refuse(trace);
  return recording;
}

Level Inputs::* input_named(std::string_view name) noexcept {
  if (name == "in1") return &Inputs::in1;
  if (name == "in2") return &Inputs::in2;
  if (name == "estop") return &Inputs::estop;
  return nullptr;
}

/// Hands one line to the board. False if it is none that a PAROL6 recording has.
bool apply(const TraceEvent& event, Board& board) {
  if (event.dir == "to_device") {
    board.receive(event.time, event.bytes);
    return true;
  }
  if (event.dir == "input") {
    const auto input = input_named(event.name);
    if (input == nullptr) return false;
    const auto level = event.value == 0 ? Level::kLow : Level::kHigh;
    board.touch(event.time, [&](Plant& plant) { plant.inputs.*input = level; });
    return true;
  }
  if (event.dir == "can_to_device") {
    CanFrame frame;
    if (event.id > 0x7FF || event.bytes.size() > frame.data.size()) return false;
    frame.id = static_cast<std::uint16_t>(event.id);
    frame.size = static_cast<std::uint8_t>(event.bytes.size());
    std::ranges::copy(event.bytes, frame.data.begin());
    board.receive_can(event.time, frame);
    return true;
  }
  return event.dir == "from_device" || event.dir == "can_from_device";
}

TraceEvent as_event(const Emission& emission) {
  TraceEvent event;
  event.time = emission.time;
  if (const auto* can = std::get_if<CanFrame>(&emission.what)) {
    event.dir = "can_from_device";
    event.id = can->id;
    event.bytes.assign(can->payload().begin(), can->payload().end());
  } else {
    const auto& telemetry = std::get<TelemetryBytes>(emission.what);
    event.dir = "from_device";
    event.bytes.assign(telemetry.begin(), telemetry.end());
  }
  return event;
}

enum class Passes : std::uint8_t { kInClosedForm, kEach };

Outcome<Replayed> replay(const Trace& trace, Passes passes, const Onlooker<Board>& watch = {}) {
  const auto recording = read_header(trace);
  if (!recording) return tl::unexpected{recording.error()};
  Replayed replayed;
  Board board{recording->plant, recording->timing};
  if (passes == Passes::kEach) board.use_plain_loop();
  for (const auto& event : trace.events) {
    const bool is_stimulus_in_time = event.time <= recording->end;
    if (is_stimulus_in_time && !apply(event, board)) {
      return problem(ErrorCode::kMalformed, fmt::format("{}:{}", trace.path, event.line),
                     "not a line that a parol6 recording can have");
    }
    if (watch && is_stimulus_in_time) watch(board, event.time);
    const bool is_reaction =
        event.dir == "from_device" || (recording->has_can && event.dir == "can_from_device");
    if (is_reaction) replayed.recorded.push_back(event);
  }
  board.advance_to(recording->end);
  // A pass that had begun is recorded to its end.
  if (const auto wake = board.wakes_at()) board.advance_to(*wake);
  for (const auto& emission : board.sent()) {
    if (!recording->has_can && std::holds_alternative<CanFrame>(emission.what)) continue;
    replayed.actual.push_back(as_event(emission));
  }
  return replayed;
}

}  // namespace

Outcome<DefectiveArm> set_up(const Trace& recording) {
  return read_header(recording).map([](const Recording& header) {
    const ArmOptions arm{.plant = header.plant, .timing = header.timing, .gripper = std::nullopt};
    return DefectiveArm{arm, {}};
  });
}

DeviceTouches touches_of(std::string_view line) {
  if (text_in(line, "dir") != "can_to_device") return {};
  const auto bytes = from_hex(text_in(line, "hex"));
  if (!bytes || bytes->size() > CanFrame{}.data.size()) return {};
  std::uint64_t data = 0;
  for (std::size_t i = 0; i < bytes->size(); ++i) {
    data |= std::to_integer<std::uint64_t>((*bytes)[i]) << (56 - 8 * i);
  }
  const auto size = static_cast<std::int64_t>(bytes->size());
  return {{"can.data", static_cast<std::int64_t>(data)},
          {"can.frame", 16 * number_in(line, "id", 0) + size}};
}

Outcome<Replayed> replay(const Trace& trace) { return replay(trace, Passes::kInClosedForm); }
Outcome<Replayed> replay_plainly(const Trace& trace) { return replay(trace, Passes::kEach); }
Outcome<Replayed> replay_watched(const Trace& trace, const Onlooker<Board>& watch) {
  return replay(trace, Passes::kInClosedForm, watch);
}

}  // namespace armjig::parol6::replay
