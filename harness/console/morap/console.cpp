// SPDX-License-Identifier: Apache-2.0
#include "harness/console/morap/console.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <utility>
#include <vector>

#include "harness/console/morap/view.hpp"
#include "harness/drive/morap/joint.hpp"
#include "harness/drive/morap/parameter_file.hpp"

namespace armjig::morap::console {

using namespace drive;

namespace {

class Console final : public DeviceConsole {
 public:
  Console(Rig<BusPort> rig, const std::string& target, Say say)
      : DeviceConsole{rows(), target, std::move(say)},
        rig_{std::move(rig)},
        master_{rig_.port()},
        joint_{master_, {node_address(2)}} {}

  std::string occupation() override {
    return fmt::format("node {}", node_of(joint_.address().value));
  }
  Instant now() override { return master_.now(); }

 private:
  static std::span<const Row> rows() noexcept;

  Outcome<void> exchange() override {
    master_.wait(std::chrono::milliseconds{10});
    return {};
  }
  Parsed<std::string> state() override {
    const auto view = look_at(master_, joint_.address());
    return view.code == BusCode::kOk ? Parsed<std::string>{to_line(view)} : wrong(why(view.code));
  }
  /// Disables every node that was told to move.
  void stand() override;

  // The commands.
  Read node(Words words);
  void scan();
  Read calibrate(Words words);
  template <CommandId reference>
  Read move(Words words);
  void disable() { tell(joint_.disable(), "disabled"); }
  Read tune(Words words);
  void program(Words words);
  void defaults() { tell(joint_.load_default_controllers(), "loaded"); }
  Read pen(Words words);

  std::string why(BusCode code) const;
  void tell(BusCode code, std::string_view done);
  void tell(const ProgramResult& result);

  Rig<BusPort> rig_;
  Master master_;
  Joint joint_;
  std::vector<BusAddress> moved_;
};

std::span<const DeviceConsole::Row> Console::rows() noexcept {
  using Self = Console;
  static constexpr std::array kRows{
      Row{"node", "ID", "which node the next commands are for", kAlways, run<&Self::node>, ""},
      Row{"scan", "", "who answers", kAlways, run<&Self::scan>, ""},
      Row{"calibrate", "[RAD]", "the shaft is at this angle, 0 if none is said", kAlways,
          run<&Self::calibrate>, ""},
      Row{"goto", "RAD", "go to an angle", kAlways, run<&Self::move<CommandId::kPosition>>, ""},
      Row{"speed", "RAD/S", "turn", kAlways, run<&Self::move<CommandId::kSpeed>>, ""},
      Row{"volt", "V", "drive with a voltage, the current limited", kAlways,
          run<&Self::move<CommandId::kVoltage>>, ""},
      Row{"torque", "NM", "drive with a torque", kAlways, run<&Self::move<CommandId::kTorque>>, ""},
      Row{"disable", "", "let go of the shaft", kAlways, run<&Self::disable>, ""},
      Row{"tune", "pd|pid|pi J W", "let the node compute a controller", kAlways, run<&Self::tune>,
          "pd pid pi"},
      Row{"program", "FILE", "bring the controller of a file into the node", kAlways,
          run<&Self::program>, ""},
      Row{"defaults", "", "load the controllers of its EEPROM", kAlways, run<&Self::defaults>, ""},
      Row{"pen", "deploy|retract|0..255", "move the pen", kAlways, run<&Self::pen>,
          "deploy retract"},
  };
  return kRows;
}

/// At the end, and when somebody is frightened.
void Console::stand() {
  if (moved_.empty()) return say(Tone::kAnswer, "nothing moves");
  for (const auto address : std::exchange(moved_, {})) {
    const bool is_disabled = Joint{master_, address}.disable() == BusCode::kOk;
    const auto node = node_of(address.value);
    say(is_disabled ? Tone::kAnswer : Tone::kFailed,
        is_disabled ? fmt::format("node {} is disabled", node)
                    : fmt::format("node {} cannot be disabled: it may be moving", node));
  }
}

DeviceConsole::Read Console::node(Words words) {
  return parse_whole("node", words[0], 0, kLastNode).map([this](std::int16_t id) {
    joint_ = Joint{master_, {node_address(static_cast<std::uint8_t>(id))}};
    say(Tone::kAnswer, fmt::format("node {}", id));
  });
}

void Console::scan() {
  const auto found = master_.scan();
  if (found.code != BusCode::kOk) return tell(found.code, {});
  std::string text;
  for (const auto address : found.addresses) {
    text += fmt::format("{}0x{:02X}", text.empty() ? "" : " ", address.value);
  }
  say(Tone::kAnswer, text.empty() ? "nobody" : text);
}

DeviceConsole::Read Console::calibrate(Words words) {
  if (words.empty()) {
    tell(joint_.calibrate_zero(), "calibrated");
    return {};
  }
  return parse_float(words[0]).map(
      [this](float angle) { tell(joint_.calibrate(Angle{angle}), "calibrated"); });
}

template <CommandId reference>
DeviceConsole::Read Console::move(Words words) {
  return parse_float(words[0]).map([this](float value) {
    if (std::ranges::find(moved_, joint_.address()) == moved_.end()) {
      moved_.push_back(joint_.address());
    }
    tell(joint_.send({reference, value}), "sent");
  });
}

DeviceConsole::Read Console::tune(Words words) {
  const auto type = tune_kind(words[0]);
  if (!type) return wrong("the type is pd, pid or pi");
  const auto inertia = parse_float(words[1]);
  if (!inertia) return wrong(inertia.error());
  const auto pole = parse_float(words[2]);
  if (!pole) return wrong(pole.error());
  const TuneRequest request{*type, *inertia, *pole};
  if (const auto refusal = refusal_of(request); !refusal.empty()) return wrong(refusal);
  const auto code = joint_.disable();
  if (code != BusCode::kOk) {
    tell(code, {});
  } else {
    tell(joint_.tune(request));
  }
  return {};
}

void Console::program(Words words) {
  const auto set = read_parameters(std::string{words[0]});
  if (!set) return say(Tone::kUnreadable, describe(set.error()));
  if (const auto code = joint_.disable(); code != BusCode::kOk) return tell(code, {});
  tell(joint_.program(*set));
}

DeviceConsole::Read Console::pen(Words words) {
  PenDrive pen{master_};
  if (words[0] == "deploy" || words[0] == "retract") {
    tell(words[0] == "deploy" ? pen.deploy() : pen.retract(), "sent");
    return {};
  }
  return parse_whole("position", words[0], 0, 255).map([&](std::int16_t position) {
    tell(pen.set_position(static_cast<std::uint8_t>(position)), "sent");
  });
}

std::string Console::why(BusCode code) const {
  const auto refusal = rig_.last_refusal();
  return code == BusCode::kForbidden && refusal ? refusal->reason : std::string{describe(code)};
}

void Console::tell(BusCode code, std::string_view done) {
  if (code == BusCode::kOk) return say(Tone::kAnswer, done);
  say(Tone::kFailed, why(code));
}

void Console::tell(const ProgramResult& result) {
  if (result.outcome == ProgramOutcome::kBusFailed) return tell(result.code, {});
  if (result.outcome != ProgramOutcome::kDone) return say(Tone::kFailed, describe(result.outcome));
  auto text = to_toml(result.active);
  text.pop_back();
  say(Tone::kAnswer, text);
}

}  // namespace

Outcome<std::unique_ptr<DeviceConsole>> open(Rig<BusPort> rig, const std::string& target, Say say) {
  return std::make_unique<Console>(std::move(rig), target, std::move(say));
}

}  // namespace armjig::morap::console
