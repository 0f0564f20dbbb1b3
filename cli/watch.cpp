// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/pace.hpp"
#include "cli/parol6_view.hpp"
#include "cli/screen.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"
#include "cli/watched.hpp"
#include "harness/timing/latency_histogram.hpp"
#include "harness/timing/schedule.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kHelp =
    "Shows what a device says of itself, live. Ctrl-C or q ends it.\n"
    "\n"
    "  armjig watch parol6 --target pty:/tmp/parol6\n"
    "  armjig watch parol6 --target emulated: --seconds 10      in virtual time, at once\n"
    "  armjig watch kinovazed --target tcp:127.0.0.1:51717\n"
    "  armjig watch parol6 --target pty:/tmp/parol6 --json | jq .joints[0].position_deg\n"
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

struct Options {
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

/// From the first request to the last answer.
class Watch {
 public:
  Watch(StreamPort& port, std::unique_ptr<Watched> watched, Duration period, const Options& options,
        Form form, Pace::By by)
      : port_{port},
        watched_{std::move(watched)},
        options_{options},
        form_{form},
        start_{port.now()},
        schedule_{start_, period},
        pace_{by, start_} {
    if (form_ == Form::kScreen) screen_.emplace();
  }

  /// Errors are the port's.
  Result<void> run() {
    auto result = run_cycles();
    if (result) result = receive_until(schedule_.next());
    watched_->finish();
    screen_.reset();
    return result;
  }

  [[nodiscard]] bool has_heard_something() const { return watched_->answers() > 0; }

  /// The last words.
  [[nodiscard]] std::string summary() const {
    const auto state = form_ == Form::kScreen ? watched_->panel() : std::string{};
    return state + watched_->link() + schedule_text();
  }

 private:
  Result<void> run_cycles() {
    while (!is_over()) {
      if (const auto wait = pace_.until(schedule_.next()); wait > 0ns) {
        std::this_thread::sleep_for(wait);
      }
      if (auto received = receive_until(schedule_.next()); !received) return received;
      const auto cycle = schedule_.begin(port_.now());
      skipped_ += cycle.skipped;
      lateness_.record(cycle.lateness);
      if (auto asked = ask(); !asked) return asked;
      show();
    }
    return {};
  }

  Result<void> ask() {
    const auto request = watched_->request(port_.now());
    if (request.empty()) return {};
    ++sent_;
    return port_.write(request);
  }

  /// Questions, or what came without any.
  [[nodiscard]] std::uint64_t count() const { return sent_ > 0 ? sent_ : watched_->answers(); }

  [[nodiscard]] bool is_over() {
    if (signals_.must_end() || signals_.take_interrupt()) return true;
    if (screen_ && screen_->wants_to_quit()) return true;
    if (options_.count && count() >= *options_.count) return true;
    return options_.seconds &&
           schedule_.next() - start_ >= std::chrono::duration<double>{*options_.seconds};
  }

  Result<void> receive_until(Instant time) {
    std::array<std::byte, 4096> buffer;
    for (;;) {
      const auto size = port_.read(buffer, time);
      if (!size) return tl::unexpected{size.error()};
      watched_->receive(port_.now(), std::span{buffer}.first(*size));
      if (form_ == Form::kJson) print_json();
      // A device that never stops sending must not keep us from our deadline.
      if (*size == 0 || port_.now() >= time) return {};
    }
  }

  void print_json() const {
    const auto lines = watched_->json_lines();
    for (const auto& line : lines) fmt::print("{}\n", line);
    if (!lines.empty()) std::fflush(stdout);
  }

  void show() {
    if (form_ == Form::kLines) show_line();
    if (form_ == Form::kScreen) show_screen();
  }

  /// The first line as soon as there is something to say, then one a second.
  void show_line() {
    const bool is_due = watched_->answers() > 0 && port_.now() >= next_line_;
    if (!is_due) return;
    fmt::print("{:.2f} s  {}\n", seconds_since_start(), watched_->line());
    std::fflush(stdout);
    next_line_ = port_.now() + 1s;
  }

