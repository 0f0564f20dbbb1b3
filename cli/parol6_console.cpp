// SPDX-License-Identifier: Apache-2.0
#include "cli/parol6_console.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "cli/parol6_view.hpp"
#include "harness/drive/parol6/tool_jog.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::cli {
namespace {

using namespace parol6;

/// Even idle frames: the target is not ours any more.
constexpr int kMostRefusals = 3;

/// A way in big steps would be fast: half of what a joint may do at all, halved again for the time
/// in which telemetry lags behind, and never more than its jog.
JointSpeeds fastest_glide() {
  JointSpeeds speeds;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& bounds = kJointBounds[j];
    speeds[j] = std::min(bounds.max_jog, StepsPerSecond{bounds.max_speed.value / 4});
  }
  return speeds;
}

/// What nobody asked about, and what to do about it.
std::string_view news_of(DriveEvent::Kind kind) {
  using Kind = DriveEvent::Kind;
  switch (kind) {
    case Kind::kEstopPressed:
      return "EMERGENCY STOP pressed: nothing moves until it is released and you say 'enable'";
    case Kind::kEstopReleased:
      return "emergency stop released; still latched: say 'enable'";
    case Kind::kLinkSilent:
      return "no telemetry for half a second";
    case Kind::kLinkBack:
      return "telemetry is back";
    case Kind::kNoEffect:
    case Kind::kNothingMoved:
    case Kind::kStillMoves:
    case Kind::kTookEffect:
    case Kind::kHomed:
      break;
  }
  return {};
}

bool is_trouble(DriveEvent::Kind kind) {
  using Kind = DriveEvent::Kind;
  return kind == Kind::kNoEffect || kind == Kind::kNothingMoved || kind == Kind::kStillMoves;
}

}  // namespace

std::span<const Parol6Console::Row> Parol6Console::rows() noexcept {
  using Self = Parol6Console;
  constexpr auto kAlways = When::kAlways;
  constexpr auto kAlone = When::kAlone;
  static constexpr std::array kRows{
      Row{"help", "[COMMAND]", "what there is", kAlways, &Self::help, ""},
      Row{"status", "", "everything that telemetry says", kAlways, &Self::status, ""},
      Row{"enable", "", "let the board move; ends the latch of an emergency stop", kAlone,
          &Self::enable, ""},
      Row{"disable", "", "let the board ignore all motion", kAlways, &Self::disable, ""},
      Row{"clear", "", "clear error: ends a homing, enables nothing", kAlone, &Self::clear, ""},
      Row{"home", "", "find the zero of every joint; takes half a minute", kAlone, &Self::home, ""},
      Row{"jog", "jN | world AXIS | tool AXIS  SPEED [SECONDS]",
          "run a joint until 'stop', SPEED in steps/s or 10deg for deg/s; or the tool along x y z "
          "or "
          "about rx ry rz, SPEED in mm/s or deg/s",
          kAlone, &Self::jog, "j1 j2 j3 j4 j5 j6 world tool|x y z rx ry rz"},
      Row{"stop", "", "make the arm stand, whatever it does", kAlways, &Self::stop_arm, ""},
      Row{"goto", "jN=PLACE ...", "move joints together; PLACE in steps, or 90deg", kAlone,
          &Self::go_to, "j1= j2= j3= j4= j5= j6="},
      Row{"out", "1|2 on|off", "switch an output", kAlone, &Self::out, "1 2|on off"},
      Row{"gripper", "move POSITION SPEED CURRENT | calibrate | clear",
          "POSITION 0 is open, 255 closed; CURRENT 100 to 1000 mA", kAlone, &Self::gripper,
          "move calibrate clear"},
      Row{"estop", "", "state of the emergency stop", kAlways, &Self::estop, ""},
      Row{"stats", "", "what the link did so far", kAlways, &Self::stats, ""},
      Row{"wait", "SECONDS", "do nothing for a time", kAlone, &Self::wait, ""},
      Row{"quit", "", "make the arm stand and leave; so does exit", kAlways, &Self::quit, ""},
  };
  return kRows;
}

