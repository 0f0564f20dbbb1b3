// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "cli/device.hpp"
#include "cli/line_editor.hpp"
#include "cli/outputs.hpp"
#include "cli/pace.hpp"
#include "cli/screen.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"
#include "harness/console/device_console.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kConsoleHelp =
    "Drives an arm by hand, or by commands from a pipe.\n"
    "\n"
    "  armjig console DEVICE --target emulated:                 try it: 'help' lists the commands\n"
    "  armjig console DEVICE --target pty:/tmp/arm --allow state,move\n"
    "  echo 'status' | armjig console DEVICE --target emulated:   in virtual time, at once\n"
    "\n"
    "On a terminal: Tab completes, Up brings back earlier lines, Ctrl-C stops the arm, Ctrl-D\n"
    "leaves. From a pipe: one command a line, each to its end before the next, # begins a "
    "comment.\n"
    "In both, the arm stands at the end.\n"
    "\n"
    "Exit codes from a pipe: 0 all had effect, 1 some had none or were refused, 2 some cannot be\n"
    "read, 3 the target is silent or gone, 4 there was no command.";

struct ConsoleOptions {
  std::string device;
  TargetOptions target;
};

constexpr Duration kPeriod = 10ms;
constexpr std::size_t kLongestLine = 4096;

Problem silence(const ConsoleOptions& options, const DeviceConsole& console) {
  return {ErrorCode::kTimedOut, options.target.target, std::string{console.silence()}};
}

/// Lines of standard input, without waiting for them if other things have to go on.
class InputLines {
 public:
  enum class Patience : std::uint8_t { kWait, kNoWait };

  /// The next line without its end; none: it is not there yet, or input has ended.
  std::optional<std::string> next(Patience patience) {
    while (!has_ended_ && !is_endless() && text_.find('\n') == std::string::npos) {
      pollfd ready{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
      if (::poll(&ready, 1, patience == Patience::kWait ? -1 : 0) != 1) return std::nullopt;
      std::array<char, 4096> buffer;
      const auto size = ::read(STDIN_FILENO, buffer.data(), buffer.size());
      has_ended_ = size <= 0;
      if (size > 0) text_.append(buffer.data(), static_cast<std::size_t>(size));
    }
    if (text_.empty() || is_endless()) return std::nullopt;
    const auto end = std::min(text_.find('\n'), text_.size());
    auto line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }
  [[nodiscard]] bool has_ended() const { return has_ended_ && text_.empty(); }
  /// Whether what comes has no lines. Nothing is read any more then.
  [[nodiscard]] bool is_endless() const {
    return std::min(text_.find('\n'), text_.size()) > kLongestLine;
  }

 private:
  std::string text_;
  bool has_ended_ = false;
};

/// Commands from a pipe, each to its end.
class PipeSession {
 public:
  PipeSession(const ConsoleOptions& options, InputLines::Patience patience)
      : options_{options}, patience_{patience} {}

  Exit run(DeviceConsole& console) {
    console_ = &console;
    const auto is_there = console_->find_device();
    if (!is_there) return report(is_there.error());
    if (!*is_there) return report(silence(options_, *console_));
    if (const auto done = run_commands(); !done) return report(done.error());
    line_ = 0;
    if (const auto left = console_->leave(); !left) return report(left.error());
    if (is_interrupted()) {
      fmt::print(stderr, "armjig: interrupted; no line of the input was taken any more\n");
      return signals_.has_come() ? signals_.exit() : exit_;
    }
    return has_run_ ? exit_ : Exit::kNothing;
  }

  void say(Tone tone, std::string_view text) {
    switch (tone) {
      case Tone::kAnswer:
        if (line_ > 0) fmt::print("{}\n", text);
        break;
      case Tone::kEvent:
        fmt::print("* {}\n", text);
        break;
      case Tone::kFailed:
        complain(text, Exit::kFindings);
        break;
      case Tone::kUnreadable:
        complain(text, Exit::kUsage);
        break;
    }
    std::fflush(stdout);
  }

 private:
  Outcome<void> run_commands() {
    while (!console_->wants_to_quit() && !is_interrupted()) {
      const auto line = input_.next(patience_);
      if (line) {
        ++line_;
        console_->begin(*line);
        has_run_ = has_run_ || !is_blank(*line);
        if (auto done = finish(); !done) return done;
      } else if (input_.has_ended()) {
        return {};
      } else if (input_.is_endless()) {
        return problem(ErrorCode::kCannotRead, fmt::format("standard input:{}", line_ + 1),
                       fmt::format("the line has more than {} bytes", kLongestLine));
      } else if (auto cycled = console_->cycle(); !cycled) {
        return cycled;
      }
    }
    return {};
  }

  Outcome<void> finish() {
    while (console_->is_busy() && !is_interrupted()) {
      if (auto cycled = console_->cycle(); !cycled) return cycled;
    }
    return {};
  }

  static bool is_blank(std::string_view line) {
    const auto first = line.find_first_not_of(" \t\r");
    return first == std::string_view::npos || line[first] == '#';
  }

