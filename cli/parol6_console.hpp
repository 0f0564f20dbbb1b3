// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/parol6_arguments.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/drive/parol6/activity.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/motion/parol6/cartesian_jog.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// What a line that the console says is.
enum class Tone : std::uint8_t {
  kAnswer,
  kEvent,       ///< something happened by itself, or goes on
  kFailed,      ///< what was asked for was refused or had no effect
  kUnreadable,  ///< what was asked for cannot be understood
};

/// The commands of `armjig console parol6`. A command is begun, and goes on while `cycle` is called
/// once a period; whoever calls decides whether to wait for its end.
class Parol6Console {
 public:
  /// Gets text without the last line end, of one line or several.
  using Say = std::function<void(Tone, std::string_view)>;

  /// `target` is for messages.
  Parol6Console(Rig rig, std::string target, Say say);
  Parol6Console(const Parol6Console&) = delete;
  Parol6Console& operator=(const Parol6Console&) = delete;
  ~Parol6Console() = default;

  /// Runs the drive for a period. Problems: the target is gone or may not be written to any more.
  [[nodiscard]] Outcome<void> cycle();

  /// Begins a command; what is blank or a comment does nothing.
  void begin(std::string_view line);
  /// The command that was begun last has not ended.
  [[nodiscard]] bool is_busy() const noexcept { return activity_ != nullptr; }
  [[nodiscard]] bool wants_to_quit() const noexcept { return wants_to_quit_; }

  /// Does what the command `stop` does.
  void stop();

  /// What goes on, in a word or two for a prompt: `home 12 s`, `ESTOP`; empty if nothing does.
  [[nodiscard]] std::string occupation();

  /// What may stand at the end of the line, for completion.
  [[nodiscard]] static std::vector<std::string> candidates(std::string_view line);

  [[nodiscard]] Instant now() { return rig_.port().now(); }
  [[nodiscard]] bool hears_the_board() const noexcept { return drive_.telemetry().has_value(); }

 private:
  using Words = std::span<const std::string_view>;
  /// Wrong arguments are told in a sentence; any other trouble is said by `say_`.
  using Read = Parsed<void>;

  /// When a command may be given.
  enum class When : std::uint8_t {
    kAlways,
    kAlone,  ///< not while another one goes on
  };
  struct Row {
    std::string_view name;
    std::string_view arguments;
    std::string_view help;
    When when{};
    Read (Parol6Console::*run)(Words words);
    std::string_view completions;  ///< words for one place, `|`, words for the next
  };
  [[nodiscard]] static std::span<const Row> rows() noexcept;
  [[nodiscard]] static const Row* find_row(std::string_view name) noexcept;
  [[nodiscard]] static std::string call_of(const Row& row);

  Read help(Words words);
  Read status(Words words);
  Read enable(Words words);
  Read disable(Words words);
  Read clear(Words words);
  Read home(Words words);
  Read jog(Words words);
  Read jog_tool(parol6::JogFrame frame, Words words);
  Read stop_arm(Words words);
  Read go_to(Words words);
  Read out(Words words);
  Read gripper(Words words);
  Read gripper_move(Words words);
  Read estop(Words words);
  Read stats(Words words);
  Read wait(Words words);
  Read quit(Words words);

  /// The activity goes on under that name, in place of another one.
  void go_on(std::string_view name, std::unique_ptr<parol6::Activity> activity);
  void go_on_if(std::string_view name, Result<std::unique_ptr<parol6::Activity>> begun);
  void end(const parol6::Activity::Ending& ending);
  void take_events();
  void take_refusal();
  /// Says so if it is not.
  [[nodiscard]] bool may_go_to(const parol6::JointSteps& goal);

  Rig rig_;
  std::string target_;
  Say say_;
  parol6::Drive drive_;
  parol6::DriveLoop loop_;

  std::unique_ptr<parol6::Activity> activity_;
  std::string name_;  ///< of the activity
  Instant began_{};
  bool is_jogging_ = false;  ///< and nothing will end it but another command
  bool wants_to_quit_ = false;
  int refusals_ = 0;          ///< in a row, since the last command
  std::uint64_t frames_ = 0;  ///< that left since then

  /// What goes along with every frame. A frame that is refused takes back what it would change.
  struct Extras {
    std::uint8_t outputs{};
    parol6::GripperSetPoint gripper;
  };
  Extras wanted_;
  Extras accepted_;
};

}  // namespace armjig::cli