Parol6Console::Parol6Console(Rig rig, std::string target, Say say)
    : rig_{std::move(rig)},
      target_{std::move(target)},
      say_{std::move(say)},
      loop_{rig_.port(), drive_} {}

Outcome<void> Parol6Console::cycle() {
  const auto cycled = loop_.cycle();
  if (cycled) {
    accepted_ = wanted_;
    refusals_ = 0;
    ++frames_;
  } else if (cycled.error().code != ErrorCode::kForbidden) {
    return problem(cycled.error().code, target_, "is it still there and switched on?");
  } else if (++refusals_ == kMostRefusals) {
    const auto refusal = rig_.last_refusal();
    return problem(ErrorCode::kForbidden, target_, refusal ? refusal->reason : "start again");
  } else {
    take_refusal();
  }
  take_events();
  return {};
}

void Parol6Console::begin(std::string_view line) {
  run_command(*this, rows(), line, is_busy() ? name_ : "",
              [this](Tone tone, std::string_view text) { say_(tone, text); });
}

void Parol6Console::stop() {
  if (is_busy()) say_(Tone::kEvent, name_ + " is ended");
  is_jogging_ = false;
  go_on("stop", begin_stop(drive_));
}

std::string Parol6Console::occupation() {
  if (drive_.is_latched()) return "ESTOP";
  if (is_jogging_) return "jog";
  if (!is_busy()) return {};
  const auto seconds = std::chrono::floor<std::chrono::seconds>(now() - began_).count();
  return seconds == 0 ? name_ : fmt::format("{} {} s", name_, seconds);
}

// What goes on.

void Parol6Console::go_on(std::string_view name, std::unique_ptr<Activity> activity) {
  activity_ = std::move(activity);
  name_ = name;
  began_ = now();
  refusals_ = 0;
  frames_ = 0;
}

void Parol6Console::go_on_if(std::string_view name, Result<std::unique_ptr<Activity>> begun) {
  if (begun) {
    is_jogging_ = false;
    go_on(name, *std::move(begun));
    return;
  }
  const bool is_pressed = drive_.telemetry() && is_estop_pressed(*drive_.telemetry());
  say_(Tone::kFailed, is_pressed
                          ? "refused: the emergency stop is pressed; release it, then say 'enable'"
                          : "refused: the emergency stop is latched; say 'enable' first");
}

void Parol6Console::end(const Activity::Ending& ending) {
  is_jogging_ = is_jogging_ || (ending.is_success && activity_->leaves_it_moving());
  activity_.reset();
  say_(ending.is_success ? Tone::kAnswer : Tone::kFailed, ending.text);
}

void Parol6Console::take_events() {
  const auto events = drive_.take_events();
  for (const auto& event : events) {
    if (const auto news = news_of(event.kind); !news.empty()) say_(Tone::kEvent, news);
    if (is_trouble(event.kind) && !is_busy()) say_(Tone::kFailed, describe(event));
    if (event.kind == DriveEvent::Kind::kEstopPressed) is_jogging_ = false;
  }
  if (!is_busy()) return;
  const auto ending = activity_->step(drive_, now(), events);
  if (const auto news = activity_->take_news(); !news.empty()) {
    say_(Tone::kEvent, fmt::format("{}: {}", name_, news));
  }
  if (ending) end(*ending);
}

void Parol6Console::take_refusal() {
  drive_.idle();
  drive_.set_outputs(accepted_.outputs);
  drive_.set_gripper(accepted_.gripper);
  wanted_ = accepted_;
  is_jogging_ = false;
  activity_.reset();
  const auto refusal = rig_.last_refusal();
  const auto reason = refusal ? refusal->reason : std::string{"the guard does not want it"};
  say_(Tone::kFailed,
       frames_ == 0
           ? "refused: " + reason
           : fmt::format("stopped by the guard: {}; if nothing moves now, 'enable'", reason));
}

