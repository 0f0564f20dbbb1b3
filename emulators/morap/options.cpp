// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/options.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

namespace armjig::morap::emulation {
namespace {

/// Tells whether there is such a fault.
Outcome<void> check_fault(std::string_view text) {
  NodeSetup setup;
  Defects defects;
  return add_fault(text, setup, defects);
}

/// What options, or the keys of one table of a file, have said.
struct Settings {
  std::optional<std::vector<std::uint8_t>> ids;
  std::optional<bool> has_pen;
  std::string file;
  NodeSettings node;
  PenSetup pen;
  std::uint8_t address{};
  double celsius = 20.0;
};

constexpr auto kTable = std::to_array<DeviceOption<Settings>>({
    // Of the bus.
    {{"nodes", "0..16,...", "identifiers of the nodes; 2 if not given"},
     [](Settings& to, const OptionValue& value) {
       to.ids.emplace();
       return value.each([&](const auto& one) { return one.take(to.ids->emplace_back()); })
           .and_then([&]() -> Outcome<void> {
             auto ids = *to.ids;
             std::ranges::sort(ids);
             if (std::ranges::adjacent_find(ids) == ids.end()) return {};
             return value.take(problem(ErrorCode::kBadValue, "",
                                       "a node is said twice; two with one number are for file="));
           });
     }},
    {{"pen", "yes|no", "whether there is a pen end-effector; no if not given"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.has_pen, {true, false});
     }},
    {{"file", "NODES.toml",
      "what is on the bus, as `armjig lab exec` takes it; no nodes and pen then"},
     [](Settings& to, const OptionValue& value) { return value.take(to.file); }},
    // Of all nodes, and of each in a file.
    {{"motor", "dcx22l|dcx26l", "of nodes; if not given, node 1 has the second, others the first"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.node.motor, {&kDcx22l, &kDcx26l});
     }},
    {{"profile", "firmware|documented",
      "the shipped node (the default), or as the document promises"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.node.profile, {kFirmware, kDocumented});
     }},
    {{"inertia", "1e-5..1000", "at the output shaft in kg m^2; 0.05 if not given"},
     [](Settings& to, const OptionValue& value) { return value.take(to.node.inertia); }},
    {{"viscous", "0..1000", "viscous friction in N m s/rad; 0.1 if not given"},
     [](Settings& to, const OptionValue& value) { return value.take(to.node.viscous); }},
    {{"dry", "0..1000", "dry friction in N m; 0 if not given"},
     [](Settings& to, const OptionValue& value) { return value.take(to.node.dry); }},
    {{"load", "-1000..1000", "constant torque on the shaft in N m; 0 if not given"},
     [](Settings& to, const OptionValue& value) { return value.take(to.node.load); }},
    {{"shunt", "0..1000000", "of the current sense in ohm; 820 if not given, as nodes believe"},
     [](Settings& to, const OptionValue& value) { return value.take(to.node.shunt); }},
    {{"has-shaft", "yes|no", "no: nothing turns, whatever the voltage"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.node.has_shaft, {true, false});
     }},
    {{"fault", "FAULT,...", "defects, as `armjig conformance mutants morap --list` names them"},
     [](Settings& to, const OptionValue& value) {
       to.node.faults.clear();
       return value.take_each([&](std::string_view text) {
         to.node.faults.emplace_back(text);
         return check_fault(text);
       });
     }},
    // In files only.
    {{"id", "0..16", "of a node"},
     [](Settings& to, const OptionValue& value) { return value.take(to.node.id); }},
    {{"hangs", "yes|no", "whether a pen does so on surplus bytes"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.pen.hangs_on_surplus, {true, false});
     }},
    {{"address", "8..119", "of a thermometer; others are reserved"},
     [](Settings& to, const OptionValue& value) { return value.take(to.address); }},
    {{"celsius", "-128..127", "of a thermometer; 20 if not given"},
     [](Settings& to, const OptionValue& value) { return value.take(to.celsius); }},
});
constexpr auto kRows = rows_of(kTable);
constexpr std::size_t kFirstOfNode = 3;
constexpr std::size_t kOptionCount = 12;

