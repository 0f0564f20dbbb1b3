// SPDX-License-Identifier: Apache-2.0
// Which faults there are, how they are called, and what they change.
#include <algorithm>
#include <array>
#include <utility>

#include "emulators/parol6/defects/defects.hpp"
#include "harness/core/nearest.hpp"
#include "harness/wire/parol6/fields.hpp"

namespace armjig::parol6::emulation {
namespace {

constexpr std::array kStates{Named<BoardState>{"enabled", BoardState::kEnabled},
                             Named<BoardState>{"disabled", BoardState::kDisabled},
                             Named<BoardState>{"homing", BoardState::kHoming}};

constexpr std::array kCodes{Named<Command>{"demo", Command::kDemo},
                            Named<Command>{"home", Command::kHome},
                            Named<Command>{"enable", Command::kEnable},
                            Named<Command>{"disable", Command::kDisable},
                            Named<Command>{"clear", Command::kClearError},
                            Named<Command>{"jog", Command::kJog},
                            Named<Command>{"go-to", Command::kGoTo},
                            Named<Command>{"idle", Command::kIdle},
                            Named<Command>{"unknown", kUnknown}};

using Switch = bool BoardProfile::*;
constexpr std::array kSwitches{
    Named<Switch>{"resynchronises", &BoardProfile::resynchronises},
    Named<Switch>{"acts-on-each-frame", &BoardProfile::acts_on_each_frame},
    Named<Switch>{"minds-silence", &BoardProfile::minds_silence},
    Named<Switch>{"rests-when-idle", &BoardProfile::rests_when_idle},
    Named<Switch>{"homes-once", &BoardProfile::homes_once},
    Named<Switch>{"homes-afresh", &BoardProfile::homes_afresh},
    Named<Switch>{"has-demo", &BoardProfile::has_demo},
    Named<Switch>{"remembers-set-points", &BoardProfile::remembers_set_points},
    Named<Switch>{"bounds-current", &BoardProfile::bounds_current},
    Named<Switch>{"reports-gripper", &BoardProfile::reports_gripper},
    Named<Switch>{"reports-position-errors", &BoardProfile::reports_position_errors},
    Named<Switch>{"bounds-speeds", &BoardProfile::bounds_speeds},
    Named<Switch>{"disables-at-estop", &BoardProfile::disables_at_estop},
    Named<Switch>{"stops-at-bounds", &BoardProfile::stops_at_bounds}};

using SpoilHoming = void (*)(HomingParameters& figures);
constexpr std::array kHomingFigures{
    Named<SpoilHoming>{"level",
                       [](HomingParameters& f) { f.pressed_level = opposite(f.pressed_level); }},
    Named<SpoilHoming>{"seek-speed", [](HomingParameters& f) { f.seek_speed.value *= 2; }},
    Named<SpoilHoming>{"seek-sense", [](HomingParameters& f) { f.seek_speed.value *= -1; }},
    Named<SpoilHoming>{"back-off-target",
                       [](HomingParameters& f) { f.back_off_target.value *= 2; }},
    Named<SpoilHoming>{"back-off-speed", [](HomingParameters& f) { f.back_off_speed.value *= 2; }},
    Named<SpoilHoming>{"slow-seek-speed",
                       [](HomingParameters& f) { f.slow_seek_speed.value *= 2; }},
    Named<SpoilHoming>{"acceleration", [](HomingParameters& f) { f.acceleration.value *= 2; }},
    Named<SpoilHoming>{"final-target",
                       [](HomingParameters& f) { f.standby_from_switch.value += 100; }},
    Named<SpoilHoming>{"standby", [](HomingParameters& f) { f.standby.value += 1; }}};

using SpoilDemo = void (*)(DemoParameters& figures);
constexpr std::array kDemoFigures{
    Named<SpoilDemo>{"maximum", [](DemoParameters& f) { f.max_speed_and_acceleration *= 2; }},
    Named<SpoilDemo>{"out", [](DemoParameters& f) { f.out.value += 100; }},
    Named<SpoilDemo>{"back", [](DemoParameters& f) { f.back.value += 1; }}};

std::optional<std::size_t> joint_of(std::string_view text) noexcept {
  if (text.size() != 2 || text[0] != 'j' || text[1] < '1' || text[1] > '6') return std::nullopt;
  return static_cast<std::size_t>(text[1] - '1');
}

// Each reads what stands behind its word and the colon. False: there is no such thing.
using Add = bool (*)(std::string_view text, ArmOptions& arm, Defects& defects);

bool add_row(std::string_view text, ArmOptions& /*arm*/, Defects& defects) {
  const auto* const state = find_named(kStates, take_until(text, '.'));
  const auto* const code = find_named(kCodes, take_until(text, '.'));
  const auto* const action = find_named(kCodes, text);
  if (state == nullptr || code == nullptr || (action == nullptr && text != "kept")) return false;
  defects.rows.push_back({state->meaning, code->meaning,
                          action != nullptr ? std::optional{action->meaning} : std::nullopt});
  return true;
}

bool add_deaf(std::string_view text, ArmOptions& /*arm*/, Defects& defects) {
  const auto what = take_until(text, '.');
  const auto* const code = find_named(kCodes, text);
  if (code == nullptr || (what != "outputs" && what != "gripper")) return false;
  defects.deaf.push_back(
      {what == "outputs" ? DeafFields::What::kOutputs : DeafFields::What::kGripper, code->meaning});
  return true;
}

bool add_ears(std::string_view text, ArmOptions& /*arm*/, Defects& defects) {
  const auto* const found = find_named(ear_defects(), text);
  if (found != nullptr) defects.ears = found->defect;
  return found != nullptr;
}

bool add_quirk(std::string_view text, ArmOptions& /*arm*/, Defects& defects) {
  return choose_named(quirks(), text, defects.quirks);
}

bool add_rare(std::string_view text, ArmOptions& /*arm*/, Defects& defects) {
  return choose_named(rare_quirks(), text, defects.quirks);
}

bool add_profile(std::string_view text, ArmOptions& arm, Defects& /*defects*/) {
  const auto* const found = find_named(kSwitches, text);
  if (found == nullptr) return false;
  auto& choice = arm.profile.*found->meaning;
  choice = !choice;
  return true;
}

bool add_homing(std::string_view text, ArmOptions& arm, Defects& /*defects*/) {
  const auto joint = joint_of(take_until(text, '.'));
  const auto* const figure = find_named(kHomingFigures, text);
  if (!joint || figure == nullptr) return false;
  figure->meaning(arm.figures.homing[*joint]);
  return true;
}

bool add_demo(std::string_view text, ArmOptions& arm, Defects& /*defects*/) {
  const auto joint = joint_of(take_until(text, '.'));
  const auto* const figure = find_named(kDemoFigures, text);
  if (!joint || figure == nullptr) return false;
  figure->meaning(arm.figures.demo[*joint]);
  return true;
}

/// The axis turns the other way, so its switch is where the board never gets.
bool add_plant(std::string_view text, ArmOptions& arm, Defects& /*defects*/) {
  const auto what = take_until(text, '.');
  const auto joint = joint_of(text);
  if (what != "mirrored" || !joint) return false;
  auto& axis = arm.plant.axes[*joint];
  axis.limit.threshold = axis.position + axis.position - axis.limit.threshold;
  axis.limit.side = axis.limit.side == LimitSwitch::Side::kAtOrBelow
                        ? LimitSwitch::Side::kAtOrAbove
                        : LimitSwitch::Side::kAtOrBelow;
  return true;
}

bool add_timer(std::string_view text, ArmOptions& arm, Defects& /*defects*/) {
  if (text == "15") arm.timing.timer_bits = 15;
  if (text == "8") arm.timing.timer_bits = 8;
  return text == "15" || text == "8";
}

bool add_check(std::string_view text, ArmOptions& arm, Defects& /*defects*/) {
  constexpr std::array kPolicies{Named<CheckPolicy>{"d4", CheckPolicy::kBoardOnly},
                                 Named<CheckPolicy>{"d4-or-e4", CheckPolicy::kBoardOrHost}};
  const auto* const found = find_named(kPolicies, text);
  if (found != nullptr) arm.profile.check = found->meaning;
  return found != nullptr;
}

constexpr std::array kWords{Named<Add>{"row", add_row},         Named<Add>{"deaf", add_deaf},
                            Named<Add>{"ears", add_ears},       Named<Add>{"quirk", add_quirk},
                            Named<Add>{"profile", add_profile}, Named<Add>{"homing", add_homing},
                            Named<Add>{"demo", add_demo},       Named<Add>{"plant", add_plant},
                            Named<Add>{"timer", add_timer},     Named<Add>{"check", add_check},
                            Named<Add>{"rare", add_rare}};

// The list of all.

bool is_number(const Field& field) noexcept {
  return field.encoding == Encoding::kSigned || field.encoding == Encoding::kUnsigned;
}

std::string_view section_of(const Field& field, std::string_view otherwise) noexcept {
  if (field.name.starts_with("gripper")) return "Gripper";
  if (field.name == "in_out" || field.name == "io") return "Inputs and outputs";
  if (field.name == "homed") return "Homing";
  if (field.name == "timing") return "Timing";
  return otherwise;
}

class List {
 public:
  void add(std::string name, std::string_view section) {
    all_.push_back({std::move(name), std::string{section}});
  }

