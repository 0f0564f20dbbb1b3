// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <sys/utsname.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/foreign_options.hpp"
#include "cli/latency_options.hpp"
#include "cli/outputs.hpp"
#include "cli/report_files.hpp"
#include "cli/signals.hpp"
#include "cli/target_options.hpp"
#include "harness/capture/capture.hpp"
#include "harness/files/user_file.hpp"
#include "harness/latency/latency_run.hpp"
#include "harness/latency/load.hpp"
#include "harness/latency/recorded.hpp"
#include "harness/latency/sending.hpp"
#include "harness/rig/direct_line.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kLatencyHelp =
    "Measures how long a device takes to answer, and says how far that can be believed.\n"
    "\n"
    "  armjig latency DEVICE --target pty:/tmp/arm\n"
    "  armjig latency DEVICE --target emulated: --count 1000     in virtual time, at once\n"
    "  armjig latency DEVICE --target pty:/tmp/arm --limit 'p99<2ms,lost<1' --html report.html\n"
    "  armjig latency DEVICE --target pty:/tmp/old --against pty:/tmp/new --seconds 60\n"
    "  armjig latency DEVICE --from session.pcapng               what a recording shows\n"
    "\n"
    "Sends a harmless request again and again: what is sent, and what the guard has to be told "
    "for\n"
    "it, docs/latency.md has for each device. Ctrl-C ends it with a report of what was measured.\n"
    "\n"
    "Exit codes: 0 measured and within limits, 1 a limit is broken or it is slower, 3 the target\n"
    "is absent, refuses or is silent, or nothing can be said, 130 interrupted.";

/// Of two targets that are alternated: short, so that each has its share of whatever the machine
/// does beside, and with some requests in it.
Duration slice_of_time(const std::optional<Duration>& period) {
  constexpr Duration kSlice = 250ms;
  constexpr int kFewestRequests = 20;
  return period ? std::max(kSlice, kFewestRequests * *period) : kSlice;
}

constexpr std::uint64_t kMostSlices = 1'000'000;

/// A target that is measured.
class Station {
 public:
  /// `exchange`: another than the probe's first; empty: that.
  static Outcome<std::unique_ptr<Station>> open(const Device& device, const RigOptions& how,
                                                const std::string& exchange) {
    auto opened = open_probe(device, how);
    if (!opened) return tl::unexpected{opened.error()};
    if (!exchange.empty()) {
      const auto chosen = opened->probe->choose(exchange);
      if (!chosen) return tl::unexpected{chosen.error()};
    }
    return std::make_unique<Station>(*std::move(opened), how);
  }
  Station(ProbedLink opened, const RigOptions& how)
      : link_{std::move(opened.link)}, probe_{std::move(opened.probe)} {
    const auto line = direct_line(link_.port(), how);
    path_ = line ? path_on(link_.port(), *line) : path_through(link_.port());
  }

  void begin(const MeterPlan& plan, const Signals& signals, MeterProgress& progress) {
    meter_.emplace(*path_, *probe_, plan, [&signals] { return signals.has_come(); }, &progress);
  }
  [[nodiscard]] Meter& meter() { return *meter_; }
  [[nodiscard]] const Probe& probe() const { return *probe_; }
  [[nodiscard]] const Path& path() const { return *path_; }
  [[nodiscard]] Result<LatencyHistogram> time_sending(const SendingPlan& plan,
                                                      const Signals& signals) {
    return armjig::time_sending(*path_, *probe_, plan, [&signals] { return signals.has_come(); });
  }

  /// Why the guard would refuse the request.
  [[nodiscard]] std::optional<Problem> refusal_of(const RigOptions& how) const {
    if (how.target.is_emulated()) return std::nullopt;
    const auto refusal = demand(probe_->hazard(), how.permissions, probe_->exchange());
    if (!refusal) return std::nullopt;
    return Problem{ErrorCode::kForbidden, how.target.text, refusal->reason};
  }
  /// Why it cannot go on.
  [[nodiscard]] Problem problem_of(const Error& error, const std::string& target) const {
    const auto refusal = link_.last_refusal();
    if (error.code == ErrorCode::kForbidden && refusal) {
      return {error.code, target, refusal->reason};
    }
    return {error.code, target, "is it still there and switched on?"};
  }

