// SPDX-License-Identifier: Apache-2.0
// Which faults there are, how they are called, and what they change.
#include <algorithm>
#include <array>
#include <utility>

#include "emulators/morap/defects/defects.hpp"
#include "harness/core/nearest.hpp"
#include "harness/wire/morap/fields.hpp"

namespace armjig::morap::emulation {
namespace {

using Spoil = void (*)(NodeSetup& setup);

template <bool Law::* habit>
constexpr Spoil kOtherwise = [](NodeSetup& setup) { setup.law.*habit = !(setup.law.*habit); };

constexpr std::array kLaws{
    Named<Spoil>{"voltage-limit-24", [](NodeSetup& s) { s.law.voltage_limit = 24.0F; }},
    Named<Spoil>{"voltage-limit-19", [](NodeSetup& s) { s.law.voltage_limit = 19.0F; }},
    Named<Spoil>{"rounding-down", [](NodeSetup& s) { s.law.rounding = 0.0F; }},
    Named<Spoil>{"rounding-up", [](NodeSetup& s) { s.law.rounding = 0.99F; }},
    Named<Spoil>{"unfiltered-speed",
                 [](NodeSetup& s) {
                   s.law.newest_speed_share = 1.0F;
                   s.law.older_speed_share = 0.0F;
                 }},
    Named<Spoil>{"slow-speed-filter",
                 [](NodeSetup& s) {
                   s.law.newest_speed_share = 0.1F;
                   s.law.older_speed_share = 0.9F;
                 }},
    Named<Spoil>{"idle-rate-100", [](NodeSetup& s) { s.law.idle_rate_hz = 100; }},
    Named<Spoil>{"idle-rate-250", [](NodeSetup& s) { s.law.idle_rate_hz = 250; }},
    Named<Spoil>{"undelayed-output", kOtherwise<&Law::delays_output>},
    Named<Spoil>{"unlimited-loops", kOtherwise<&Law::limits_loops>},
    Named<Spoil>{"unbounded-above", kOtherwise<&Law::bounds_voltage_above>},
    Named<Spoil>{"unbounded-below", kOtherwise<&Law::bounds_voltage_below>},
    Named<Spoil>{"unlimited-torque", kOtherwise<&Law::limits_torque>},
    Named<Spoil>{"limited-direct-voltage", kOtherwise<&Law::limits_direct_voltage>},
    Named<Spoil>{"uncompensated-torque", kOtherwise<&Law::compensates_motion>},
    Named<Spoil>{"wind-up", kOtherwise<&Law::holds_integrators>},
    Named<Spoil>{"negative-gain", kOtherwise<&Law::integrates_negative_gain>},
    Named<Spoil>{"mode-without-reset", kOtherwise<&Law::resets_with_mode>},
    Named<Spoil>{"parameters-without-reset", kOtherwise<&Law::resets_with_parameters>},
    Named<Spoil>{"reference-with-reset", kOtherwise<&Law::resets_with_reference>},
    Named<Spoil>{"history-without-reference", kOtherwise<&Law::begins_with_reference>},
    Named<Spoil>{"history-without-angle", kOtherwise<&Law::begins_with_angle>},
    Named<Spoil>{"drives-uncalibrated", kOtherwise<&Law::runs_uncalibrated>},
    Named<Spoil>{"parameters-at-once", kOtherwise<&Law::waits_with_parameters>},
    Named<Spoil>{"acts-at-once", kOtherwise<&Law::acts_at_ticks>},
    Named<Spoil>{"fixed-rate", kOtherwise<&Law::changes_rate>},
};

template <float MotorConstants::* constant>
constexpr Spoil kLarger = [](NodeSetup& setup) { setup.eeprom.motor.*constant *= 1.1F; };
template <ControllerSet Eeprom::* set, Coefficients ControllerSet::* filter>
constexpr Spoil kLargerFirst =
    [](NodeSetup& setup) { ((setup.eeprom.*set).*filter).values[0] += 0.5F; };
template <ControllerSet Eeprom::* set>
constexpr Spoil kDoubleRate = [](NodeSetup& setup) { (setup.eeprom.*set).rate_hz *= 2; };

constexpr std::array kConstants{
    Named<Spoil>{"resistance", kLarger<&MotorConstants::resistance>},
    Named<Spoil>{"inductance", kLarger<&MotorConstants::inductance>},
    Named<Spoil>{"torque-constant", kLarger<&MotorConstants::torque_constant>},
    Named<Spoil>{"gear-ratio", kLarger<&MotorConstants::gear_ratio>},
    Named<Spoil>{"friction", kLarger<&MotorConstants::friction>},
    Named<Spoil>{"efficiency", kLarger<&MotorConstants::efficiency>},
    Named<Spoil>{"rated-current", kLarger<&MotorConstants::rated_current>},
    Named<Spoil>{"pulses-per-turn", kLarger<&MotorConstants::pulses_per_turn>},
    Named<Spoil>{"position-rate", kDoubleRate<&Eeprom::position>},
    Named<Spoil>{"position-d", kLargerFirst<&Eeprom::position, &ControllerSet::d>},
    Named<Spoil>{"position-c", kLargerFirst<&Eeprom::position, &ControllerSet::c>},
    Named<Spoil>{"position-f", kLargerFirst<&Eeprom::position, &ControllerSet::f>},
    Named<Spoil>{"position-integral", [](NodeSetup& s) { s.eeprom.position.integral = 0.1F; }},
    Named<Spoil>{"speed-rate", kDoubleRate<&Eeprom::speed>},
    Named<Spoil>{"speed-d", kLargerFirst<&Eeprom::speed, &ControllerSet::d>},
    Named<Spoil>{"speed-c", kLargerFirst<&Eeprom::speed, &ControllerSet::c>},
    Named<Spoil>{"speed-f", kLargerFirst<&Eeprom::speed, &ControllerSet::f>},
    Named<Spoil>{"speed-integral", [](NodeSetup& s) { s.eeprom.speed.integral = 0.0F; }},
    Named<Spoil>{"marker", [](NodeSetup& s) { s.eeprom.marker = 0; }},
    Named<Spoil>{"node", [](NodeSetup& s) { ++s.eeprom.node; }},
};

template <bool Profile::* difference>
constexpr Spoil kTurned =
    [](NodeSetup& setup) { setup.profile.*difference = !(setup.profile.*difference); };
constexpr std::array kDifferences{
    Named<Spoil>{"has-brake", kTurned<&Profile::has_brake>},
    Named<Spoil>{"has-undocumented", kTurned<&Profile::has_undocumented>},
    Named<Spoil>{"refuses-other-kinds", kTurned<&Profile::refuses_other_kinds>},
    Named<Spoil>{"refuses-zero-rate", kTurned<&Profile::refuses_zero_rate>},
    Named<Spoil>{"refuses-unstable-tuning", kTurned<&Profile::refuses_unstable_tuning>},
};

/// A pen that goes where it should but for one angle.
template <int wrong, int instead>
constexpr int (*kOneOff)(Bytes) = [](Bytes command) {
  const int degrees = pen::servo_degrees(command);
  return degrees == wrong ? instead : degrees;
};

using SpoilPen = void (*)(PenSetup& setup);
constexpr std::array kPens{
    Named<SpoilPen>{"elsewhere", [](PenSetup& pen) { ++pen.address; }},
    Named<SpoilPen>{"boots-deployed",
                    [](PenSetup& pen) { pen.degrees_at_boot = pen::kDeployedDegrees; }},
    Named<SpoilPen>{"deploys-less",
                    [](PenSetup& pen) { pen.degrees = kOneOff<pen::kDeployedDegrees, 9>; }},
    Named<SpoilPen>{"retracts-less",
                    [](PenSetup& pen) { pen.degrees = kOneOff<pen::kRetractedDegrees, 44>; }},
    Named<SpoilPen>{"position-of-27", [](PenSetup& pen) { pen.degrees = kOneOff<27, 26>; }},
    Named<SpoilPen>{"missing-position-deploys",
                    [](PenSetup& pen) {
                      pen.degrees = [](Bytes command) {
                        const bool is_missing = command.size() == 1 && command[0] == std::byte{7};
                        return is_missing ? pen::kDeployedDegrees : pen::servo_degrees(command);
                      };
                    }},
    Named<SpoilPen>{"unknown-deploys",
                    [](PenSetup& pen) {
                      pen.degrees = [](Bytes command) {
                        const bool is_unknown = command[0] > std::byte{7};
                        return is_unknown ? pen::kDeployedDegrees : pen::servo_degrees(command);
                      };
                    }},
    Named<SpoilPen>{"poke-retracts", [](PenSetup& pen) { pen.retracts_when_poked = true; }},
    Named<SpoilPen>{"dark-lamp", [](PenSetup& pen) { pen.has_lamp1 = false; }},
    Named<SpoilPen>{"takes-surplus", [](PenSetup& pen) { pen.hangs_on_surplus = false; }},
    Named<SpoilPen>{"slow-buttons", [](PenSetup& pen) { pen.poll_period *= 2; }},
};

constexpr std::array kStatuses{
    Named<MotorStatus>{"needs-calibration", MotorStatus::kNeedsCalibration},
    Named<MotorStatus>{"disabled", MotorStatus::kDisabled},
    Named<MotorStatus>{"enabled", MotorStatus::kEnabled}};
constexpr std::array kActions{
    Named<std::optional<CommandId>>{"ignored", std::nullopt},
    Named<std::optional<CommandId>>{"disable", CommandId::kDisable},
    Named<std::optional<CommandId>>{"forget", CommandId::kCalibrationUnknown},
    Named<std::optional<CommandId>>{"calibrate-zero", CommandId::kCalibrateZero}};

constexpr std::array kFieldKinds{
    Named<Fault::Kind>{"zero", Fault::Kind::kZero},
    Named<Fault::Kind>{"stuck", Fault::Kind::kStuck},
    Named<Fault::Kind>{"stale", Fault::Kind::kStale},
    Named<Fault::Kind>{"off-by-one", Fault::Kind::kOffByOne},
    Named<Fault::Kind>{"doubled", Fault::Kind::kDoubled},
    Named<Fault::Kind>{"swap-bytes", Fault::Kind::kSwapBytes},
    Named<Fault::Kind>{"reverse-bits", Fault::Kind::kReverseBits},
};

// Each reads what stands behind its word and the colon. False: there is no such thing.
using Add = bool (*)(std::string_view text, NodeSetup& setup, Defects& defects);

/// `KIND:MESSAGE.FIELD`, where MESSAGE is a name in `table`.
bool add_field(std::string_view text, const auto& table, auto key,
               std::vector<FieldFault>& faults) {
  const auto* const kind = find_named(kFieldKinds, take_until(text, ':'));
  const auto message =
      std::ranges::find(table, take_until(text, '.'), [](const auto& info) { return info.name; });
  if (kind == nullptr || message == table.end() || text.empty()) return false;
  faults.push_back({(*message).*key, kind->meaning, std::string{text}});
  return true;
}
bool add_heard(std::string_view text, NodeSetup&, Defects& defects) {
  return add_field(text, commands(), &CommandInfo::id, defects.heard);
}
bool add_sent(std::string_view text, NodeSetup&, Defects& defects) {
  return add_field(text, readings(), &ReadInfo::selector, defects.sent);
}
bool add_row(std::string_view text, NodeSetup&, Defects& defects) {
  const auto* const status = find_named(kStatuses, take_until(text, '.'));
  const auto* const command = find_named(commands(), take_until(text, '.'));
  const auto* const action = find_named(kActions, text);
  if (status == nullptr || command == nullptr || action == nullptr) return false;
  defects.rows.push_back({status->meaning, command->id, action->meaning});
  return true;
}
template <const auto& table>
bool add_spoilt(std::string_view text, NodeSetup& setup, Defects&) {
  const auto* const found = find_named(table, text);
  if (found != nullptr) found->meaning(setup);
  return found != nullptr;
}
bool add_pen(std::string_view text, NodeSetup& /*setup*/, Defects& defects) {
  const auto* const found = find_named(kPens, text);
  if (found != nullptr) found->meaning(defects.pen);
  return found != nullptr;
}

bool add_quirk(std::string_view text, NodeSetup&, Defects& defects) {
  return choose_named(quirks(), text, defects.quirks);
}
bool add_rare(std::string_view text, NodeSetup&, Defects& defects) {
  return choose_named(rare_quirks(), text, defects.quirks);
}

constexpr std::array kWords{Named<Add>{"in", add_heard},
                            Named<Add>{"out", add_sent},
                            Named<Add>{"row", add_row},
                            Named<Add>{"law", add_spoilt<kLaws>},
                            Named<Add>{"eeprom", add_spoilt<kConstants>},
                            Named<Add>{"profile", add_spoilt<kDifferences>},
                            Named<Add>{"quirk", add_quirk},
                            Named<Add>{"rare", add_rare},
                            Named<Add>{"pen", add_pen}};

// The list of all.

/// Fields of commands and answers, with the usual number of coefficients.
std::vector<std::string> fields_of(Payload payload) {
  switch (payload) {
    case Payload::kNone:
      return {};
    case Payload::kFloat:
      return {"value"};
    case Payload::kTuneRequest:
      return {"kind", "inertia", "pole"};
    case Payload::kControllerSet:
      break;
  }
  return {"kind", "rate", "d.0", "d.1", "c.0", "c.1", "f.0", "integral"};
}

bool is_byte(std::string_view field) noexcept {
  const auto reading = std::ranges::find(readings(), field, &ReadInfo::name);
  const bool is_byte_reading = reading != readings().end() && reading->kind == ReadKind::kByte;
  return field == "kind" || field == "checksum" || is_byte_reading;
}

class List {
 public:
  template <class Table>
  void add_all(std::string_view word, const Table& table, std::string_view section) {
    for (const auto& one : table) add({word, ":", one.name}, section);
  }
  void add_fields(std::string_view word, std::string_view message,
                  const std::vector<std::string>& fields, std::string_view section) {
    for (const auto& field : fields) {
      for (const auto& kind : kFieldKinds) {
        if (kind.meaning == Fault::Kind::kSwapBytes && is_byte(field)) continue;
        add({word, ":", kind.name, ":", message, ".", field}, section);
      }
    }
  }
  void add_rows() {
    constexpr std::array<std::string_view, 11> kCommands{
        "disable",        "position",           "speed",
        "voltage",        "direct_voltage",     "torque",
        "calibrate_zero", "calibrate_angle",    "calibration_unknown",
        "program",        "default_controllers"};
    for (const auto& status : kStatuses) {
      for (const auto command : kCommands) {
        const auto id = find_named(commands(), command)->id;
        for (const auto& action : kActions) {
          if (action.meaning == id) continue;
          add({"row:", status.name, ".", command, ".", action.name}, "Status");
        }
      }
    }
  }
  void add(std::initializer_list<std::string_view> parts, std::string_view section) {
    std::string name;
    for (const auto part : parts) name += part;
    all_.push_back({std::move(name), std::string{section}});
  }
  [[nodiscard]] std::vector<NamedFault> take() { return std::move(all_); }

