// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/device_console.hpp"
#include "cli/kinovazed_console.hpp"
#include "cli/line_editor.hpp"
#include "cli/pace.hpp"
#include "cli/parol6_console.hpp"
#include "cli/screen.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kHelp =
    "Drives an arm by hand, or by commands from a pipe.\n"
    "\n"
    "  armjig console parol6 --target emulated:                 try it: 'help' lists the commands\n"
    "  armjig console parol6 --target pty:/tmp/parol6 --allow state,move\n"
    "  echo 'home' | armjig console parol6 --target emulated:   in virtual time, at once\n"
    "  armjig console kinovazed --target tcp:127.0.0.1:51717 --allow state,move,home\n"
    "\n"
    "On a terminal: Tab completes, Up brings back earlier lines, Ctrl-C stops the arm, Ctrl-D\n"
    "leaves. From a pipe: one command a line, each to its end before the next, # begins a "
    "comment.\n"
    "In both, the arm stands at the end.\n"
    "\n"
    "Exit codes from a pipe: 0 all had effect, 1 some had none or were refused, 2 some cannot be\n"
    "read, 3 the target is silent or gone, 4 there was no command.";

struct Options {
  std::string device;
  TargetOptions target;
};

constexpr Duration kPeriod = 10ms;

/// Brings the arm to a stand, at most for two seconds.
Outcome<void> leave(DeviceConsole& console) {
  console.stop();
  const auto deadline = console.now() + 2s;
  while (console.is_busy() && console.now() < deadline) {
    if (auto cycled = console.cycle(); !cycled) return cycled;
  }
  return {};
}

/// Waits for a sign of life. False: none came in time.
Outcome<bool> hears_the_device(DeviceConsole& console) {
  const auto deadline = console.now() + console.hears_within();
  while (!console.hears_the_device() && console.now() < deadline) {
    if (const auto cycled = console.cycle(); !cycled) return tl::unexpected{cycled.error()};
  }
  return console.hears_the_device();
}

Problem silence(const Options& options, const DeviceConsole& console) {
  return {ErrorCode::kTimedOut, options.target.target, std::string{console.silence()}};
}

/// Lines of standard input, without waiting for them if other things have to go on.
class InputLines {
 public:
  enum class Patience : std::uint8_t { kWait, kNoWait };

  /// The next line without its end; none: it is not there yet, or input has ended.
  std::optional<std::string> next(Patience patience) {
    while (!has_ended_ && text_.find('\n') == std::string::npos) {
      pollfd ready{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
      if (::poll(&ready, 1, patience == Patience::kWait ? -1 : 0) != 1) return std::nullopt;
      std::array<char, 4096> buffer;
      const auto size = ::read(STDIN_FILENO, buffer.data(), buffer.size());
      has_ended_ = size <= 0;
      if (size > 0) text_.append(buffer.data(), static_cast<std::size_t>(size));
    }
    if (text_.empty()) return std::nullopt;
    const auto end = std::min(text_.find('\n'), text_.size());
    auto line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }
  [[nodiscard]] bool has_ended() const { return has_ended_ && text_.empty(); }

 private:
  std::string text_;
  bool has_ended_ = false;
};

/// Commands from a pipe, each to its end.
class PipeSession {
 public:
  PipeSession(const Options& options, InputLines::Patience patience)
      : options_{options}, patience_{patience} {}