/// What may be in a file.
struct Kind {
  std::string_view name;
  std::span<const DeviceOption<Settings>> keys;
  std::string_view needed;
  void (*add)(BusSettings& bus, const Settings& settings);
};
constexpr std::array kKinds{
    Kind{"node", std::span{kTable}.subspan(kFirstOfNode, kOptionCount + 1 - kFirstOfNode), "id",
         [](BusSettings& bus, const Settings& settings) { bus.nodes.push_back(settings.node); }},
    Kind{"pen", std::span{kTable}.subspan(kOptionCount + 1, 1), "",
         [](BusSettings& bus, const Settings& settings) { bus.pens.push_back(settings.pen); }},
    Kind{"thermometer", std::span{kTable}.last(2), "address",
         [](BusSettings& bus, const Settings& settings) {
           bus.thermometers.emplace_back(settings.address).set_temperature(settings.celsius);
         }},
};

/// Puts on the bus what one table of a file describes.
Outcome<void> add(const OptionGroup& group, Settings settings, BusSettings& bus) {
  const auto* const kind = find_named(kKinds, group.kind);
  if (kind == nullptr) {
    return problem(ErrorCode::kBadValue, group.where, "write [[node]], [[pen]] or [[thermometer]]");
  }
  bool is_missing = !kind->needed.empty();
  for (const auto& key : group.keys) {
    auto read = read_options(group.kind, kind->keys, {{key.name, key.value}}, key.where, settings);
    if (!read) return tl::unexpected{std::move(read.error())};
    settings = *std::move(read);
    if (key.name == kind->needed) is_missing = false;
  }
  if (is_missing) {
    return problem(ErrorCode::kBadValue, group.where, std::string{kind->needed} + " is missing");
  }
  kind->add(bus, settings);
  return {};
}

DefectiveNode make_node(const NodeSettings& settings) {
  NodeSetup setup{.eeprom = eeprom_of(settings.known_motor(), settings.id),
                  .profile = settings.profile,
                  .shunt_ohm = settings.shunt};
  auto plant = plant_of(setup.eeprom.motor, settings.inertia, settings.viscous, settings.dry);
  plant.load_torque = settings.load;
  if (settings.has_shaft) setup.plant = plant;
  Defects defects;
  for (const auto& fault : settings.faults) std::ignore = add_fault(fault, setup, defects);
  return DefectiveNode{setup, std::move(defects)};
}

/// The pen that is on the bus with such nodes.
PenSetup pen_beside(const NodeSettings& settings) {
  NodeSetup setup;
  Defects defects;
  for (const auto& fault : settings.faults) std::ignore = add_fault(fault, setup, defects);
  return defects.pen;
}

}  // namespace

const KnownMotor& NodeSettings::known_motor() const noexcept {
  if (motor != nullptr) return *motor;
  return id == 1 ? kDcx26l : kDcx22l;
}

std::span<const OptionRow> options() noexcept { return std::span{kRows}.first(kOptionCount); }

Outcome<BusSettings> read_bus(const DeviceOptions& options, const std::string& where,
                              const OptionFiles& files) {
  const auto settings =
      read_options("morap", std::span{kTable}.first(kOptionCount), options, where, Settings{});
  if (!settings) return tl::unexpected{settings.error()};
  BusSettings bus;
  if (settings->file.empty()) {
    for (const auto id : settings->ids.value_or(std::vector<std::uint8_t>{2})) {
      bus.nodes.push_back(settings->node);
      bus.nodes.back().id = id;
    }
    if (settings->has_pen.value_or(false)) bus.pens.push_back(pen_beside(settings->node));
    return bus;
  }
  if (settings->ids || settings->has_pen) {
    return problem(ErrorCode::kBadValue, where + ", file=" + settings->file,
                   "nodes and pen are said in the file");
  }
  const auto groups = files.read_groups(settings->file);
  if (!groups) return tl::unexpected{groups.error()};
  for (const auto& group : *groups) {
    const auto added = add(group, *settings, bus);
    if (!added) return tl::unexpected{added.error()};
  }
  return bus;
}

i2c::Bus make_bus(const BusSettings& settings) {
  i2c::Bus bus;
  for (const auto& node : settings.nodes) {
    bus.attach(make_node(node), i2c::name_at(node_address(node.id)));
  }
  for (const auto& pen : settings.pens) bus.attach(Pen{pen}, i2c::name_at(pen.address));
  for (const auto& thermometer : settings.thermometers) bus.attach(thermometer);
  return bus;
}

Outcome<i2c::Bus> make(const DeviceOptions& options, const std::string& where,
                       const OptionFiles& files) {
  return read_bus(options, where, files).map(make_bus);
}

}  // namespace armjig::morap::emulation
