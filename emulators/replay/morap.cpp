// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/morap.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/defects/defects.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/morap/pen.hpp"
#include "emulators/replay/kept_record.hpp"
#include "emulators/replay/watched.hpp"
#include "emulators/replay/wrong_key.hpp"
#include "harness/core/hex.hpp"

namespace armjig::morap::replay {
namespace {

using namespace emulation;
using Json = nlohmann::json;

class Reader : public WrongKey {
 public:
  double number(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found != object.end() && found->is_number()) return found->get<double>();
    complain(key);
    return 0.0;
  }

  std::int64_t integer(const Json& object, const char* key, std::int64_t least, std::int64_t most) {
    const auto found = object.find(key);
    const bool is_there = found != object.end() && found->is_number_integer();
    const double value = is_there ? found->get<double>() : -1e300;
    if (value >= static_cast<double>(least) && value <= static_cast<double>(most)) {
      return found->get<std::int64_t>();
    }
    complain(key);
    return least;
  }

  std::string text(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found != object.end() && found->is_string()) return found->get<std::string>();
    complain(key);
    return {};
  }

  bool flag(const Json& object, const char* key) { return integer(object, key, 0, 1) == 1; }

  std::vector<std::byte> bytes(const Json& object, const char* key) {
    auto bytes = from_hex(text(object, key));
    if (bytes) return *std::move(bytes);
    complain(key);
    return {};
  }
};

PlantParameters read_plant(Reader& reader, const Json& json) {
  constexpr std::int64_t kLongestStep = 1'000'000;
  PlantParameters plant;
  plant.step = reader.integer(json, "dt_us", 1, kLongestStep) * kClocksPerMicrosecond;
  plant.resistance = reader.number(json, "R");
  plant.inductance = reader.number(json, "L");
  plant.torque_constant = reader.number(json, "K");
  plant.gear_ratio = reader.number(json, "n");
  plant.efficiency = reader.number(json, "eta");
  plant.inertia = reader.number(json, "J");
  plant.viscous_friction = reader.number(json, "b");
  plant.dry_friction = reader.number(json, "tau_c");
  plant.load_torque = reader.number(json, "tau_load");
  plant.counts_per_radian = reader.number(json, "counts_per_rad");
  return plant;
}

/// The bus of a recording, and where on it the device with each address is.
class Bench {
 public:
  void attach(const NodeSetup& setup) {
    const Node node{setup};
    nodes_[node.address()] = bus_.attach(node);
  }
  void attach_pen() { pen_ = bus_.attach(Pen{}); }

  [[nodiscard]] Node* node(std::uint8_t address) {
    const auto found = nodes_.find(address);
    return found == nodes_.end() ? nullptr : &bus_.device<Node>(found->second);
  }
  [[nodiscard]] Pen* pen() { return pen_ ? &bus_.device<Pen>(*pen_) : nullptr; }
  [[nodiscard]] i2c::Bus& bus() noexcept { return bus_; }

  /// Lets nodes do one tick after the other.
  void tick_until(Instant time) {
    for (const auto& [address, place] : nodes_) {
      auto& node = bus_.device<Node>(place);
      while (node.next_tick() < time) node.advance_to(node.next_tick());
    }
  }

 private:
  i2c::Bus bus_;
  std::map<std::uint8_t, std::size_t> nodes_;
  std::optional<std::size_t> pen_;
};

/// The timing of the emulated bus is that of the recordings.
void check_timing(Reader& reader, const Json& header) {
  const auto bus = header.value("bus", Json{});
  if (!bus.is_object()) return reader.complain("bus");
  reader.integer(bus, "start_us", 10, 10);
  reader.integer(bus, "byte_us", 90, 90);
  reader.integer(bus, "stop_us", 10, 10);
}

/// What is on the bus of a recording, in its order; none: a pen.
using Setups = std::vector<std::optional<NodeSetup>>;

NodeSetup read_node(Reader& reader, const Json& json) {
  NodeSetup setup;
  const auto eeprom = json.value("eeprom", Json::object());
  const auto image = reader.bytes(eeprom, "words_le_hex");
  if (image.size() != kEepromSize) {
    reader.complain("words_le_hex");
    return setup;
  }
  setup.eeprom = decode_eeprom(Bytes{image}.first<kEepromSize>());
  const auto plant = json.value("plant", Json{});
  if (plant.is_object()) setup.plant = read_plant(reader, plant);
  return setup;
}

