// SPDX-License-Identifier: Apache-2.0
#include "harness/console/parol6/console.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "harness/console/parol6/arguments.hpp"
#include "harness/console/parol6/view.hpp"
#include "harness/drive/parol6/activity.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/drive/parol6/tool_jog.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::console {

using namespace drive;

namespace {

using namespace std::chrono_literals;

/// Even idle frames: the target is not ours any more.
constexpr int kMostRefusals = 3;

/// A way in big steps would be fast: half of what a joint may do at all, halved again for the time
/// in which telemetry lags behind, and never more than its jog.
JointSpeeds fastest_glide() {
  JointSpeeds speeds;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    speeds[j] = std::min(kJoints[j].max_jog, StepsPerSecond{kJoints[j].max_speed.value / 4});
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

class Console final : public DeviceConsole {
 public:
  Console(Rig<StreamPort> rig, const std::string& target, Say say)
      : DeviceConsole{rows(),
                      target,
                      std::move(say),
                      {1s, "no telemetry came: is a parol6 there, and switched on?"}},
        rig_{std::move(rig)},
        loop_{rig_.port(), drive_} {}

  std::string occupation() override {
    if (drive_.is_latched()) return "ESTOP";
    return is_jogging_ ? "jog" : going_on();
  }
  Instant now() override { return rig_.port().now(); }

 private:
  static std::span<const Row> rows() noexcept;

  Outcome<void> exchange() override;
  bool hears_the_device() const override { return drive_.telemetry().has_value(); }
  Parsed<std::string> state() override;
  void stand() override {
    is_jogging_ = false;
    pursue("stop", begin_stop(drive_));
  }
  void wait_for(Duration time) override { pursue("wait", begin_wait(time)); }

  // The commands.
  void enable() { pursue_if("enable", begin_command(drive_, Command::kEnable)); }
  void disable() { pursue_if("disable", begin_command(drive_, Command::kDisable)); }
  void clear() { pursue_if("clear", begin_command(drive_, Command::kClearError)); }
  void home() { pursue_if("home", begin_home(drive_)); }
  Read jog(Words words);
  Read jog_joint(Words words, std::optional<Duration> time);
  Read jog_tool(planning::JogFrame frame, Words words, std::optional<Duration> time);
  Read go_to(Words words);
  Read out(Words words);
  Read gripper(Words words);
  Read gripper_move(Words words);
  void estop();
  void stats();

  /// The activity goes on under that name, in place of another one.
  void pursue(std::string_view name, std::unique_ptr<Activity> activity);
  void pursue_if(std::string_view name, Result<std::unique_ptr<Activity>> begun);
  void take_events();
  void take_refusal();
  /// Says so if it is not.
  bool may_go_to(const JointSteps& goal);

  Rig<StreamPort> rig_;
  Drive drive_;
  DriveLoop loop_;
  std::unique_ptr<Activity> activity_;  ///< what goes on
  bool is_jogging_ = false;             ///< and nothing will end it but another command
  int refusals_ = 0;                    ///< in a row, since the last command
  std::uint64_t frames_ = 0;            ///< that left since then

  /// What goes along with every frame. A frame that is refused takes back what it would change.
  struct Extras {
    std::uint8_t outputs{};
    GripperSetPoint gripper;
  };
  Extras wanted_;
  Extras accepted_;
};

std::span<const DeviceConsole::Row> Console::rows() noexcept {
  using Self = Console;
  static constexpr std::array kRows{
      Row{"enable", "", "let the board move; ends the latch of an emergency stop", kAlone,
          run<&Self::enable>, ""},
      Row{"disable", "", "let the board ignore all motion", kAlways, run<&Self::disable>, ""},
      Row{"clear", "", "clear error: ends a homing, enables nothing", kAlone, run<&Self::clear>,
          ""},
      Row{"home", "", "find the zero of every joint; takes half a minute", kAlone, run<&Self::home>,
          ""},
      Row{"jog", "jN | world AXIS | tool AXIS  SPEED [SECONDS]",
          "run a joint until 'stop', SPEED in steps/s or 10deg for deg/s; or the tool along x y z "
          "or "
          "about rx ry rz, SPEED in mm/s or deg/s",
          kAlone, run<&Self::jog>, "j1 j2 j3 j4 j5 j6 world tool|x y z rx ry rz"},
      Row{"goto", "jN=PLACE ...", "move joints together; PLACE in steps, or 90deg", kAlone,
          run<&Self::go_to>, "j1= j2= j3= j4= j5= j6="},
      Row{"out", "1|2 on|off", "switch an output", kAlone, run<&Self::out>, "1 2|on off"},
      Row{"gripper", "move POSITION SPEED CURRENT | calibrate | clear",
          "POSITION 0 is open, 255 closed; CURRENT 100 to 1000 mA", kAlone, run<&Self::gripper>,
          "move calibrate clear"},
      Row{"estop", "", "state of the emergency stop", kAlways, run<&Self::estop>, ""},
      Row{"stats", "", "what the link did so far", kAlways, run<&Self::stats>, ""},
  };
  return kRows;
}

Outcome<void> Console::exchange() {
  const auto cycled = loop_.cycle();
  if (cycled) {
    accepted_ = wanted_;
    refusals_ = 0;
    ++frames_;
  } else if (cycled.error().code != ErrorCode::kForbidden) {
    return gone(cycled.error().code, "is it still there and switched on?");
  } else if (++refusals_ == kMostRefusals) {
    const auto refusal = rig_.last_refusal();
    return gone(ErrorCode::kForbidden, refusal ? refusal->reason : "start again");
  } else {
    take_refusal();
  }
  take_events();
  return {};
}

Parsed<std::string> Console::state() {
  if (!drive_.telemetry()) return wrong("no telemetry yet");
  auto text = panel(*drive_.telemetry());
  text.pop_back();
  if (drive_.is_latched()) text += "\nlatched    the emergency stop; 'enable' ends it";
  return text;
}

// What goes on.

void Console::pursue(std::string_view name, std::unique_ptr<Activity> activity) {
  go_on(name);
  activity_ = std::move(activity);
  refusals_ = 0;
  frames_ = 0;
}

void Console::pursue_if(std::string_view name, Result<std::unique_ptr<Activity>> begun) {
  if (begun) {
    is_jogging_ = false;
    return pursue(name, *std::move(begun));
  }
  const bool is_pressed = drive_.telemetry() && is_estop_pressed(*drive_.telemetry());
  say(Tone::kFailed, is_pressed
                         ? "refused: the emergency stop is pressed; release it, then say 'enable'"
                         : "refused: the emergency stop is latched; say 'enable' first");
}

void Console::take_events() {
  const auto events = drive_.take_events();
  for (const auto& event : events) {
    if (const auto news = news_of(event.kind); !news.empty()) say(Tone::kEvent, news);
    if (is_trouble(event.kind) && !is_busy()) say(Tone::kFailed, describe(event));
    if (event.kind == DriveEvent::Kind::kEstopPressed) is_jogging_ = false;
  }
  if (!is_busy()) return;
  const auto ending = activity_->step(drive_, now(), events);
  if (const auto news = activity_->take_news(); !news.empty()) {
    say(Tone::kEvent, fmt::format("{}: {}", name(), news));
  }
  if (!ending) return;
  is_jogging_ = is_jogging_ || (ending->is_success && activity_->leaves_it_moving());
  end();
  say(ending->is_success ? Tone::kAnswer : Tone::kFailed, ending->text);
}

void Console::take_refusal() {
  drive_.idle();
  drive_.set_outputs(accepted_.outputs);
  drive_.set_gripper(accepted_.gripper);
  wanted_ = accepted_;
  is_jogging_ = false;
  end();
  const auto refusal = rig_.last_refusal();
  const auto reason = refusal ? refusal->reason : std::string{"the guard does not want it"};
  say(Tone::kFailed,
      frames_ == 0
          ? "refused: " + reason
          : fmt::format("stopped by the guard: {}; if nothing moves now, 'enable'", reason));
}

/// As the guard of a real arm would have it, but at once and not on the way.
bool Console::may_go_to(const JointSteps& goal) {
  if (!is_homed(*drive_.telemetry())) {
    say(Tone::kEvent, "not homed: places count from where the arm was switched on");
    return true;
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& bounds = kJointBounds[j];
    if (goal[j] >= bounds.lower && goal[j] <= bounds.upper) continue;
    say(Tone::kFailed, fmt::format("refused: {} is out of bounds, which are {} to {} steps",
                                   place_of(j, goal[j]), bounds.lower.value, bounds.upper.value));
    return false;
  }
  return true;
}

// The commands.

DeviceConsole::Read Console::jog(Words words) {
  const bool is_world = !words.empty() && words[0] == "world";
  const bool is_tool = !words.empty() && words[0] == "tool";
  if (is_world || is_tool) words = words.subspan(1);
  if (words.size() != 2 && words.size() != 3) return wrong("");
  std::optional<Duration> time;
  if (words.size() == 3) {
    const auto seconds = parse_seconds(words[2]);
    if (!seconds) return wrong(seconds.error());
    time = *seconds;
  }
  if (is_world) return jog_tool(planning::JogFrame::kWorld, words, time);
  if (is_tool) return jog_tool(planning::JogFrame::kTool, words, time);
  return jog_joint(words, time);
}

DeviceConsole::Read Console::jog_joint(Words words, std::optional<Duration> time) {
  const auto joint = parse_joint(words[0]);
  if (!joint) return wrong(joint.error());
  const auto speed = parse_speed(*joint, words[1]);
  if (!speed) return wrong(speed.error());
  pursue_if("jog", time ? begin_jog_for(drive_, *joint, *speed, *time)
                        : begin_jog(drive_, *joint, *speed));
  return {};
}

DeviceConsole::Read Console::jog_tool(planning::JogFrame frame, Words words,
                                      std::optional<Duration> time) {
  return parse_tool_speed(words[0], words[1]).map([&](const arm::Twist& velocity) {
    pursue_if("jog", begin_tool_jog(drive_, {frame, velocity}, time));
  });
}

DeviceConsole::Read Console::go_to(Words words) {
  if (!drive_.telemetry()) {
    say(Tone::kFailed, "refused: without telemetry nobody knows where the arm is");
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
  if (may_go_to(goal)) pursue_if("goto", begin_go_to(drive_, goal, fastest_glide()));
  return {};
}

DeviceConsole::Read Console::out(Words words) {
  const bool is_known =
      (words[0] == "1" || words[0] == "2") && (words[1] == "on" || words[1] == "off");
  if (!is_known) return wrong(fmt::format("'{} {}' is no state of an output", words[0], words[1]));
  const auto bit = words[0] == "1" ? io_flag::kOut1 : io_flag::kOut2;
  const auto others = wanted_.outputs & ~bit;
  wanted_.outputs = static_cast<std::uint8_t>(words[1] == "on" ? others | bit : others);
  pursue("out", begin_outputs(drive_, wanted_.outputs));
  return {};
}

DeviceConsole::Read Console::gripper(Words words) {
  if (!words.empty() && words.front() == "move") return gripper_move(words.subspan(1));
  const bool calibrates = words.size() == 1 && words.front() == "calibrate";
  if (!calibrates && (words.size() != 1 || words.front() != "clear")) return wrong("");
  wanted_.gripper = {};
  pursue("gripper", calibrates ? begin_gripper_calibration(drive_) : begin_gripper_clear(drive_));
  return {};
}

DeviceConsole::Read Console::gripper_move(Words words) {
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
  pursue("gripper", begin_gripper_move(drive_, wanted_.gripper));
  return {};
}

void Console::estop() {
  const auto& frame = drive_.telemetry();
  if (!frame) return say(Tone::kFailed, "no telemetry yet");
  say(Tone::kAnswer, fmt::format("{}{}", is_estop_pressed(*frame) ? "PRESSED" : "released",
                                 drive_.is_latched() ? ", latched: 'enable' ends it" : ""));
}

void Console::stats() {
  auto text = link_panel(drive_.statistics()) +
              fmt::format("schedule   {} skipped, late by {} at 50 %, 99 % and most",
                          loop_.skipped(), loop_.jitter().summary());
  if (const auto impairments = rig_.impairments()) {
    text += "\nimpaired   " + to_string(*impairments);
  }
  say(Tone::kAnswer, text);
}

}  // namespace

Outcome<std::unique_ptr<DeviceConsole>> open(Rig<StreamPort> rig, const std::string& target,
                                             Say say) {
  return std::make_unique<Console>(std::move(rig), target, std::move(say));
}

}  // namespace armjig::parol6::console
