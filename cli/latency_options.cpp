// SPDX-License-Identifier: Apache-2.0
#include "cli/latency_options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "cli/checks.hpp"
#include "harness/core/number.hpp"
#include "harness/files/user_file.hpp"

namespace armjig::cli {
namespace {

constexpr double kLeastRate = 0.1;
constexpr double kMostRate = 20'000;
constexpr double kUsualSeconds = 10;

std::optional<Problem> problem_of(const LatencyOptions& options, const RigOptions& how) {
  const bool is_virtual = how.target.is_emulated();
  if (is_virtual && !options.load.empty()) {
    return Problem{ErrorCode::kBadValue, "--load", "it means nothing in virtual time"};
  }
  if (is_virtual && options.sending > 0) {
    return Problem{ErrorCode::kBadValue, "--sending", "in virtual time nothing leaves"};
  }
  if (is_virtual && options.is_closed_loop && !options.count) {
    return Problem{ErrorCode::kBadValue, "--closed-loop",
                   "virtual time may stand still: say --count"};
  }
  if (!options.against.empty() && options.is_closed_loop && options.count) {
    return Problem{ErrorCode::kBadValue, "--against", "say --seconds, for each of both"};
  }
  return std::nullopt;
}

}  // namespace

Outcome<Wanted> wanted_of(const LatencyOptions& options) {
  Wanted wanted;
  wanted.plan.period.reset();
  if (!options.is_closed_loop) wanted.plan.period = duration_of(1 / options.rate);
  wanted.plan.burst = options.burst;
  wanted.plan.patience = duration_of(options.timeout);
  if (options.count) wanted.until.count = *options.count;
  const auto seconds = options.seconds.value_or(kUsualSeconds);
  if (!options.count) wanted.until.time = duration_of(seconds);
  const auto expected = options.count ? static_cast<double>(*options.count)
                                      : seconds * (options.is_closed_loop ? 20e3 : options.rate) *
                                            static_cast<double>(options.burst);
  wanted.plan.expected =
      static_cast<std::size_t>(std::min(expected, static_cast<double>(Meter::kMostTrips)));
  if (!options.load.empty()) {
    const auto load = parse_load(options.load);
    if (!load) return tl::unexpected{load.error()};
    wanted.load = *load;
  }
  if (!options.limits.empty()) {
    auto limits = parse_limits(options.limits);
    if (!limits) return tl::unexpected{limits.error()};
    wanted.limits = *std::move(limits);
  }
  if (!options.baseline.empty()) {
    const auto text = read_user_file(options.baseline);
    if (!text) return tl::unexpected{text.error()};
    auto baseline = parse_baseline(*text, options.baseline);
    if (!baseline) return tl::unexpected{baseline.error()};
    wanted.baseline = *std::move(baseline);
  }
  return wanted;
}

Outcome<std::vector<Point>> points_of(const LatencyOptions& options) {
  if (options.sweep.empty()) return std::vector{Point{{}, options}};
  constexpr std::size_t kMostPoints = 20;
  const auto wrong = [&options] {
    return problem(ErrorCode::kBadValue, fmt::format("--sweep {}", options.sweep),
                   "write rate=50,100,200 or burst=1,2,4, each once, up to 20");
  };
  const std::string_view text{options.sweep};
  const auto sign = text.find('=');
  const auto key = text.substr(0, sign);
  if (sign == std::string_view::npos || (key != "rate" && key != "burst")) return wrong();
  std::vector<Point> points;
  for (auto rest = text.substr(sign + 1);; rest = rest.substr(rest.find(',') + 1)) {
    const auto word = rest.substr(0, rest.find(','));
    Point point{fmt::format("{}={}", key, word), options};
    if (key == "rate") {
      const auto rate = whole_text_as<double>(word);
      if (!rate || !(*rate >= kLeastRate && *rate <= kMostRate)) return wrong();
      point.options.rate = *rate;
    } else {
      const auto burst = whole_text_as<std::size_t>(word);
      if (!burst || *burst < 1 || *burst > Meter::kMostBurst) return wrong();
      point.options.burst = *burst;
    }
    const bool is_twice = std::ranges::find(points, point.name, &Point::name) != points.end();
    if (is_twice || points.size() == kMostPoints) return wrong();
    points.push_back(std::move(point));
    if (rest.find(',') == std::string_view::npos) return points;
  }
}

Outcome<std::vector<RigOptions>> targets_of(const LatencyOptions& options) {
  auto how = parse_target_options(options.target);
  if (!how) return tl::unexpected{how.error()};
  if (auto wrong = problem_of(options, *how)) return tl::unexpected{*std::move(wrong)};
  std::vector<RigOptions> hows{*std::move(how)};
  if (options.against.empty()) return hows;
  auto other = parse_target(options.against);
  if (!other) return tl::unexpected{other.error()};
  if (other->is_emulated() != hows[0].target.is_emulated()) {
    return problem(ErrorCode::kBadValue, "--against",
                   "virtual time and real time cannot be compared");
  }
  hows.push_back(hows[0]);
  hows.back().target = *std::move(other);
  hows.back().capture = {};
  return hows;
}

void add_latency_options(CLI::App& command, LatencyOptions& options, Devices devices) {
  add_device_argument(command, options.device, devices);
  add_target_options(command, options.target);
  auto* against = command
                      .add_option("--against", options.against,
                                  "also measure this target, in turn with the first: is it slower?")
                      ->type_name("TARGET");
  command
      .add_option("--compare", options.baseline, "is it slower than this --json of another run?")
      ->type_name("FILE")
      ->excludes(against);
  command
      .add_option("--exchange", options.exchange,
                  "what is asked, if the device has several (docs/latency.md)")
      ->type_name("NAME");
  auto* rate = command.add_option("--rate", options.rate, "requests a second (default: 100)")
                   ->type_name("HZ")
                   ->check(number(kLeastRate, kMostRate));
  command
      .add_flag("--closed-loop", options.is_closed_loop,
                "the next request as soon as the answer is there")
      ->excludes(rate);
  command.add_option("--burst", options.burst, "requests right after each other (default: 1)")
      ->type_name("N")
      ->transform(whole(1, Meter::kMostBurst));
  auto* count = command.add_option("--count", options.count, "end after that many requests")
                    ->type_name("N")
                    ->transform(whole(1, std::uint64_t{1} << 62U));
  command.add_option("--seconds", options.seconds, "end after that time (default: 10)")
      ->type_name("S")
      ->check(number(0.001, 1e7))
      ->excludes(count);
  command
      .add_option("--sending", options.sending,
                  "afterwards time how long so many further requests take to the link (TCP)")
      ->type_name("N")
      ->transform(whole(1, 10'000));
  command
      .add_option("--timeout", options.timeout, "an answer later than that is lost (default: 1)")
      ->type_name("S")
      ->check(number(0.001, 60));
  command.add_option("--load", options.load, "threads that keep the machine busy: cpu=2,io=1")
      ->type_name("LIST");
  command.add_option("--limit", options.limits, "exit code 1 if it is not kept: p99<2ms,lost<1")
      ->type_name("LIST");
  command.add_option("--priority", options.priority, "of SCHED_FIFO, if allowed (default: 50)")
      ->type_name("N")
      ->transform(whole(1, 99));
  command.add_option("--processor", options.processor, "stay on that one, if allowed")
      ->type_name("N")
      ->transform(whole(0, 1023));
  command.add_option("--json", options.json, "also write all of it as JSON (armjig.latency/1)")
      ->type_name("FILE");
  command.add_option("--html", options.html, "also write a page with curves")->type_name("FILE");
  command.add_option("--hlog", options.histogram_log, "also write a log for HdrHistogram's tools")
      ->type_name("FILE");
  auto* cost = command.add_flag("--cost", options.has_cost,
                                "also tell what such delays cost the loop of an emulated joint");
  command
      .add_option("--cost-limit", options.cost_limit,
                  "of its error, for the highest rate (default: twice that of steady delays)")
      ->type_name("STEPS")
      ->check(number(0, 1e9))
      ->needs(cost);
  command.add_option("--seed", options.seed, "of the delays that are drawn (default: 1)")
      ->type_name("N")
      ->transform(whole(0, std::uint64_t{1} << 32U))
      ->needs(cost);
  auto* sweep =
      command
          .add_option("--sweep", options.sweep, "a run for each: rate=50,100,200 or burst=1,2,4")
          ->type_name("LIST")
          ->excludes(against);
  for (const auto* const other : {"--compare", "--closed-loop", "--hlog"}) {
    sweep->excludes(command.get_option(other));
  }
  auto* from = command.add_option("--from", options.from,
                                  "measure nothing: what a recording or a log of --hlog shows");
  from->type_name("FILE");
  for (const auto* const other :
       {"--target", "--allow", "--impair", "--capture", "--rotate", "--redact", "--against",
        "--exchange", "--rate", "--closed-loop", "--burst", "--sweep", "--count", "--seconds",
        "--load", "--priority", "--processor", "--sending"}) {
    from->excludes(command.get_option(other));
  }
}

}  // namespace armjig::cli