Setups read_nodes(Reader& reader, const Json& nodes) {
  Setups setups;
  if (!nodes.is_array()) reader.complain("nodes");
  for (const auto& node : nodes) {
    if (!node.is_object()) {
      reader.complain("nodes");
    } else if (node.value("kind", Json{}) == "pen") {
      setups.emplace_back();
    } else {
      setups.emplace_back(read_node(reader, node));
    }
  }
  return setups;
}

Outcome<Setups> read_header(const Trace& trace) {
  const auto header = Json::parse(trace.header, nullptr, /*allow_exceptions=*/false);
  Reader reader;
  check_timing(reader, header);
  Setups setups;
  if (trace.device == "morap-pen") {
    setups.emplace_back();
  } else if (trace.device == "morap-node") {
    setups.emplace_back(read_node(reader, header));
  } else {
    setups = read_nodes(reader, header.value("nodes", Json{}));
  }
  if (!reader.wrong_key().empty()) return reader.refuse(trace);
  return setups;
}

Bench make_bench(const Setups& setups) {
  Bench bench;
  for (const auto& setup : setups) setup ? bench.attach(*setup) : bench.attach_pen();
  return bench;
}

char letter(const BusReply& reply) noexcept {
  return reply.outcome == BusReply::Outcome::kAck ? 'A' : 'N';
}

/// One line of a recording and what is to be compared of it.
class Operation {
 public:
  Operation(const TraceEvent& event, Bench& bench)
      : event_{event},
        bench_{bench},
        json_(Json::parse(event.json, nullptr, /*allow_exceptions=*/false)) {}

  /// Does it. False if it is none that a MORAP recording has.
  bool run(Replayed& replayed) {
    if (event_.dir == "advance") return true;
    address_ = static_cast<std::uint8_t>(reader_.integer(json_, "addr", 0, 127));
    if (event_.dir == "write" || event_.dir == "read") {
      transfer(replayed, event_.dir == "read");
    } else if (event_.dir == "state") {
      compare_state(replayed);
    } else {
      stimulate();
    }
    return reader_.wrong_key().empty();
  }

 private:
  void transfer(Replayed& replayed, bool is_read) {
    auto recorded = copy_without_details();
    auto actual = recorded;
    recorded.text = "ack " + reader_.text(json_, "ack");
    const auto address = bench_.bus().start(event_.time, address_, is_read);
    actual.text = fmt::format("ack {}", letter(address));
    auto end = address.end;
    if (letter(address) == 'A') end = is_read ? read(end, actual) : write(end, actual);
    if (json_.value("stop", Json(true)) != false) bench_.bus().stop(end);
    if (is_read) mask(recorded, actual);
    replayed.add(std::move(recorded), std::move(actual));
  }

  Instant write(Instant time, TraceEvent& actual) {
    for (const auto byte : event_.bytes) {
      const auto reply = bench_.bus().write(time, byte);
      actual.text += letter(reply);
      time = reply.end;
    }
    return time;
  }

  Instant read(Instant time, TraceEvent& actual) {
    constexpr std::int64_t kLongestRead = 1'000'000;
    for (auto left = reader_.integer(json_, "n", 0, kLongestRead); left > 0; --left) {
      const auto reply = bench_.bus().read(time);
      actual.bytes.push_back(reply.byte);
      time = reply.end;
    }
    return time;
  }

  void mask(TraceEvent& recorded, TraceEvent& actual) {
    recorded.bytes = event_.bytes;
    if (!json_.contains("mask")) return;
    const auto mask = reader_.bytes(json_, "mask");
    for (std::size_t i = 0; i < mask.size(); ++i) {
      if (i < recorded.bytes.size()) recorded.bytes[i] &= mask[i];
      if (i < actual.bytes.size()) actual.bytes[i] &= mask[i];
    }
  }

  void compare_state(Replayed& replayed) {
    auto* pen = bench_.pen();
    if (pen == nullptr) return reader_.complain("addr");
    pen->advance_to(event_.time);
    const auto in_words = [](std::int64_t servo, bool lamp1, bool lamp2, const std::string& said) {
      return fmt::format("servo {} led1 {:d} led2 {:d} serial {}", servo, lamp1, lamp2,
                         to_hex(std::as_bytes(std::span{said})));
    };
    auto recorded = copy_without_details();
    auto actual = recorded;
    recorded.text =
        in_words(reader_.integer(json_, "servo_deg", -360, 360), reader_.flag(json_, "led1"),
                 reader_.flag(json_, "led2"), reader_.text(json_, "serial"));
    actual.text = in_words(pen->servo_degrees(), pen->lamp1(), pen->lamp2(), pen->take_console());
    replayed.add(std::move(recorded), std::move(actual));
  }