/// As the guard of a real arm would have it, but at once and not on the way.
bool Parol6Console::may_go_to(const JointSteps& goal) {
  if (!is_homed(*drive_.telemetry())) {
    say_(Tone::kEvent, "not homed: places count from where the arm was switched on");
    return true;
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& bounds = kJointBounds[j];
    if (goal[j] >= bounds.lower && goal[j] <= bounds.upper) continue;
    say_(Tone::kFailed, fmt::format("refused: {} is out of bounds, which are {} to {} steps",
                                    place_of(j, goal[j]), bounds.lower.value, bounds.upper.value));
    return false;
  }
  return true;
}

// The commands.

Read Parol6Console::help(Words words) {
  if (words.size() > 1) return wrong("");
  const auto name = words.empty() ? std::string_view{} : words.front();
  const auto text = help_text(rows(), name);
  if (text.empty()) return wrong(fmt::format("there is no command '{}'", name));
  say_(Tone::kAnswer, text);
  return {};
}

Read Parol6Console::status(Words words) {
  if (!words.empty()) return wrong("");
  if (!drive_.telemetry()) {
    say_(Tone::kFailed, "no telemetry yet");
    return {};
  }
  auto text = panel(*drive_.telemetry());
  text.pop_back();
  if (drive_.is_latched()) text += "\nlatched    the emergency stop; 'enable' ends it";
  say_(Tone::kAnswer, text);
  return {};
}

Read Parol6Console::enable(Words words) {
  if (!words.empty()) return wrong("");
  go_on_if("enable", begin_command(drive_, Command::kEnable));
  return {};
}

Read Parol6Console::disable(Words words) {
  if (!words.empty()) return wrong("");
  if (is_busy()) say_(Tone::kEvent, name_ + " is ended");
  go_on_if("disable", begin_command(drive_, Command::kDisable));
  return {};
}

Read Parol6Console::clear(Words words) {
  if (!words.empty()) return wrong("");
  go_on_if("clear", begin_command(drive_, Command::kClearError));
  return {};
}

Read Parol6Console::home(Words words) {
  if (!words.empty()) return wrong("");
  go_on_if("home", begin_home(drive_));
  return {};
}

Read Parol6Console::jog(Words words) {
  if (!words.empty() && words[0] == "world") return jog_tool(JogFrame::kWorld, words.subspan(1));
  if (!words.empty() && words[0] == "tool") return jog_tool(JogFrame::kTool, words.subspan(1));
  if (words.size() != 2 && words.size() != 3) return wrong("");
  const auto joint = parse_joint(words[0]);
  if (!joint) return wrong(joint.error());
  const auto speed = parse_speed(*joint, words[1]);
  if (!speed) return wrong(speed.error());
  if (words.size() == 2) {
    go_on_if("jog", begin_jog(drive_, *joint, *speed));
    return {};
  }
  const auto time = parse_seconds(words[2]);
  if (!time) return wrong(time.error());
  go_on_if("jog", begin_jog_for(drive_, *joint, *speed, *time));
  return {};
}

Read Parol6Console::jog_tool(JogFrame frame, Words words) {
  if (words.size() != 2 && words.size() != 3) return wrong("");
  const auto velocity = parse_tool_speed(words[0], words[1]);
  if (!velocity) return wrong(velocity.error());
  std::optional<Duration> time;
  if (words.size() == 3) {
    const auto seconds = parse_seconds(words[2]);
    if (!seconds) return wrong(seconds.error());
    time = *seconds;
  }
  go_on_if("jog", begin_tool_jog(drive_, {frame, *velocity}, time));
  return {};
}

Read Parol6Console::stop_arm(Words words) {
  if (!words.empty()) return wrong("");
  stop();
  return {};
}