 private:
  std::vector<NamedFault> all_;
};

}  // namespace

Outcome<void> add_fault(std::string_view text, NodeSetup& setup, Defects& defects) {
  auto rest = text;
  const auto* const word = find_named(kWords, take_until(rest, ':'));
  if (word != nullptr && word->meaning(rest, setup, defects)) return {};
  std::string words = "it begins with one of:";
  for (const auto& one : kWords) words.append(" ").append(one.name).append(":");
  return problem(ErrorCode::kBadValue, "fault '" + std::string{text} + "'",
                 did_you_mean(text, all_faults(), &NamedFault::name) + words);
}

std::vector<NamedFault> all_faults() {
  List list;
  for (const auto& info : commands()) {
    list.add_fields("in", info.name, fields_of(info.payload),
                    info.payload == Payload::kTuneRequest     ? "Tuning"
                    : info.payload == Payload::kControllerSet ? "Programming"
                                                              : "References");
  }
  for (const auto& info : readings()) {
    const bool is_set = info.kind == ReadKind::kControllerSet;
    auto fields = is_set ? fields_of(Payload::kControllerSet)
                         : std::vector<std::string>{std::string{info.name}};
    if (is_set) fields.emplace_back("checksum");
    list.add_fields("out", info.name, fields, "Reading");
  }
  list.add_rows();
  list.add_all("law", kLaws, "Control law");
  list.add_all("eeprom", kConstants, "Stored figures");
  list.add_all("profile", kDifferences, "Profile");
  for (const auto& quirk : quirks()) list.add({"quirk:", quirk.name}, quirk.section);
  list.add_all("pen", kPens, "Pen");
  return list.take();
}

}  // namespace armjig::morap::emulation