  void stimulate() {
    auto* const node = bench_.node(address_);
    if (event_.dir == "input" && bench_.pen() != nullptr) {
      const bool deploys = reader_.flag(json_, "but1");
      bench_.pen()->press(event_.time, deploys, reader_.flag(json_, "but2"));
    } else if (node == nullptr) {
      reader_.complain("addr");
    } else if (event_.dir == "encoder") {
      node->turn_encoder(event_.time, static_cast<std::int32_t>(
                                          reader_.integer(json_, "delta", INT32_MIN, INT32_MAX)));
    } else if (event_.dir == "adc") {
      node->set_conversion(
          event_.time, static_cast<std::uint16_t>(reader_.integer(json_, "value", 0, kFullScale)));
    } else if (event_.dir == "restart") {
      node->restart(event_.time);
    } else {
      reader_.complain("op");
    }
  }

  [[nodiscard]] TraceEvent copy_without_details() const {
    TraceEvent event;
    event.line = event_.line;
    event.time = event_.time;
    event.dir = fmt::format("{} {:02X}", event_.dir, address_);
    return event;
  }

  const TraceEvent& event_;
  Bench& bench_;
  Json json_;
  Reader reader_;
  std::uint8_t address_ = 0;
};

enum class Ticks : std::uint8_t { kSkipIdle, kEach };

Outcome<Replayed> replay(const Trace& trace, Ticks ticks, const Onlooker<i2c::Bus>& watch = {}) {
  const auto setups = read_header(trace);
  if (!setups) return tl::unexpected{setups.error()};
  auto bench = make_bench(*setups);
  Replayed replayed;
  for (const auto& event : trace.events) {
    if (ticks == Ticks::kEach) bench.tick_until(event.time);
    if (!Operation{event, bench}.run(replayed)) {
      return problem(ErrorCode::kMalformed, fmt::format("{}:{}", trace.path, event.line),
                     "not a line that a morap recording can have");
    }
    if (watch) watch(bench.bus(), event.time);
  }
  return replayed;
}

}  // namespace

Outcome<i2c::Bus> set_up(const Trace& recording) {
  return read_header(recording).map([](const Setups& setups) {
    i2c::Bus bus;
    for (const auto& setup : setups) {
      if (setup) {
        bus.attach(DefectiveNode{*setup, {}}, i2c::name_at(node_address(setup->eeprom.node)));
      } else {
        bus.attach(Pen{}, i2c::name_at(PenSetup{}.address));
      }
    }
    return bus;
  });
}

DeviceTouches touches_of(std::string_view line) {
  const auto what = text_in(line, "op");
  const auto number = [line](const char* key) { return number_in(line, key, 0); };
  const auto of = i2c::name_at(static_cast<std::uint8_t>(number("addr"))) + '.';
  if (what == "adc") return {{of + "adc", number("value")}};
  if (what == "encoder") return {{of + "encoder", number("delta")}};
  if (what == "restart") return {{of + "power", 1}};
  if (what == "input") return {{of + "deploy", number("but1")}, {of + "retract", number("but2")}};
  return {};
}

Outcome<Replayed> replay(const Trace& trace) { return replay(trace, Ticks::kSkipIdle); }
Outcome<Replayed> replay_plainly(const Trace& trace) { return replay(trace, Ticks::kEach); }
Outcome<Replayed> replay_watched(const Trace& trace, const Onlooker<i2c::Bus>& watch) {
  return replay(trace, Ticks::kSkipIdle, watch);
}

std::string write(std::string_view line, const TraceEvent& actual) {
  auto json = nlohmann::ordered_json::parse(line, nullptr, /*allow_exceptions=*/false);
  std::istringstream words{actual.text};
  const auto next = [&words] {
    std::string name;
    std::string value;
    words >> name >> value;
    return value;
  };
  if (actual.dir.starts_with("state")) {
    json["servo_deg"] = std::stoi(next());
    json["led1"] = std::stoi(next());
    json["led2"] = std::stoi(next());
    const auto printed = from_hex(next()).value_or(std::vector<std::byte>{});
    json["serial"] = as_text(printed);
  } else {
    json["ack"] = next();
    if (actual.dir.starts_with("read")) json["hex"] = to_hex(actual.bytes);
  }
  return json.dump();
}

}  // namespace armjig::morap::replay
