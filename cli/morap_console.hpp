// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/bus_session.hpp"
#include "cli/parol6_console.hpp"
#include "harness/drive/morap/joint.hpp"

namespace armjig::cli {

/// The commands of `armjig console morap`: each is done when `run` returns. They are for one node,
/// which `node` changes.
class MorapConsole {
 public:
  using Say = std::function<void(Tone, std::string_view)>;

  /// The rig outlives the console.
  MorapConsole(BusRig& rig, Say say);
  MorapConsole(const MorapConsole&) = delete;
  MorapConsole& operator=(const MorapConsole&) = delete;
  ~MorapConsole() = default;

  /// Does a command; what is blank or a comment does nothing.
  void run(std::string_view line);
  /// Disables every node that was told to move.
  void stop();
  [[nodiscard]] bool wants_to_quit() const noexcept { return wants_to_quit_; }
  [[nodiscard]] int node() const noexcept;
  [[nodiscard]] morap::Master& master() noexcept { return master_; }

  /// What may stand where the last word of `line` begins.
  [[nodiscard]] static std::vector<std::string> candidates(std::string_view line);

 private:
  using Words = std::vector<std::string>;
  struct Command;
  static const std::vector<Command>& commands();

  void do_reference(const Words& words);
  void do_program(const Words& words);
  void do_pen(const Words& words);
  void tell(morap::BusCode code, std::string_view done);
  void tell(const morap::ProgramResult& result);
  bool number(const std::string& word, float& value);

  BusRig& rig_;
  Say say_;
  morap::Master master_;
  morap::Joint joint_;
  std::vector<BusAddress> moved_;
  bool wants_to_quit_ = false;
};

/// The console on a terminal or from a pipe.
[[nodiscard]] Exit console_morap(const TargetOptions& target);

}  // namespace armjig::cli