  void add_fields(std::string_view prefix, std::span<const Field> fields,
                  std::string_view section) {
    for (const auto& field : fields) {
      const auto own = section_of(field, section);
      for (const auto* kind : kinds_for(field)) {
        add(std::string{prefix}.append(kind).append(":").append(field.name), own);
      }
      if (field.encoding != Encoding::kBits) continue;
      for (int bit = 7; bit >= 0; --bit) {
        for (const auto* kind : {"bit-low:", "bit-high:"}) {
          add(std::string{prefix}.append(kind).append(field.name) + "." + std::to_string(bit), own);
        }
      }
    }
    for (std::size_t i = 0; i + 1 < fields.size(); ++i) {
      const auto& one = fields[i];
      const auto& other = fields[i + 1];
      if (one.width != other.width || !is_number(one) || !is_number(other)) continue;
      add(std::string{prefix}.append("swapped:").append(one.name).append("+").append(other.name),
          section_of(one, section));
    }
  }

  void add_rows() {
    for (const auto& state : kStates) {
      for (const auto& code : kCodes) {
        for (const auto* action : {"unknown", "kept", "idle", "disable"}) {
          if (code.name == action) continue;
          add(std::string{"row:"}.append(state.name).append(".").append(code.name).append(".") +
                  action,
              "Commands");
        }
      }
    }
  }