  Exit run(const ConsoleEntry& entry, const RigOptions& how) {
    auto opened = entry.open(how, options_.target.target,
                             [this](Tone tone, std::string_view text) { say(tone, text); });
    if (!opened) return report(opened.error());
    console_ = *std::move(opened);
    const auto is_there = hears_the_device(*console_);
    if (!is_there) return report(is_there.error());
    if (!*is_there) return report(silence(options_, *console_));
    if (const auto done = run_commands(); !done) return report(done.error());
    line_ = 0;
    if (const auto left = leave(*console_); !left) return report(left.error());
    if (is_interrupted_) return Exit::kInterrupted;
    return has_run_ ? exit_ : Exit::kNothing;
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
    is_interrupted_ = is_interrupted_ || signals_.take_interrupt() || signals_.must_end();
    return is_interrupted_;
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

  void complain(std::string_view text, Exit exit) {
    if (line_ > 0) fmt::print(stderr, "line {}: {}\n", line_, text);
    if (line_ == 0) fmt::print(stderr, "at the end: {}\n", text);
    exit_ = std::max(exit_, exit);
  }

  const Options& options_;
  InputLines::Patience patience_;
  Signals signals_;
  InputLines input_;
  std::unique_ptr<DeviceConsole> console_;
  int line_ = 0;  ///< of the input; 0: none
  bool has_run_ = false;
  bool is_interrupted_ = false;
  Exit exit_ = Exit::kPassed;
};

/// A person at a terminal.
class TerminalSession {
 public:
  explicit TerminalSession(const Options& options) : options_{options} {}

  Exit run(const ConsoleEntry& entry, const RigOptions& how) {
    auto opened = entry.open(how, options_.target.target,
                             [this](Tone tone, std::string_view text) { say(tone, text); });
    if (!opened) return report(opened.error());
    console_ = *std::move(opened);
    pace_.emplace(how.target.is_emulated() ? Pace::By::kWallClock : Pace::By::kPort,
                  console_->now());
    greet(how);
    while (!console_->wants_to_quit() && !problem_) {
      const auto line = editor_.read_line([this] { return meanwhile(); });
      if (!line) break;
      console_->begin(*line);
    }
    is_leaving_ = true;
    if (!problem_) {
      if (const auto left = leave(*console_); !left) problem_ = left.error();
    }
    return problem_ ? report(*problem_) : Exit::kPassed;
  }

 private:
  void greet(const RigOptions& how) {
    const auto& target = options_.target.target;
    fmt::print("{} at {}\n'help' lists the commands, Tab completes, Ctrl-C stops the arm.\n",
               options_.device, target);
    if (!how.target.is_emulated() && options_.target.allow.empty()) {
      fmt::print(
          "Nothing but looking is allowed: --allow state,move,home,grip lets you do more.\n");
    }
    const auto is_there = hears_the_device(*console_);
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

  void say(Tone tone, std::string_view text) {
    if (is_leaving_ && tone == Tone::kAnswer) return;
    const auto* const mark = tone == Tone::kAnswer ? "" : tone == Tone::kEvent ? "* " : "! ";
    editor_.print(fmt::format("{}{}\n", mark, text));
  }

  const Options& options_;
  Signals signals_;
  std::unique_ptr<DeviceConsole> console_;
  LineEditor editor_{[this](std::string_view line) { return console_->candidates(line); },
                     history_file()};
  std::optional<Pace> pace_;
  std::optional<Problem> problem_;
  bool is_leaving_ = false;
};

constexpr std::array kConsoles{
    ConsoleEntry{"kinovazed", open_kinova_console},
    ConsoleEntry{"parol6", open_parol6_console},
};

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const auto& entry : kConsoles) names.emplace_back(entry.device);
  return names;
}

Exit console(const Options& options) {
  const auto how = parse_target_options(options.target);
  if (!how) return report(how.error());
  const auto& entry = *std::ranges::find(kConsoles, options.device, &ConsoleEntry::device);
  if (::isatty(STDIN_FILENO) == 1 && has_screen()) {
    return TerminalSession{options}.run(entry, *how);
  }
  // In virtual time nothing passes while nobody says anything.
  const auto patience =
      how->target.is_emulated() ? InputLines::Patience::kWait : InputLines::Patience::kNoWait;
  return PipeSession{options, patience}.run(entry, *how);
}

}  // namespace

void add_console(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("console", kHelp);
  const auto options = std::make_shared<Options>();
  command->add_option("DEVICE", options->device, "what is there")
      ->required()
      ->check(CLI::IsMember(device_names()));
  add_target_options(*command, options->target);
  command->callback([options, &action] { action = [options] { return console(*options); }; });
}

}  // namespace armjig::cli