  void show_screen() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_drawn_ < 100ms) return;
    last_drawn_ = now;
    const auto state = watched_->panel();
    screen_->draw(fmt::format("{} at {}, {:.1f} s\n\n{}\n{}{}\nCtrl-C or q ends\n", options_.device,
                              options_.target.target, seconds_since_start(),
                              state.empty() ? "no telemetry yet\n" : state, watched_->link(),
                              schedule_text()));
  }

  [[nodiscard]] std::string schedule_text() const {
    return fmt::format("schedule   {} skipped, late by {} at 50 %, 99 % and most\n", skipped_,
                       percentiles(lateness_));
  }

  [[nodiscard]] double seconds_since_start() const {
    return std::chrono::duration<double>{port_.now() - start_}.count();
  }

  StreamPort& port_;
  std::unique_ptr<Watched> watched_;
  const Options& options_;
  Form form_;
  Instant start_;
  PeriodicSchedule schedule_;
  Pace pace_;
  Signals signals_;
  std::optional<Screen> screen_;
  std::uint64_t sent_ = 0;
  std::uint64_t skipped_ = 0;
  LatencyHistogram lateness_;
  Instant next_line_{};
  std::chrono::steady_clock::time_point last_drawn_{};
};

Form form_of(const Options& options) {
  if (options.json) return Form::kJson;
  return has_screen() ? Form::kScreen : Form::kLines;
}

const WatchedEntry& entry_of(const std::string& device) {
  return *std::ranges::find(watched_devices(), device, &WatchedEntry::device);
}

Exit watch(const Options& options) {
  auto how = parse_target_options(options.target);
  if (!how) return report(how.error());
  if (options.reconnects) how->when_gone = WhenGone::kReopen;
  const bool is_watched_live = has_screen() && !options.has_end();
  if (how->target.is_emulated() && !options.has_end() && !is_watched_live) {
    return report({ErrorCode::kBadValue, options.target.target + " in virtual time never ends",
                   "say --seconds or --count"});
  }
  const auto& entry = entry_of(options.device);
  auto rig = entry.open(*how);
  if (!rig) return report(rig.error());
  const auto period = std::chrono::round<Duration>(
      std::chrono::duration<double>{1.0 / options.rate.value_or(entry.rate)});
  const bool needs_pace = how->target.is_emulated() && is_watched_live;
  Watch watch{rig->port(), entry.make(period), period,
              options,     form_of(options),   needs_pace ? Pace::By::kWallClock : Pace::By::kPort};
  const auto result = watch.run();
  auto* const out = options.json ? stderr : stdout;
  fmt::print(out, "{}", watch.summary());
  if (const auto done = rig->impairments()) fmt::print(out, "impaired   {}\n", to_string(*done));
  if (!result) {
    return report(
        {result.error().code, options.target.target, "is it still there and switched on?"});
  }
  if (watch.has_heard_something()) return Exit::kPassed;
  return report({ErrorCode::kTimedOut, options.target.target,
                 fmt::format("no telemetry came: is a {} there, switched on, and free for us?",
                             options.device)});
}

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const auto& entry : watched_devices()) names.emplace_back(entry.device);
  return names;
}

}  // namespace

void add_watch(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("watch", kHelp);
  const auto options = std::make_shared<Options>();
  command->add_option("DEVICE", options->device, "what is there")
      ->required()
      ->check(CLI::IsMember(device_names()));
  add_target_options(*command, options->target);
  command->add_option("--rate", options->rate, "questions a second, 1 to 1000 (default: as usual)")
      ->type_name("HZ")
      ->check(CLI::Range(1.0, 1000.0));
  auto* count = command->add_option("--count", options->count, "end after that many questions")
                    ->type_name("N")
                    ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 62));
  command->add_option("--seconds", options->seconds, "end after that time")
      ->type_name("S")
      ->check(CLI::Range(0.001, 1e9))
      ->excludes(count);
  command->add_flag("--reconnect", options->reconnects, "wait for a device that has gone");
  command->add_flag("--json", options->json, "a JSON object for each message (armjig.telemetry/1)");
  command->callback([options, &action] { action = [options] { return watch(*options); }; });
}

}  // namespace armjig::cli