  template <class Table>
  void add_joints(std::string_view word, const Table& table, std::string_view section) {
    for (int joint = 1; joint <= 6; ++joint) {
      for (const auto& figure : table) {
        add(std::string{word}.append(":j") + std::to_string(joint) + "." + std::string{figure.name},
            section);
      }
    }
  }

  [[nodiscard]] std::vector<NamedFault> take() { return std::move(all_); }

 private:
  /// Kinds that change something whatever the encoding.
  static std::vector<const char*> kinds_for(const Field& field) {
    switch (field.encoding) {
      case Encoding::kSigned:
        return {"zero", "stuck", "stale", "off-by-one", "doubled", "negated", "swap-bytes"};
      case Encoding::kUnsigned:
      case Encoding::kCode:
        return {"zero", "stuck", "stale", "off-by-one", "reverse-bits"};
      case Encoding::kBits:
        return {"stuck", "stale", "reverse-bits"};
      default:  // nothing else is in the board's messages
        return {"off-by-one"};
    }
  }

  std::vector<NamedFault> all_;
};

/// Literals, the check byte and whatever nobody reads make no difference in what a board hears.
std::vector<Field> heard_fields() {
  constexpr std::array<std::string_view, 5> kUnread{"start", "length", "check", "end",
                                                    "affected_joints"};
  std::vector<Field> fields;
  std::ranges::copy_if(command_fields(), std::back_inserter(fields), [&](const Field& field) {
    return std::ranges::find(kUnread, field.name) == kUnread.end();
  });
  return fields;
}

}  // namespace

Outcome<void> add_fault(std::string_view text, ArmOptions& arm, Defects& defects,
                        std::vector<Fault>& sent) {
  constexpr std::string_view kHeard = "in.";
  if (text.starts_with(kHeard)) {
    auto fault = parse_fault(text.substr(kHeard.size()), command_fields());
    if (!fault) return tl::unexpected{fault.error()};
    if (fault->is_about_field()) {
      defects.heard.push_back(*fault);
      return {};
    }
  } else if (const auto* word = find_named(kWords, text.substr(0, text.find(':')))) {
    auto rest = text;
    (void)take_until(rest, ':');
    if (word->meaning(rest, arm, defects)) return {};
  } else {
    auto fault = parse_fault(text, telemetry_fields());
    if (!fault) return tl::unexpected{fault.error()};
    sent.push_back(*fault);
    return {};
  }
  return problem(ErrorCode::kBadValue, "fault '" + std::string{text} + "'",
                 did_you_mean(text, all_faults(), &NamedFault::name) +
                     "armjig conformance mutants parol6 --list names all there are");
}

std::vector<NamedFault> all_faults() {
  List list;
  list.add_fields("", telemetry_fields(), "Telemetry");
  list.add_fields("in.", heard_fields(), "Command frame");
  for (const auto* name : {"late", "missing", "twice", "unasked", "cut-short", "loses-splits"}) {
    list.add(name, "Link");
  }
  for (const auto& ears : ear_defects()) list.add("ears:" + std::string{ears.name}, "Receiving");
  list.add_rows();
  for (const auto& code : kCodes) {
    list.add("deaf:outputs." + std::string{code.name}, "Inputs and outputs");
    list.add("deaf:gripper." + std::string{code.name}, "Gripper");
  }
  for (const auto& one : kSwitches) list.add("profile:" + std::string{one.name}, "Profile");
  for (const auto& quirk : quirks()) list.add("quirk:" + std::string{quirk.name}, quirk.section);
  list.add_joints("homing", kHomingFigures, "Homing");
  list.add_joints("demo", kDemoFigures, "Demonstration");
  for (int joint = 1; joint <= 6; ++joint) {
    list.add("plant:mirrored.j" + std::to_string(joint), "Homing");
  }
  for (const auto* name : {"check:d4", "check:d4-or-e4"}) list.add(name, "Receiving");
  list.add("timer:15", "Timing");
  list.add("timer:8", "Timing");
  return list.take();
}

}  // namespace armjig::parol6::emulation
