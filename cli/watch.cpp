// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/outputs.hpp"
#include "cli/pace.hpp"
#include "cli/screen.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"
#include "harness/console/watch.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kWatchHelp =
    "Shows what a device says of itself, live. Ctrl-C or q ends it.\n"
    "\n"
    "  armjig watch DEVICE --target pty:/tmp/arm\n"
    "  armjig watch DEVICE --target emulated: --seconds 10      in virtual time, at once\n"
    "  armjig watch DEVICE --target tcp:127.0.0.1:51717 --json  for scripts\n"
    "\n"
    "It only asks. But a PAROL6 answers nothing else than commands: watch sends idle frames, and\n"
    "every frame also says what outputs and gripper shall do. So outputs go off, a gripper goes\n"
    "limp, and a homing that was interrupted goes on. A KinovaZED server speaks by itself: "
    "nothing\n"
    "is sent, but it serves one client at a time, and that is watch then.\n"
    "\n"
    "--reconnect goes on when the device comes back: after a reset, or on its cable again.\n"
    "\n"
    "Exit codes: 0 telemetry came, 3 none came or the target is gone.";

struct WatchOptions {
  std::string device;
  TargetOptions target;
  std::optional<double> rate;
  std::optional<std::uint64_t> count;
  std::optional<double> seconds;
  bool json = false;
  bool reconnects = false;

  [[nodiscard]] bool has_end() const { return count.has_value() || seconds.has_value(); }
};

enum class Form : std::uint8_t { kScreen, kLines, kJson };

/// Somebody, or a file, that looks on until the end.
class Viewer {
 public:
  Viewer(Watched& watched, Watch& watch, const WatchOptions& options, Form form, Pace::By by)
      : watched_{watched}, watch_{watch}, options_{options}, form_{form}, pace_{by, watched.now()} {
    if (form_ == Form::kScreen) screen_.emplace();
  }

  /// Errors are the port's.
  Result<void> run() {
    const auto heard = [this] {
      if (form_ == Form::kJson) print_json();
    };
    Result<void> result;
    while (result && !is_over()) {
      if (const auto wait = pace_.until(watch_.next()); wait > 0ns) {
        std::this_thread::sleep_for(wait);
      }
      result = watch_.cycle(heard);
      if (result) show();
    }
    if (result) result = watch_.end(heard);
    screen_.reset();
    return result;
  }

  /// The last words.
  [[nodiscard]] std::string summary() const {
    const auto state = form_ == Form::kScreen ? watched_.panel() : std::string{};
    return state + watch_.summary();
  }

 private:
  [[nodiscard]] bool is_over() {
    return is_standard_output_lost() || signals_.must_end() || signals_.take_interrupt() ||
           (screen_ && screen_->wants_to_quit()) || watch_.is_over();
  }

  void print_json() const {
    const auto lines = watched_.json_lines();
    for (const auto& line : lines) fmt::print("{}\n", line);
    if (!lines.empty()) std::fflush(stdout);
  }

  void show() {
    if (form_ == Form::kLines) show_lines();
    if (form_ == Form::kScreen) show_screen();
  }

  /// The first lines as soon as there is something to say, then once a second.
  void show_lines() {
    if (watched_.answers() == 0 || watched_.now() < next_lines_) return;
    for (const auto& line : watched_.lines()) {
      fmt::print("{:.2f} s  {}\n", watch_.seconds_since_start(), line);
    }
    std::fflush(stdout);
    next_lines_ = watched_.now() + 1s;
  }

  void show_screen() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_drawn_ < 100ms) return;
    last_drawn_ = now;
    const auto title = fmt::format("{} at {}", options_.device, options_.target.target);
    screen_->draw(watch_.page(title) + "\nCtrl-C or q ends\n");
  }

  Watched& watched_;
  Watch& watch_;
  const WatchOptions& options_;
  Form form_;
  Pace pace_;
  Signals signals_;
  std::optional<Screen> screen_;
  Instant next_lines_{};
  std::chrono::steady_clock::time_point last_drawn_{};
};

Form form_of(const WatchOptions& options) {
  if (options.json) return Form::kJson;
  return has_screen() ? Form::kScreen : Form::kLines;
}

Watch::Plan plan_of(const WatchOptions& options, Duration period) {
  Watch::Plan plan{.period = period, .count = options.count};
  if (options.seconds) plan.time = duration_of(*options.seconds);
  return plan;
}

Exit watch(Devices devices, const WatchOptions& options) {
  const auto found = find_device(devices, options.device);
  if (!found) return report(found.error());
  const auto& device = **found;
  auto how = parse_target_options(options.target);
  if (!how) return report(how.error());
  const auto claimed = claim_standard_output(options.json ? "--json" : "");
  if (!claimed) return report(claimed.error());
  if (options.reconnects) how->when_gone = WhenGone::kReopen;
  const bool is_watched_live = has_screen() && !options.has_end();
  if (how->target.is_emulated() && !options.has_end() && !is_watched_live) {
    return report({ErrorCode::kBadValue, options.target.target,
                   "virtual time never ends by itself: say --seconds or --count"});
  }
  const auto rate = options.rate.value_or(device.watch_rate);
  const auto period = duration_of(1 / rate);
  auto watched = open_watched(device, *how, period);
  if (!watched) return report(watched.error());
  Watch watch{**watched, plan_of(options, period)};
  const bool needs_pace = how->target.is_emulated() && is_watched_live;
  Viewer viewer{**watched, watch, options, form_of(options),
                needs_pace ? Pace::By::kWallClock : Pace::By::kPort};
  const auto result = viewer.run();
  auto* const out = options.json ? stderr : stdout;
  fmt::print(out, "{}", viewer.summary());
  if (const auto done = (*watched)->impairments()) {
    fmt::print(out, "impaired   {}\n", to_string(*done));
  }
  if (!result) {
    return report(
        {result.error().code, options.target.target, "is it still there and switched on?"});
  }
  if ((*watched)->answers() > 0) return Exit::kPassed;
  return report({ErrorCode::kTimedOut, options.target.target,
                 fmt::format("no telemetry came: is a {} there, switched on, and free for us?",
                             options.device)});
}

}  // namespace

void add_watch(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("watch", with_example(kWatchHelp, devices));
  const auto options = std::make_shared<WatchOptions>();
  add_device_argument(*command, options->device, devices);
  add_target_options(*command, options->target);
  command->add_option("--rate", options->rate, "questions a second, 1 to 1000 (default: as usual)")
      ->type_name("HZ")
      ->check(number(1, 1000));
  auto* count = command->add_option("--count", options->count, "end after that many questions")
                    ->type_name("N")
                    ->transform(whole(1, std::uint64_t{1} << 62U));
  command->add_option("--seconds", options->seconds, "end after that time")
      ->type_name("S")
      ->check(number(0.001, 1e9))
      ->excludes(count);
  command->add_flag("--reconnect", options->reconnects, "wait for a device that has gone");
  command->add_flag("--json", options->json, "a JSON object for each message (armjig.telemetry/1)");
  when_chosen(*command, action, [options, devices] { return watch(devices, *options); });
}

}  // namespace armjig::cli