  bool is_interrupted() {
    is_interrupted_ = is_interrupted_ || signals_.has_come() || is_standard_output_lost();
    return is_interrupted_;
  }

  void complain(std::string_view text, Exit exit) {
    if (line_ > 0) fmt::print(stderr, "line {}: {}\n", line_, text);
    if (line_ == 0) fmt::print(stderr, "at the end: {}\n", text);
    exit_ = std::max(exit_, exit);
  }

  const ConsoleOptions& options_;
  InputLines::Patience patience_;
  Signals signals_;
  InputLines input_;
  DeviceConsole* console_ = nullptr;
  int line_ = 0;  ///< of the input; 0: none
  bool has_run_ = false;
  bool is_interrupted_ = false;
  Exit exit_ = Exit::kPassed;
};

/// A person at a terminal.
class TerminalSession {
 public:
  TerminalSession(const ConsoleOptions& options, bool is_emulated)
      : options_{options}, is_emulated_{is_emulated} {}

  Exit run(DeviceConsole& console) {
    console_ = &console;
    pace_.emplace(is_emulated_ ? Pace::By::kWallClock : Pace::By::kPort, console_->now());
    greet();
    while (!console_->wants_to_quit() && !problem_) {
      const auto line = editor_.read_line([this] { return meanwhile(); });
      if (!line) break;
      console_->begin(*line);
    }
    is_leaving_ = true;
    if (!problem_) {
      if (const auto left = console_->leave(); !left) problem_ = left.error();
    }
    return problem_ ? report(*problem_) : Exit::kPassed;
  }

  void say(Tone tone, std::string_view text) {
    if (is_leaving_ && tone == Tone::kAnswer) return;
    const auto* const mark = tone == Tone::kAnswer ? "" : tone == Tone::kEvent ? "* " : "! ";
    editor_.print(fmt::format("{}{}\n", mark, text));
  }

 private:
  void greet() {
    const auto& target = options_.target.target;
    fmt::print("{} at {}\n'help' lists the commands, Tab completes, Ctrl-C stops the arm.\n",
               options_.device, target);
    if (!is_emulated_ && options_.target.allow.empty()) {
      fmt::print(
          "Nothing but looking is allowed: --allow state,move,home,grip lets you do more.\n");
    }
    const auto is_there = console_->find_device();
    if (!is_there) problem_ = is_there.error();
    if (is_there && !*is_there) fmt::print("{}\n", console_->silence());
  }

  /// A period of the drive between keys.
  LineEditor::Wish meanwhile() {
    if (signals_.must_end() || console_->wants_to_quit()) return LineEditor::Wish::kEnd;
    if (signals_.take_interrupt()) {
      console_->stop();
      return LineEditor::Wish::kDropLine;
    }
    if (const auto wait = pace_->until(console_->now() + kPeriod); wait > 0ns) {
      std::this_thread::sleep_for(wait);
    }
    if (const auto cycled = console_->cycle(); !cycled) {
      problem_ = cycled.error();
      return LineEditor::Wish::kEnd;
    }
    const auto occupation = console_->occupation();
    editor_.set_prompt(options_.device + (occupation.empty() ? "" : " [" + occupation + "]") +
                       "> ");
    return LineEditor::Wish::kGoOn;
  }

  const ConsoleOptions& options_;
  bool is_emulated_;
  Signals signals_;
  DeviceConsole* console_ = nullptr;
  LineEditor editor_{[this](std::string_view line) { return console_->candidates(line); },
                     history_file()};
  std::optional<Pace> pace_;
  std::optional<Problem> problem_;
  bool is_leaving_ = false;
};

template <class Session>
Exit run(Session&& session, const Device& device, const ConsoleOptions& options,
         const RigOptions& how) {
  auto console =
      open_console(device, how, options.target.target,
                   [&session](Tone tone, std::string_view text) { session.say(tone, text); });
  return console ? session.run(**console) : report(console.error());
}

Exit console(Devices devices, const ConsoleOptions& options) {
  const auto device = find_device(devices, options.device);
  if (!device) return report(device.error());
  const auto how = parse_target_options(options.target);
  if (!how) return report(how.error());
  const bool is_emulated = how->target.is_emulated();
  if (::isatty(STDIN_FILENO) == 1 && has_screen()) {
    return run(TerminalSession{options, is_emulated}, **device, options, *how);
  }
  // In virtual time nothing passes while nobody says anything.
  const auto patience = is_emulated ? InputLines::Patience::kWait : InputLines::Patience::kNoWait;
  return run(PipeSession{options, patience}, **device, options, *how);
}

}  // namespace

void add_console(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("console", with_example(kConsoleHelp, devices));
  const auto options = std::make_shared<ConsoleOptions>();
  add_device_argument(*command, options->device, devices);
  add_target_options(*command, options->target);
  when_chosen(*command, action, [options, devices] { return console(devices, *options); });
}

}  // namespace armjig::cli
