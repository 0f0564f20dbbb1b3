// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/morap_bus.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "emulators/i2c/thermometer.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/morap/pen.hpp"
#include "harness/config/toml_table.hpp"
#include "harness/link/emulated_bus_port.hpp"

namespace armjig::morap {
namespace {

/// What hangs on a joint of the vendor's arm, about.
constexpr double kUsualInertia = 0.05;    // kg m^2
constexpr double kUsualViscosity = 0.02;  // N m s/rad

using MakeMotor = Eeprom (*)(std::uint8_t node) noexcept;

template <class T>
struct Named {
  std::string_view name;
  T value;
};
constexpr std::array kMotors{Named<MakeMotor>{"dcx22l", dcx22l},
                             Named<MakeMotor>{"dcx26l", dcx26l}};
constexpr std::array kProfiles{Named<const Profile*>{"firmware", &kFirmware},
                               Named<const Profile*>{"documented", &kDocumented}};
constexpr std::array kAnswers{Named<bool>{"yes", true}, Named<bool>{"no", false}};

template <class Table>
std::string names_of(const Table& table) {
  std::string names;
  for (const auto& entry : table) {
    if (!names.empty()) names += " or ";
    names += entry.name;
  }
  return names;
}

template <class Table>
auto find(const Table& table, std::string_view name)
    -> std::optional<decltype(table.front().value)> {
  for (const auto& entry : table) {
    if (entry.name == name) return entry.value;
  }
  return std::nullopt;
}

MakeMotor usual_motor(std::uint8_t node) noexcept { return node == 1 ? dcx26l : dcx22l; }

// ---- From options

/// The value of an option by its name in a table; `otherwise` if nothing is said.
template <class Table, class T>
Outcome<T> choose(const Table& table, const DeviceOptions& options, const char* option,
                  const std::string& where, T otherwise) {
  const auto said = options.find(option);
  if (said == options.end()) return otherwise;
  if (const auto value = find(table, said->second)) return T{*value};
  return problem(ErrorCode::kBadValue, fmt::format("{}, {}={}", where, option, said->second),
                 fmt::format("write {}", names_of(table)));
}

Outcome<std::vector<std::uint8_t>> parse_nodes(std::string_view text, const std::string& where) {
  std::vector<std::uint8_t> nodes;
  const auto* at = text.data();
  const auto* const end = at + text.size();
  while (true) {
    unsigned node{};
    const auto [stop, error] = std::from_chars(at, end, node);
    const bool is_node = error == std::errc{} && node <= kLastNode;
    if (is_node) nodes.push_back(static_cast<std::uint8_t>(node));
    if (is_node && stop == end) return nodes;
    if (!is_node || *stop != ',') break;
    at = stop + 1;
  }
  return problem(ErrorCode::kBadValue, fmt::format("{}, nodes={}", where, text),
                 "write identifiers from 0 to 16 with commas between, as in nodes=1,2");
}

Outcome<void> check_names(const DeviceOptions& options, const std::string& where) {
  constexpr std::array<std::string_view, 5> kNames{"file", "motor", "nodes", "pen", "profile"};
  for (const auto& [name, value] : options) {
    if (std::ranges::find(kNames, name) == kNames.end()) {
      return problem(ErrorCode::kUnknownOption, fmt::format("{}, {}", where, name),
                     "morap has file, nodes, motor, profile and pen");
    }
  }
  if (options.contains("file") && options.size() > 1) {
    return problem(ErrorCode::kBadValue, where, "with file= everything else is in the file");
  }
  return {};
}

Node usual_node(std::uint8_t id, MakeMotor motor, const Profile& profile) {
  NodeSetup setup;
  setup.eeprom = (motor == nullptr ? usual_motor(id) : motor)(id);
  setup.plant = plant_of(setup.eeprom.motor, kUsualInertia, kUsualViscosity);
  setup.profile = profile;
  return Node{setup};
}

// ---- From a file

void attach_node(i2c::Bus& bus, TomlTable& table) {
  const auto id = table.integer("id", 0, kLastNode);
  if (!id) table.complain("id", "a node needs an id from 0 to 16");
  const auto node = static_cast<std::uint8_t>(id.value_or(0));
  const auto choose = [&table](const auto& names, const char* key, auto otherwise) {
    const auto said = table.text(key);
    if (!said) return otherwise;
    const auto value = find(names, *said);
    if (!value) table.complain(key, fmt::format("{} has to be {}", key, names_of(names)));
    return value.value_or(otherwise);
  };
  const auto at_least = [&table](const char* key, double least, double otherwise) {
    const auto value = table.number(key).value_or(otherwise);
    if (std::isfinite(value) && value >= least) return value;
    table.complain(key, fmt::format("{} has to be at least {}", key, least));
    return otherwise;
  };
  NodeSetup setup;
  setup.eeprom = choose(kMotors, "motor", usual_motor(node))(node);
  setup.profile = *choose(kProfiles, "profile", &kFirmware);
  setup.shunt_ohm = at_least("shunt", 0.0, setup.shunt_ohm);
  constexpr double kLeastInertia = 1e-5;
  auto plant = plant_of(setup.eeprom.motor, at_least("inertia", kLeastInertia, kUsualInertia),
                        at_least("viscous", 0.0, kUsualViscosity), at_least("dry", 0.0, 0.0));
  plant.load_torque = table.number("load").value_or(0.0);
  if (!std::isfinite(plant.load_torque)) table.complain("load", "load has to be finite");
  if (table.boolean("has_shaft").value_or(true)) setup.plant = plant;
  bus.attach(Node{setup});
}

void attach_pen(i2c::Bus& bus, TomlTable& table) {
  PenSetup setup;
  setup.hangs_on_surplus = table.boolean("hangs").value_or(setup.hangs_on_surplus);
  bus.attach(Pen{setup});
}

void attach_thermometer(i2c::Bus& bus, TomlTable& table) {
  constexpr std::int64_t kFirstFree = 0x08;  // the others are reserved
  constexpr std::int64_t kLastFree = 0x77;
  const auto address = table.integer("address", kFirstFree, kLastFree);
  if (!address) table.complain("address", "a thermometer needs an address from 0x08 to 0x77");
  i2c::Thermometer thermometer{static_cast<std::uint8_t>(address.value_or(kFirstFree))};
  const auto celsius = table.number("celsius").value_or(20.0);
  constexpr double kLimit = 128.0;
  if (!(celsius >= -kLimit && celsius < kLimit)) {
    table.complain("celsius", "celsius has to be from -128 to 127");
  } else {
    thermometer.set_temperature(celsius);
  }
  bus.attach(thermometer);
}

Outcome<i2c::Bus> bus_of(Outcome<TomlTable> root) {
  if (!root) return tl::unexpected{root.error()};
  i2c::Bus bus;
  for (auto& table : root->tables("node")) attach_node(bus, table);
  for (auto& table : root->tables("pen")) attach_pen(bus, table);
  for (auto& table : root->tables("thermometer")) attach_thermometer(bus, table);
  if (const auto finished = root->finish(); !finished) return tl::unexpected{finished.error()};
  return bus;
}

}  // namespace

Outcome<i2c::Bus> make_bus(const DeviceOptions& options, const std::string& where) {
  if (const auto checked = check_names(options, where); !checked) {
    return tl::unexpected{checked.error()};
  }
  if (const auto file = options.find("file"); file != options.end()) return read_bus(file->second);
  const auto said = options.find("nodes");
  const auto nodes = parse_nodes(said == options.end() ? "2" : said->second, where);
  if (!nodes) return tl::unexpected{nodes.error()};
  const auto motor = choose(kMotors, options, "motor", where, MakeMotor{nullptr});
  if (!motor) return tl::unexpected{motor.error()};
  const auto profile = choose(kProfiles, options, "profile", where, &kFirmware);
  if (!profile) return tl::unexpected{profile.error()};
  const auto has_pen = choose(kAnswers, options, "pen", where, false);
  if (!has_pen) return tl::unexpected{has_pen.error()};
  i2c::Bus bus;
  for (const auto id : *nodes) bus.attach(usual_node(id, *motor, **profile));
  if (*has_pen) bus.attach(Pen{});
  return bus;
}

Outcome<i2c::Bus> read_bus(const std::string& path) { return bus_of(TomlTable::read(path)); }

Outcome<i2c::Bus> parse_bus(std::string_view text, std::string path) {
  return bus_of(TomlTable::parse(text, std::move(path)));
}

Outcome<std::unique_ptr<BusPort>> open_emulated_bus(const Target& target) {
  auto bus = make_bus(target.options, target.text);
  if (!bus) return tl::unexpected{bus.error()};
  return std::make_unique<EmulatedBusPort<i2c::Bus>>(*std::move(bus));
}

}  // namespace armjig::morap
