// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_table.hpp"
#include "cli/device_console.hpp"
#include "cli/parol6_arguments.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/drive/parol6/activity.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/motion/parol6/cartesian_jog.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// The commands of `armjig console parol6`.
class Parol6Console final : public DeviceConsole {
 public:
  /// `target` is for messages.
  Parol6Console(Rig rig, std::string target, Say say);

  [[nodiscard]] Outcome<void> cycle() override;
  void begin(std::string_view line) override;
  [[nodiscard]] bool is_busy() const noexcept override { return activity_ != nullptr; }
  [[nodiscard]] bool wants_to_quit() const noexcept override { return wants_to_quit_; }
  /// Does what the command `stop` does.
  void stop() override;
  [[nodiscard]] std::string occupation() override;
  [[nodiscard]] std::vector<std::string> candidates(std::string_view line) const override {
    return candidates_in(rows(), line);
  }
  [[nodiscard]] Instant now() override { return rig_.port().now(); }
  [[nodiscard]] bool hears_the_device() const noexcept override {
    return drive_.telemetry().has_value();
  }
  [[nodiscard]] Duration hears_within() const noexcept override { return std::chrono::seconds{1}; }
  [[nodiscard]] std::string_view silence() const noexcept override {
    return "no telemetry came: is a parol6 there, and switched on?";
  }

 private:
  using Row = CommandRow<Parol6Console>;
  [[nodiscard]] static std::span<const Row> rows() noexcept;

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

/// Opens the target.
[[nodiscard]] Outcome<std::unique_ptr<DeviceConsole>> open_parol6_console(const RigOptions& how,
                                                                          const std::string& target,
                                                                          Say say);

}  // namespace armjig::cli