 private:
  StreamLink link_;
  std::unique_ptr<Probe> probe_;
  std::unique_ptr<Path> path_;
  std::optional<Meter> meter_;
};

/// Says once a second how far it is, on a thread of its own.
class ProgressLine {
 public:
  explicit ProgressLine(const MeterProgress& progress) : progress_{progress} {
    thread_ = std::thread{[this] { run(); }};
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() {
    must_end_ = true;
    thread_.join();
  }

 private:
  void run() {
    be_ordinary();
    for (int i = 1; !must_end_; ++i) {
      std::this_thread::sleep_for(100ms);
      if (i % 10 != 0 || must_end_) continue;
      fmt::print(stderr, "{} s: {} answered, {} lost, worst {:.3f} ms\n", i / 10,
                 progress_.answered.load(), progress_.lost.load(),
                 static_cast<double>(progress_.worst.load()) / 1e6);
    }
  }

  const MeterProgress& progress_;
  std::atomic<bool> must_end_ = false;
  std::thread thread_;
};

std::string machine() {
  utsname names{};
  if (::uname(&names) != 0) return "unknown";
  return fmt::format("{} {}, {}, {} processors", names.sysname, names.release, names.machine,
                     std::thread::hardware_concurrency());
}

/// Both targets in turn, a slice each. False: interrupted.
Result<bool> alternate(std::span<const std::unique_ptr<Station>> stations, const Wanted& wanted,
                       std::array<std::vector<Slice>, 2>& slices) {
  const bool is_counted = wanted.until.time == Duration::max();
  const auto slice = slice_of_time(wanted.plan.period);
  const auto per_slice = wanted.plan.period ? slice / *wanted.plan.period : 100;
  const auto count_a_slice =
      static_cast<std::uint64_t>(std::max<Duration::rep>(per_slice, 1)) * wanted.plan.burst;
  const auto all = is_counted ? wanted.until.count / count_a_slice
                              : static_cast<std::uint64_t>(wanted.until.time / slice);
  for (std::uint64_t i = 0; i < std::clamp<std::uint64_t>(all, 1, kMostSlices); ++i) {
    // Who comes first changes, or one would always follow the other.
    for (const std::size_t side : {i % 2, 1 - i % 2}) {
      auto& meter = stations[side]->meter();
      const auto before = meter.measured().trips.size();
      const auto until =
          is_counted ? Meter::Until{.count = count_a_slice} : Meter::Until{.time = slice};
      const auto done = meter.run(until);
      if (!done || !*done) return done;
      const auto trips = std::span{meter.measured().trips}.subspan(before);
      if (!trips.empty()) slices[side].push_back(slice_of(trips));
    }
  }
  return true;
}

Exit exit_of(const Report& report, const LatencyRun& run, const Signals& signals) {
  if (run.is_interrupted) return signals.exit();
  if (report.count(Verdict::kFail) > 0) return Exit::kFindings;
  return report.count(Verdict::kInconclusive) > 0 ? Exit::kRig : Exit::kPassed;
}

/// A joint of the target, or of a usual one if that is not emulated.
Outcome<std::unique_ptr<Follower>> open_follower(const Device& device,
                                                 const LatencyOptions& options) {
  const auto& text = options.target.target;
  return parse_target(text.starts_with("emulated:") ? text : "emulated:")
      .and_then([&device](Target target) {
        return cli::open_follower(device, {.target = std::move(target)});
      });
}

/// What the delays would cost the device's loop, in virtual time.
Outcome<void> add_cost(LatencyRun& run, const Device& device, const LatencyOptions& options) {
  if (!options.has_cost || run.measured.round_trips.count() == 0) return {};
  JitterCostHow how{.limit = options.cost_limit, .seed = options.seed};
  if (run.plan.period) how.rate = 1e9 / static_cast<double>(run.plan.period->count());
  auto cost = cost_of(run.measured, [&] { return open_follower(device, options); }, how);
  if (!cost) return tl::unexpected{cost.error()};
  run.cost = *std::move(cost);
  return {};
}

/// What is left to be known once it has ended.
void finish(LatencyRun& run, const Wanted& wanted) {
  for (const auto& limit : wanted.limits) run.limits.push_back(check(limit, run.measured));
  if (!wanted.baseline) return;
  if (const auto floor = noise_floor_of(run.measured)) {
    const auto median = percentiles_of(run.measured).front().raw;
    run.comparison = compare_with(*wanted.baseline, median, *floor);
  } else {
    run.comparison = LatencyComparison{.rests_on = "too few answers for a noise floor",
                                       .difference = Difference::kUnclear};
  }
}

/// The run that is in the file, a recording or a log of histograms.
Outcome<LatencyRun> parse_run(Devices devices, const Device& device,
                              const LatencyOptions& options) {
  auto file = options.from == "-" ? UserFile::standard_input() : UserFile::open(options.from);
  if (!file) return tl::unexpected{std::move(file.error())};
  if (file->peek() == '#' || file->peek() == '"') {
    return file->rest().and_then(
        [&options](const std::string& log) { return run_of_log(log, options.from); });
  }
  if (device.make_listener == nullptr) {
    return problem(ErrorCode::kUnsupported, options.from,
                   "nobody has said what requests and answers of this device are in a recording");
  }
  const auto how = foreign_how(devices, {}, device.name);
  if (!how) return tl::unexpected{how.error()};
  auto reader = open_foreign(*std::move(file), options.from, *how);
  if (!reader) return tl::unexpected{std::move(reader.error())};
  const auto is_ours = [&](std::string_view name) {
    return name.empty() || find_recorded_device(devices, name) == &device;
  };
  auto run = run_of(**reader, {.make_listener = device.make_listener,
                               .is_ours = is_ours,
                               .patience = duration_of(options.timeout)});
  if (run) print_warning_of(**reader);
  return run;
}

Outcome<LatencyRun> read_run(Devices devices, const Device& device, const LatencyOptions& options) {
  auto run = parse_run(devices, device, options);
  if (!run) return run;
  if (run->measured.round_trips.count() == 0) {
    return problem(ErrorCode::kMalformed, options.from,
                   fmt::format("no answer of a {} to a request is in there", options.device));
  }
  run->device = std::string{device.name};
  run->target = options.from;
  return run;
}

/// How measuring ended.
struct Ended {
  LatencyRun run;
  std::optional<Problem> failure;  ///< after which nothing more could be measured
};

/// Measures a target, or two in turn.
Outcome<Ended> measure(const Device& device, std::span<const RigOptions> hows,
                       const LatencyOptions& options, const Wanted& wanted,
                       const Signals& signals) {
  std::vector<std::unique_ptr<Station>> stations;
  for (const auto& one : hows) {
    auto station = Station::open(device, one, options.exchange);
    if (!station) return tl::unexpected{station.error()};
    if (auto refused = (*station)->refusal_of(one)) return tl::unexpected{*std::move(refused)};
    stations.push_back(*std::move(station));
  }
  const auto& how = hows.front();
  LatencyRun run{.device = std::string{device.name},
                 .target = how.target.text,
                 .exchange = std::string{stations[0]->probe().exchange()},
                 .path = std::string{stations[0]->path().name()},
                 .machine = machine(),
                 .load = options.load,
                 .plan = wanted.plan,
                 .time_on_wire = stations[0]->probe().time_on_wire()};
  MeterProgress progress;
  for (const auto& station : stations) station->begin(wanted.plan, signals, progress);

  std::array<std::vector<Slice>, 2> slices;
  const auto work = [&] {
    return stations.size() == 2 ? alternate(stations, wanted, slices)
                                : stations[0]->meter().run(wanted.until);
  };
  Result<bool> done;
  if (how.target.is_emulated()) {
    done = work();
  } else {
    run.started = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    const Realtime realtime{{.priority = options.priority, .processor = options.processor}};
    run.privileges = realtime.privileges();
    const Load load{wanted.load.value_or(LoadPlan{})};
    const ProgressLine line{progress};
    Sentinel sentinel{stations[0]->path().now(), 1ms, 100us};
    done = work();
    sentinel.stop();
    if (done && *done && options.sending > 0) {
      // What was measured is not lost with the link.
      run.sending = stations.back()
                        ->time_sending({.count = options.sending,
                                        .period = wanted.plan.period.value_or(10ms),
                                        .patience = wanted.plan.patience},
                                       signals)
                        .value_or(LatencyHistogram{});
    }
    run.witness =
        Witness{sentinel.lateness(), {sentinel.oversleeps().begin(), sentinel.oversleeps().end()}};
  }
  run.measured = stations.back()->meter().measured();
  run.is_interrupted = done && !*done;
  if (stations.size() == 2) {
    run.target = fmt::format("{} against {}", hows[1].target.text, hows[0].target.text);
    run.comparison = compare_alternated(slices[0], slices[1], 1);
  }
  run.figures = stations.back()->probe().figures(
      {.period = wanted.plan.period, .median = run.measured.round_trips.percentile(50)});
  Ended ended{std::move(run), std::nullopt};
  if (!done) {
    const auto& failed = *std::ranges::max_element(
        stations, {}, [](const auto& station) { return station->meter().measured().lost; });
    ended.failure = failed->problem_of(done.error(), ended.run.target);
  } else if (ended.run.measured.round_trips.count() == 0 && !ended.run.is_interrupted) {
    ended.failure = {ErrorCode::kTimedOut, ended.run.target,
                     fmt::format("no answer came: is a {} there, switched on, and free for us?",
                                 options.device)};
  }
  return ended;
}

Exit latency(Devices devices, const LatencyOptions& options) {
  const auto found = find_device(devices, options.device);
  if (!found) return report(found.error());
  std::vector<RigOptions> hows;
  if (options.from.empty()) {
    auto targets = targets_of(options);
    if (!targets) return report(targets.error());
    hows = *std::move(targets);
  }
  const auto points = points_of(options);
  if (!points) return report(points.error());
  // What is wrong is said before files are opened.
  if (const auto wanted = wanted_of(options); !wanted) return report(wanted.error());
  if (options.has_cost) {
    const auto joint = open_follower(**found, options);
    if (!joint) return report(joint.error());
  }
  const auto files = open_outputs(
      {{"--json", options.json}, {"--html", options.html}, {"--hlog", options.histogram_log}});
  if (!files) return report(files.error());

  const Signals signals;
  std::vector<LatencyRun> runs;
  std::optional<Problem> failure;
  for (const auto& point : *points) {
    const auto wanted = wanted_of(point.options);
    if (!wanted) return report(wanted.error());
    auto ended = options.from.empty() ? measure(**found, hows, point.options, *wanted, signals)
                                      : read_run(devices, **found, options).map([](LatencyRun run) {
                                          return Ended{std::move(run), std::nullopt};
                                        });
    if (!ended) return report(ended.error());
    auto& run = runs.emplace_back(std::move(ended->run));
    run.name = point.name;
    finish(run, *wanted);
    if (const auto added = add_cost(run, **found, options); !added) return report(added.error());
    failure = ended->failure;
    if (failure || run.is_interrupted) break;
  }

  const bool is_one = options.sweep.empty();
  const auto result = is_one ? report_of(runs.front()) : report_of(runs);
  const auto& [object, html, log] = *files;
  if (object != nullptr)
    object->put(is_one ? to_latency_json(runs.front()) : to_latency_json(runs));
  if (html != nullptr) html->put(to_html(result));
  if (log != nullptr) log->put(to_latency_log(runs.front()));
  fmt::print("{}", to_text(result));
  if (failure) return report(*failure);
  return exit_of(result, runs.back(), signals);
}

}  // namespace

void add_latency(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("latency", with_example(kLatencyHelp, devices));
  const auto options = std::make_shared<LatencyOptions>();
  add_latency_options(*command, *options, devices);
  when_chosen(*command, action, [options, devices] { return latency(devices, *options); });
}

}  // namespace armjig::cli
