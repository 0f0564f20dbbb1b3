// SPDX-License-Identifier: Apache-2.0
#include "cli/morap_console.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <sstream>
#include <utility>

#include "cli/morap_arguments.hpp"
#include "cli/morap_view.hpp"
#include "emulators/host/buses.hpp"
#include "harness/drive/morap/parameter_file.hpp"

namespace armjig::cli {

using namespace morap;

/// A command with the least number of words behind its name, and the most.
struct MorapConsole::Command {
  std::string_view name;
  std::string_view arguments;
  std::string_view meaning;
  std::size_t least;
  std::size_t most;
  void (*run)(MorapConsole& console, const Words& words);
};

const std::vector<MorapConsole::Command>& MorapConsole::commands() {
  using Console = MorapConsole;
  static const std::vector<Command> kCommands{
      {"node", "ID", "which node the next commands are for", 1, 1,
       [](Console& c, const Words& words) {
         int id = -1;
         const auto& text = words[1];
         const auto end = text.data() + text.size();
         const auto [stop, error] = std::from_chars(text.data(), end, id);
         if (error != std::errc{} || stop != end || id < 0 || id > kLastNode) {
           return c.say_(Tone::kUnreadable, "a node is a number from 0 to 16");
         }
         c.joint_ = Joint{c.master_, {node_address(static_cast<std::uint8_t>(id))}};
         c.say_(Tone::kAnswer, fmt::format("node {}", id));
       }},
      {"scan", "", "who answers", 0, 0,
       [](Console& c, const Words&) {
         const auto found = c.master_.scan();
         if (found.code != BusCode::kOk) return c.tell(found.code, {});
         std::string text;
         for (const auto address : found.addresses) {
           text += fmt::format("{}0x{:02X}", text.empty() ? "" : " ", address.value);
         }
         c.say_(Tone::kAnswer, text.empty() ? "nobody" : text);
       }},
      {"status", "", "what the node says of itself", 0, 0,
       [](Console& c, const Words&) {
         const auto view = look_at(c.master_, c.joint_.address());
         if (view.code != BusCode::kOk) return c.tell(view.code, {});
         c.say_(Tone::kAnswer, to_line(view));
       }},
      {"calibrate", "[RAD]", "the shaft is at this angle, 0 if none is said", 0, 1,
       [](Console& c, const Words& words) {
         float angle = 0.0F;
         if (words.size() > 1 && !c.number(words[1], angle)) return;
         c.tell(words.size() > 1 ? c.joint_.calibrate(Angle{angle}) : c.joint_.calibrate_zero(),
                "calibrated");
       }},
      {"goto", "RAD", "goes to an angle", 1, 1,
       [](Console& c, const Words& words) { c.do_reference(words); }},
      {"speed", "RAD/S", "turns", 1, 1,
       [](Console& c, const Words& words) { c.do_reference(words); }},
      {"volt", "V", "drives with a voltage, the current limited", 1, 1,
       [](Console& c, const Words& words) { c.do_reference(words); }},
      {"torque", "NM", "drives with a torque", 1, 1,
       [](Console& c, const Words& words) { c.do_reference(words); }},
      {"disable", "", "lets go of the shaft", 0, 0,
       [](Console& c, const Words&) { c.tell(c.joint_.disable(), "disabled"); }},
      {"tune", "pd|pid|pi J W", "lets the node compute a controller", 3, 3,
       [](Console& c, const Words& words) { c.do_program(words); }},
      {"program", "FILE", "brings the controller of a file into the node", 1, 1,
       [](Console& c, const Words& words) { c.do_program(words); }},
      {"defaults", "", "the controllers of its EEPROM", 0, 0,
       [](Console& c, const Words&) { c.tell(c.joint_.load_default_controllers(), "loaded"); }},
      {"pen", "deploy|retract|0..255", "moves the pen", 1, 1,
       [](Console& c, const Words& words) { c.do_pen(words); }},
      {"wait", "SECONDS", "lets time pass", 1, 1,
       [](Console& c, const Words& words) {
         constexpr float kLongest = 3600.0F;
         float seconds = 0.0F;
         if (!c.number(words[1], seconds)) return;
         if (!(seconds >= 0.0F && seconds <= kLongest)) {
           return c.say_(Tone::kUnreadable, "from 0 to 3600 seconds");
         }
         c.waits_until_ =
             c.master_.now() + std::chrono::round<Duration>(std::chrono::duration<float>{seconds});
       }},
      {"help", "", "this list", 0, 0,
       [](Console& c, const Words&) {
         std::string text;
         for (const auto& command : commands()) {
           text +=
               fmt::format("{}{:<32} {}", text.empty() ? "" : "\n",
                           fmt::format("{} {}", command.name, command.arguments), command.meaning);
         }
         c.say_(Tone::kAnswer, text);
       }},
      {"quit", "", "disables what moves, and leaves", 0, 0,
       [](Console& c, const Words&) { c.wants_to_quit_ = true; }},
  };
  return kCommands;
}

MorapConsole::MorapConsole(BusRig rig, Say say)
    : rig_{std::move(rig)},
      say_{std::move(say)},
      master_{rig_.port()},
      joint_{master_, {node_address(2)}} {}

Outcome<void> MorapConsole::cycle() {
  constexpr Duration kPeriod = std::chrono::milliseconds{10};
  master_.wait(kPeriod);
  return {};
}

std::string MorapConsole::occupation() {
  return fmt::format("node {}", joint_.address().value - kNodeBaseAddress);
}

void MorapConsole::begin(std::string_view line) {
  std::istringstream in{std::string{line.substr(0, line.find('#'))}};
  Words words;
  for (std::string word; in >> word;) words.push_back(word);
  if (words.empty()) return;
  const auto found = std::ranges::find(commands(), words[0], &Command::name);
  if (found == commands().end()) {
    return say_(Tone::kUnreadable,
                fmt::format("there is no command '{}'; 'help' lists them", words[0]));
  }
  const auto count = words.size() - 1;
  if (count < found->least || count > found->most) {
    return say_(Tone::kUnreadable, fmt::format("write: {} {}", found->name, found->arguments));
  }
  found->run(*this, words);
}

void MorapConsole::do_reference(const Words& words) {
  float value = 0.0F;
  if (!number(words[1], value)) return;
  moved_.push_back(joint_.address());
  const auto code = words[0] == "goto"    ? joint_.set_position(Angle{value})
                    : words[0] == "speed" ? joint_.set_speed(Speed{value})
                    : words[0] == "volt"  ? joint_.set_voltage(Voltage{value})
                                          : joint_.set_torque(Torque{value});
  tell(code, "sent");
}

void MorapConsole::do_program(const Words& words) {
  if (words[0] == "program") {
    const auto set = read_parameters(words[1]);
    if (!set) return say_(Tone::kUnreadable, describe(set.error()));
    if (const auto code = joint_.disable(); code != BusCode::kOk) return tell(code, {});
    return tell(joint_.program(*set));
  }
  float inertia = 0.0F;
  float pole = 0.0F;
  if (!number(words[2], inertia) || !number(words[3], pole)) return;
  const TuneArguments arguments{words[1], static_cast<double>(inertia), static_cast<double>(pole)};
  const bool has_type = words[1] == "pd" || words[1] == "pid" || words[1] == "pi";
  const auto refusal = has_type ? refusal_of(arguments.request()) : "the type is pd, pid or pi";
  if (!refusal.empty()) return say_(Tone::kUnreadable, refusal);
  if (const auto code = joint_.disable(); code != BusCode::kOk) return tell(code, {});
  tell(joint_.tune(arguments.request()));
}

void MorapConsole::do_pen(const Words& words) {
  constexpr float kDeployed = 255.0F;
  PenDrive pen{master_};
  if (words[1] == "deploy") return tell(pen.deploy(), "sent");
  if (words[1] == "retract") return tell(pen.retract(), "sent");
  float position = 0.0F;
  if (!number(words[1], position)) return;
  if (!(position >= 0.0F && position <= kDeployed)) {
    return say_(Tone::kUnreadable, "a position is 0 to 255");
  }
  tell(pen.set_position(static_cast<std::uint8_t>(position)), "sent");
}

/// At the end, and when somebody is frightened.
void MorapConsole::stop() {
  waits_until_ = {};
  for (const auto address : std::exchange(moved_, {})) {
    if (Joint{master_, address}.disable() == BusCode::kOk) continue;
    say_(Tone::kFailed, fmt::format("node {} cannot be disabled: it may be moving",
                                    address.value - kNodeBaseAddress));
  }
}

void MorapConsole::tell(BusCode code, std::string_view done) {
  if (code == BusCode::kOk) return say_(Tone::kAnswer, done);
  const auto refusal = rig_.last_refusal();
  const bool is_forbidden = code == BusCode::kForbidden && refusal;
  say_(Tone::kFailed, is_forbidden ? refusal->reason : std::string{describe(code)});
}

void MorapConsole::tell(const ProgramResult& result) {
  if (result.outcome == ProgramOutcome::kDone) {
    auto text = to_toml(result.active);
    text.pop_back();
    return say_(Tone::kAnswer, text);
  }
  if (result.outcome == ProgramOutcome::kBusFailed) return tell(result.code, {});
  say_(Tone::kFailed, describe(result.outcome));
}

bool MorapConsole::number(const std::string& word, float& value) {
  const auto* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc{} && stop == end) return true;
  say_(Tone::kUnreadable, fmt::format("'{}' is no number", word));
  return false;
}

std::vector<std::string> MorapConsole::candidates(std::string_view line) const {
  std::vector<std::string> names;
  if (line.find(' ') != std::string_view::npos) return names;
  for (const auto& command : commands()) {
    if (command.name.starts_with(line)) names.push_back(std::string{command.name} + ' ');
  }
  return names;
}

Outcome<std::unique_ptr<DeviceConsole>> open_morap_console(const RigOptions& how,
                                                           const std::string& /*target*/, Say say) {
  auto rig = BusRig::open("morap", how, find_hosted_bus("morap")->open);
  if (!rig) return tl::unexpected{rig.error()};
  return std::make_unique<MorapConsole>(*std::move(rig), std::move(say));
}

}  // namespace armjig::cli