Read Parol6Console::go_to(Words words) {
  if (words.empty()) return wrong("");
  if (!drive_.telemetry()) {
    say_(Tone::kFailed, "refused: without telemetry nobody knows where the arm is");
    return {};
  }
  auto goal = drive_.telemetry()->position;
  for (const auto word : words) {
    const auto equals = std::min(word.find('='), word.size());
    const auto joint = parse_joint(word.substr(0, equals));
    if (!joint) return wrong(joint.error());
    if (equals == word.size()) return wrong(fmt::format("where shall {} go?", word));
    const auto position = parse_position(*joint, word.substr(equals + 1));
    if (!position) return wrong(position.error());
    goal[*joint] = *position;
  }
  if (may_go_to(goal)) go_on_if("goto", begin_go_to(drive_, goal, fastest_glide()));
  return {};
}

Read Parol6Console::out(Words words) {
  if (words.size() != 2) return wrong("");
  const bool is_known =
      (words[0] == "1" || words[0] == "2") && (words[1] == "on" || words[1] == "off");
  if (!is_known) return wrong(fmt::format("'{} {}' is no state of an output", words[0], words[1]));
  const auto bit = words[0] == "1" ? io_flag::kOut1 : io_flag::kOut2;
  const auto others = wanted_.outputs & ~bit;
  wanted_.outputs = static_cast<std::uint8_t>(words[1] == "on" ? others | bit : others);
  go_on("out", begin_outputs(drive_, wanted_.outputs));
  return {};
}

Read Parol6Console::gripper(Words words) {
  if (!words.empty() && words.front() == "move") return gripper_move(words.subspan(1));
  const bool calibrates = words.size() == 1 && words.front() == "calibrate";
  if (!calibrates && (words.size() != 1 || words.front() != "clear")) return wrong("");
  wanted_.gripper = {};
  go_on("gripper", calibrates ? begin_gripper_calibration(drive_) : begin_gripper_clear(drive_));
  return {};
}

Read Parol6Console::gripper_move(Words words) {
  if (words.size() != 3) return wrong("");
  const auto position = parse_whole("position", words[0], 0, 255);
  if (!position) return wrong(position.error());
  const auto speed = parse_whole("speed", words[1], 0, 255);
  if (!speed) return wrong(speed.error());
  const auto current = parse_whole("current", words[2], 100, 1000);
  if (!current) return wrong(current.error());
  using namespace gripper_command;
  wanted_.gripper = {.position = *position,
                     .speed = *speed,
                     .current = Milliamperes{*current},
                     .command = kActivate | kGoTo | kReleaseDirection};
  go_on("gripper", begin_gripper_move(drive_, wanted_.gripper));
  return {};
}

Read Parol6Console::estop(Words words) {
  if (!words.empty()) return wrong("");
  const auto& frame = drive_.telemetry();
  if (!frame) {
    say_(Tone::kFailed, "no telemetry yet");
    return {};
  }
  say_(Tone::kAnswer, fmt::format("{}{}", is_estop_pressed(*frame) ? "PRESSED" : "released",
                                  drive_.is_latched() ? ", latched: 'enable' ends it" : ""));
  return {};
}

Read Parol6Console::stats(Words words) {
  if (!words.empty()) return wrong("");
  auto text = link_panel(drive_.statistics()) +
              fmt::format("schedule   {} skipped, late by {} at 50 %, 99 % and most",
                          loop_.skipped(), percentiles(loop_.jitter()));
  if (const auto impairments = rig_.impairments()) {
    text += "\nimpaired   " + to_string(*impairments);
  }
  say_(Tone::kAnswer, text);
  return {};
}

Read Parol6Console::wait(Words words) {
  if (words.size() != 1) return wrong("");
  const auto time = parse_seconds(words[0]);
  if (!time) return wrong(time.error());
  go_on("wait", begin_wait(*time));
  return {};
}

Read Parol6Console::quit(Words words) {
  if (!words.empty()) return wrong("");
  wants_to_quit_ = true;
  return {};
}

Outcome<std::unique_ptr<DeviceConsole>> open_parol6_console(const RigOptions& how,
                                                            const std::string& target, Say say) {
  auto rig = open_rig("parol6", how);
  if (!rig) return tl::unexpected{rig.error()};
  return std::make_unique<Parol6Console>(*std::move(rig), target, std::move(say));
}

}  // namespace armjig::cli
