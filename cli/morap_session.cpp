// SPDX-License-Identifier: Apache-2.0
// `armjig console morap`, on a terminal or from a pipe.
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <thread>

#include "cli/line_editor.hpp"
#include "cli/morap_console.hpp"
#include "cli/pace.hpp"
#include "cli/screen.hpp"
#include "cli/signals.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;

/// Commands from a pipe, a line each.
class PipeSession {
 public:
  explicit PipeSession(BusRig& rig)
      : console_{rig, [this](Tone tone, std::string_view text) { say(tone, text); }} {}

  Exit run() {
    bool has_run = false;
    for (std::string line; !console_.wants_to_quit() && std::getline(std::cin, line);) {
      if (signals_.take_interrupt() || signals_.must_end()) {
        console_.stop();
        return Exit::kInterrupted;
      }
      ++line_;
      const auto first = line.find_first_not_of(" \t\r");
      has_run = has_run || (first != std::string::npos && line[first] != '#');
      console_.run(line);
    }
    console_.stop();
    return has_run ? exit_ : Exit::kNothing;
  }

 private:
  void say(Tone tone, std::string_view text) {
    if (tone == Tone::kAnswer || tone == Tone::kEvent) {
      fmt::print("{}\n", text);
      std::fflush(stdout);
      return;
    }
    fmt::print(stderr, "line {}: {}\n", line_, text);
    exit_ = std::max(exit_, tone == Tone::kFailed ? Exit::kFindings : Exit::kUsage);
  }

  Signals signals_;
  MorapConsole console_;
  int line_ = 0;
  Exit exit_ = Exit::kPassed;
};

/// A person at a terminal. Virtual time passes for a person, too.
class TerminalSession {
 public:
  TerminalSession(BusRig& rig, Pace::By by)
      : console_{rig, [this](Tone tone, std::string_view text) { say(tone, text); }},
        by_{by},
        pace_{by, console_.master().now()} {}

  Exit run(const std::string& target) {
    fmt::print(
        "morap at {}\n'help' lists the commands, Tab completes, Ctrl-C disables what moves.\n",
        target);
    while (!console_.wants_to_quit()) {
      editor_.set_prompt(fmt::format("morap node {}> ", console_.node()));
      const auto line = editor_.read_line([this] { return meanwhile(); });
      if (!line) break;
      console_.run(*line);
    }
    console_.stop();
    return Exit::kPassed;
  }

 private:
  LineEditor::Wish meanwhile() {
    if (signals_.must_end()) return LineEditor::Wish::kEnd;
    if (signals_.take_interrupt()) {
      console_.stop();
      return LineEditor::Wish::kDropLine;
    }
    constexpr auto kPeriod = 20ms;
    if (by_ == Pace::By::kPort) {
      std::this_thread::sleep_for(kPeriod);
    } else {
      std::this_thread::sleep_for(pace_.until(console_.master().now() + kPeriod));
      console_.master().wait(kPeriod);
    }
    return LineEditor::Wish::kGoOn;
  }

  void say(Tone tone, std::string_view text) {
    editor_.print(fmt::format("{}{}\n", tone == Tone::kAnswer ? "" : "! ", text));
  }

  Signals signals_;
  LineEditor editor_{MorapConsole::candidates, history_file()};
  MorapConsole console_;
  Pace::By by_;
  Pace pace_;
};

}  // namespace

Exit console_morap(const TargetOptions& target) {
  auto rig = open_bus_rig("morap", target);
  if (!rig) return report(rig.error());
  if (::isatty(STDIN_FILENO) != 1 || !has_screen()) return PipeSession{*rig}.run();
  const bool is_virtual = target.target.starts_with("emulated:");
  return TerminalSession{*rig, is_virtual ? Pace::By::kWallClock : Pace::By::kPort}.run(
      target.target);
}

}  // namespace armjig::cli
