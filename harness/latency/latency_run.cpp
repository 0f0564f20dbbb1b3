// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/latency_run.hpp"

#include <fmt/chrono.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "harness/timing/histogram_log.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kShownEvents = 5;  ///< of an outlier, for people

std::string text_of(Duration duration) {
  const auto nanoseconds = static_cast<double>(duration.count());
  if (nanoseconds > -1e6 && nanoseconds < 1e6) return fmt::format("{:.1f} us", nanoseconds / 1e3);
  return fmt::format("{:.3f} ms", nanoseconds / 1e6);
}
double as_milliseconds(Duration duration) { return static_cast<double>(duration.count()) / 1e6; }

std::string rate_of(const LatencyRun& run) {
  const auto& plan = run.plan;
  if (run.is_recorded && !plan.period) return "unknown";
  auto text = plan.period
                  ? fmt::format("{:g} requests/s", 1e9 / static_cast<double>(plan.period->count()))
                  : std::string{"closed loop"};
  if (plan.burst > 1) text += fmt::format(" in bursts of {}", plan.burst);
  return text;
}

std::string counts_of(const Measured& measured) {
  return fmt::format("{} sent, {} answered, {} lost, {} not sent in time, {} answers to nothing",
                     measured.sent, measured.round_trips.count(), measured.lost, measured.skipped,
                     measured.surplus);
}

std::string privileges_of(const LatencyRun& run) {
  std::string text;
  for (const auto& one : run.privileges) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", one.name, one.text);
  }
  return text;
}

ReportRow row_of(const LimitVerdict& verdict) {
  ReportRow row{.name = "limit." + verdict.limit.text};
  row.verdict = verdict.is_kept ? Verdict::kPass : Verdict::kFail;
  row.summary = fmt::format("{}: {}", verdict.limit.text, actual_text(verdict));
  if (!verdict.is_known) row.summary += "; too few answers to know it well";
  row.expected = verdict.limit.text;
  row.actual = actual_text(verdict);
  return row;
}

ReportRow row_of(const LatencyComparison& comparison) {
  constexpr std::array kVerdicts{Verdict::kPass, Verdict::kFail, Verdict::kPass,
                                 Verdict::kInconclusive};
  ReportRow row{.name = "comparison"};
  row.verdict = kVerdicts[static_cast<std::size_t>(comparison.difference)];
  row.summary = std::string{to_string(comparison.difference)};
  for (const auto& one : comparison.figures) {
    row.summary +=
        fmt::format(", {} {} against {}, by {} to {}", one.figure, text_of(one.second),
                    text_of(one.first), text_of(one.interval.low), text_of(one.interval.high));
  }
  row.actual =
      fmt::format("{}; {:g} % confidence", comparison.rests_on, 100 * comparison.confidence);
  return row;
}

ReportSection round_trips_of(const LatencyRun& run) {
  const auto& measured = run.measured;
  ReportSection section{
      .title = "Round trips",
      .text = fmt::format("As they were, with the interval of {:g} % confidence; and corrected: "
                          "from when a request was due, with those that nobody could send while "
                          "an answer was late.",
                          100 * kLatencyConfidence),
      .table = {.columns = {"share", "as they were", "between", "corrected"}}};
  auto& rows = section.table.rows;
  rows.push_back(
      {"least", text_of(measured.round_trips.min()), "", text_of(measured.corrected.min())});
  for (const auto& row : percentiles_of(measured)) {
    const auto between = row.interval ? fmt::format("{} to {}", text_of(row.interval->low),
                                                    text_of(row.interval->high))
                                      : "unknown";
    rows.push_back(
        {fmt::format("{:g} %", row.percent), text_of(row.raw), between, text_of(row.corrected)});
  }
  rows.push_back(
      {"most", text_of(measured.round_trips.max()), "", text_of(measured.corrected.max())});
  rows.push_back(
      {"mean", text_of(measured.round_trips.mean()), "", text_of(measured.corrected.mean())});
  if (measured.lateness.count() > 0) {
    section.text += fmt::format(" Requests left late by {} at 50 %, 99 % and most.",
                                measured.lateness.summary());
  }
  return section;
}

Instant start_of(const Measured& measured) {
  return measured.trips.empty() ? Instant{} : measured.trips.front().sent;
}

double seconds_after(Instant start, Instant time) {
  return std::chrono::duration<double>{time - start}.count();
}

/// Of both ends apart: how late requests left, and how late answers were read.
std::vector<Plot> jitter_of(const Measured& measured) {
  const auto plot_of = [&measured](std::string title, std::string axis, auto delay_of) {
    Plot plot{.title = std::move(title), .x = {"time / s"}, .y = {std::move(axis)}};
    auto& points = plot.series.emplace_back().points;
    for (const auto& trip : measured.trips) {
      if (const std::optional<Duration> delay = delay_of(trip)) {
        points.push_back({seconds_after(start_of(measured), trip.sent), as_milliseconds(*delay)});
      }
    }
    return plot;
  };
  std::vector<Plot> plots;
  if (measured.lateness.count() > 0) {
    plots.push_back(plot_of("Sending", "sent after the deadline / ms",
                            [](const RoundTrip& trip) { return trip.late; }));
  }
  if (measured.delivery.count() > 0) {
    plots.push_back(plot_of("Receiving", "read after the kernel had it / ms",
                            [](const RoundTrip& trip) { return trip.delivery; }));
  }
  return plots;
}

ReportSection shares_section_of(const LatencyRun& run) {
  ReportSection section{.title = "Host, link or device",
                        .table = {.columns = {"share", "50 %", "99 %", "rests on"}}};
  for (const auto& share : shares_of(run)) {
    section.table.rows.push_back(
        {share.of, text_of(share.median), text_of(share.p99), share.rests_on});
  }
  section.plots = jitter_of(run.measured);
  return section;
}

ReportSection figures_of(const LatencyRun& run) {
  ReportSection section{.title = "Figures of the device",
                        .table = {.columns = {"figure", "value", "rests on"}}};
  for (const auto& figure : run.figures) {
    section.table.rows.push_back(
        {figure.name, fmt::format("{:.6g} {}", figure.value, figure.unit), figure.rests_on});
  }
  return section;
}

ReportSection cost_section_of(const JitterCost& cost) {
  const auto& unit = cost.unit;
  ReportSection section{
      .title = "What jitter costs",
      .text = fmt::format(
          "An emulated joint goes to and fro by {:g} set-points a second. At a p99 of {} its "
          "tracking error grows from {:.1f} to {:.1f} {} (99 % of the time), against answers that "
          "all take the median. {} Each figure rests on {:g} s of virtual time, seed {}; delays "
          "are drawn independently, half of each on either way.",
          cost.rate, text_of(cost.p99), cost.steady.p99, cost.measured.p99, unit,
          cost.highest_rate ? fmt::format("The highest rate that keeps it below {:.1f} is {:g} Hz.",
                                          cost.limit, *cost.highest_rate)
                            : fmt::format("None of these rates keeps it below {:.1f}.", cost.limit),
          std::chrono::duration<double>{cost.time}.count(), cost.seed),
      .table = {.columns = {"set-points / s", fmt::format("error at 99 % / {}", unit), "rms",
                            "most", "not sent in time"}}};
  const auto add = [&section](const std::string& name, const TrackingError& error) {
    section.table.rows.push_back(
        {name, fmt::format("{:.1f}", error.p99), fmt::format("{:.1f}", error.rms),
         fmt::format("{:.1f}", error.most), fmt::format("{:.2f} %", 100 * error.skipped)});
  };
  add(fmt::format("{:g}, all at the median", cost.rate), cost.steady);
  for (const auto& [rate, error] : cost.rates) add(fmt::format("{:g}", rate), error);
  return section;
}

std::string_view word_of(MeterEvent::Kind kind) {
  constexpr std::array<std::string_view, 5> kWords{"due", "sent", "came", "answered", "lost"};
  return kWords[static_cast<std::size_t>(kind)];
}

/// What plots call the table of the worst.
std::string name_of_worst(const LatencyRun& run) {
  auto name = run.name.empty() ? std::string{"worst"} : "worst-" + run.name;
  const auto is_other = [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) == 0;
  };
  std::ranges::replace_if(name, is_other, '-');
  return name;
}

ReportSection worst_of(const LatencyRun& run) {
  ReportSection section{.title = "The worst",
                        .table = {.columns = {"at", "round trip", "who", "last events / ms"},
                                  .name = name_of_worst(run)}};
  for (const auto& outlier : run.measured.outliers) {
    std::string events;
    const auto first = outlier.event_count - std::min(outlier.event_count, kShownEvents);
    for (auto i = first; i < outlier.event_count; ++i) {
      const auto& event = outlier.events[i];
      const std::chrono::duration<double, std::milli> after = event.time - outlier.trip.sent;
      events +=
          fmt::format("{}{:+.3f} {}", i == first ? "" : ", ", after.count(), word_of(event.kind));
    }
    section.table.rows.push_back(
        {fmt::format("{:.3f} s", seconds_after(start_of(run.measured), outlier.trip.sent)),
         text_of(outlier.trip.duration), blame_of(outlier, run), events});
  }
  return section;
}

Series curve_of(const LatencyHistogram& histogram, std::string name) {
  Series series{.name = std::move(name)};
  for (double beyond = 1; beyond <= static_cast<double>(histogram.count()); beyond *= 1.2) {
    series.points.push_back({beyond, as_milliseconds(histogram.percentile(100 - 100 / beyond))});
  }
  return series;
}

Plot curves_of(const Measured& measured) {
  Plot plot{.title = "Percentiles",
            .x = {"one of so many is longer", Scale::kLog},
            .y = {"round trip / ms"}};
  plot.series = {curve_of(measured.round_trips, "as they were"),
                 curve_of(measured.corrected, "corrected")};
  return plot;
}

Plot bars_of(const LatencyHistogram& histogram) {
  constexpr std::size_t kMostBars = 120;
  Plot plot{.title = "Histogram", .x = {"round trip / ms"}, .y = {"answers", Scale::kLog}};
  const auto first = LatencyHistogram::bucket_of(histogram.min());
  const auto last = LatencyHistogram::bucket_of(histogram.max());
  const auto width = (last - first) / kMostBars + 1;
  Series series{.shape = Shape::kBars};
  for (auto bucket = first; bucket <= last; bucket += width) {
    double sum = 0;
    for (auto i = bucket; i < bucket + width && i <= last; ++i) {
      sum += static_cast<double>(histogram.counts()[i]);
    }
    series.points.push_back({as_milliseconds(LatencyHistogram::first_of(bucket)), sum});
  }
  series.points.push_back({as_milliseconds(LatencyHistogram::last_of(last)), 0});
  plot.series.push_back(std::move(series));
  return plot;
}

Plot series_of(const LatencyRun& run) {
  const auto& measured = run.measured;
  Plot plot{.title = "In the order of time", .x = {"time / s"}, .y = {"round trip / ms"}};
  Series all{.name = "all"};
  for (const auto& trip : measured.trips) {
    all.points.push_back(
        {seconds_after(start_of(measured), trip.sent), as_milliseconds(trip.duration)});
  }
  Series worst{.name = "the worst", .shape = Shape::kDots, .opens = name_of_worst(run)};
  for (const auto& one : measured.outliers) {
    worst.points.push_back(
        {seconds_after(start_of(measured), one.trip.sent), as_milliseconds(one.trip.duration)});
  }
  plot.series = {std::move(all), std::move(worst)};
  return plot;
}

/// What the device's clock differs from the host's by, over the time between two requests.
Duration usual_shift(const std::vector<RoundTrip>& trips) {
  std::vector<Duration> shifts;
  for (const auto& trip : trips) {
    if (trip.shift) shifts.push_back(*trip.shift);
  }
  if (shifts.empty()) return {};
  const auto middle = shifts.begin() + static_cast<std::ptrdiff_t>(shifts.size() / 2);
  std::ranges::nth_element(shifts, middle);
  return *middle;
}

/// How much later than usual the device took the request, by its own clock: since the last one
/// whose answer was in time. None: its answers do not tell.
std::optional<Duration> taken_late(const RoundTrip& trip, const Measured& measured) {
  if (!trip.shift) return std::nullopt;
  const auto& trips = measured.trips;
  const auto usual = usual_shift(trips);
  const auto median = measured.round_trips.percentile(50);
  auto late = *trip.shift - usual;
  auto one = std::ranges::lower_bound(trips, trip.sent, {}, &RoundTrip::sent);
  while (one != trips.begin() && (--one)->duration - median > (trip.duration - median) / 4) {
    if (!one->shift) return std::nullopt;
    late += *one->shift - usual;
  }
  return late;
}

}  // namespace

std::vector<PercentileRow> percentiles_of(const Measured& measured) {
  std::vector<double> percents;
  std::vector<Duration> values;
  for (const auto& trip : measured.trips) values.push_back(trip.duration);
  const auto count =
      static_cast<double>(values.empty() ? measured.round_trips.count() : values.size());
  for (const double percent : {50.0, 90.0, 99.0, 99.9, 99.99, 99.999}) {
    // At least one answer is beyond it.
    if (count * (100 - percent) >= 99.9) percents.push_back(percent);
  }
  std::vector<ConfidenceInterval> intervals;
  if (!values.empty()) {
    intervals = percentile_intervals(values, percents, {.confidence = kLatencyConfidence});
  }
  std::vector<PercentileRow> rows;
  for (std::size_t i = 0; i < percents.size(); ++i) {
    rows.push_back({percents[i], measured.round_trips.percentile(percents[i]), std::nullopt,
                    measured.corrected.percentile(percents[i])});
    if (!intervals.empty()) rows.back().interval = intervals[i];
  }
  return rows;
}

std::optional<ConfidenceInterval> noise_floor_of(const Measured& measured) {
  constexpr std::size_t kStretches = 10;
  constexpr double kDeviations = 3;  // as many as normal values hardly ever lie out
  const auto rows = percentiles_of(measured);
  if (rows.empty() || !rows.front().interval) return std::nullopt;
  const std::span trips{measured.trips};
  const auto size = trips.size() / kStretches;
  if (size == 0) return std::nullopt;
  const auto median = static_cast<double>(rows.front().raw.count());
  double squares = 0;
  for (std::size_t i = 0; i < kStretches; ++i) {
    const auto off = static_cast<double>(slice_of(trips.subspan(i * size, size)).median.count());
    squares += (off - median) * (off - median);
  }
  const Duration noise{std::llround(kDeviations * std::sqrt(squares / kStretches))};
  return ConfidenceInterval{
      std::max(Duration{}, std::min(rows.front().interval->low, rows.front().raw - noise)),
      std::max(rows.front().interval->high, rows.front().raw + noise)};
}

std::vector<Share> shares_of(const LatencyRun& run) {
  const auto& measured = run.measured;
  std::vector<Share> shares;
  if (measured.lateness.count() > 0) {
    shares.push_back({"host, before sending", measured.lateness.percentile(50),
                      measured.lateness.percentile(99),
                      "the schedule's deadlines; not in the round trips as they were"});
  }
  const bool has_sending = run.sending && run.sending->count() > 0;
  const auto sending = has_sending ? run.sending->percentile(50) : Duration{};
  if (has_sending) {
    shares.push_back(
        {"host, sending", sending, run.sending->percentile(99),
         fmt::format("the kernel's time stamps of {} further requests", run.sending->count())});
  }
  if (measured.delivery.count() > 0) {
    shares.push_back({"host, after receiving", measured.delivery.percentile(50),
                      measured.delivery.percentile(99),
                      "the kernel's time stamps (SO_TIMESTAMPING)"});
  }
  auto rest = LatencyHistogram{};
  const auto wire = run.time_on_wire.value_or(Duration{});
  for (const auto& trip : measured.trips) {
    rest.record(trip.duration - sending - trip.delivery.value_or(Duration{}) - wire);
  }
  if (measured.trips.empty()) rest = measured.round_trips;
  if (run.time_on_wire) {
    shares.push_back({"link", wire, wire, "arithmetic: the bits of the exchange"});
  }
  shares.push_back({run.time_on_wire ? "device" : "device or link", rest.percentile(50),
                    rest.percentile(99),
                    run.is_recorded ? "what is left; the part of the host that recorded is in there"
                    : run.is_virtual() || measured.delivery.count() > 0
                        ? "what is left"
                        : "what is left; the host's own part is in there, for this link has no "
                          "time stamps"});
  return shares;
}

std::string blame_of(const Outlier& outlier, const LatencyRun& run) {
  const auto& trip = outlier.trip;
  const auto end = trip.sent + trip.duration;
  const auto slept =
      run.witness ? overslept_within(run.witness->oversleeps, trip.sent, end) : Duration{};
  const auto excess = trip.duration - run.measured.round_trips.percentile(50);
  if (slept * 2 > excess && slept > Duration{}) {
    return fmt::format("host: the sentinel overslept by {} meanwhile", text_of(slept));
  }
  if (trip.delivery && *trip.delivery * 2 > excess) {
    return fmt::format("host: the kernel had it {} earlier", text_of(*trip.delivery));
  }
  if (const auto taken = taken_late(trip, run.measured)) {
    if (*taken * 2 > excess) {
      return fmt::format("link, or a device that did not read: it took the request {} late",
                         text_of(*taken));
    }
    return "device, or the link from it: it took the request in time and answered late";
  }
  if (run.is_virtual()) return "device or link: in virtual time no host is late";
  if (trip.delivery) return "device or link: the kernel got it late, the sentinel was on time";
  return run.witness ? "device or link: the sentinel was on time" : "host, device or link";
}

Report report_of(const LatencyRun& run) {
  Report report{.title = fmt::format("Latency of {} at {}", run.device, run.target)};
  auto& facts = report.facts;
  facts = {{"target", run.target},
           {"measured", run.exchange},
           {"rate", rate_of(run)},
           {"requests", counts_of(run.measured)},
           {"path", run.path}};
  if (run.is_recorded) {
    facts.emplace_back("left out", fmt::format("{}", fmt::join(run.left_out, "; ")));
  } else {
    facts.emplace_back("machine", run.machine);
    facts.emplace_back("load", run.load.empty() ? "none of ours" : run.load);
  }
  if (!run.privileges.empty()) facts.emplace_back("permissions", privileges_of(run));
  if (run.sending && run.sending->count() == 0) {
    facts.emplace_back("sending", "unknown: on this link nobody stamps what leaves");
  }
  if (run.witness) {
    facts.emplace_back("sentinel", fmt::format("overslept by {} at 50 %, 99 % and most",
                                               run.witness->lateness.summary()));
  }
  facts.emplace_back("time", fmt::format("{:.3f} s{}{}", seconds_after({}, at(run.measured.time)),
                                         run.is_virtual() ? ", virtual" : "",
                                         run.is_interrupted ? "; interrupted" : ""));
  if (run.started)
    facts.emplace_back("date", fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", *run.started));
  report.started = run.started;
  for (const auto& limit : run.limits) report.rows.push_back(row_of(limit));
  if (run.comparison) report.rows.push_back(row_of(*run.comparison));
  if (run.measured.round_trips.count() == 0) return report;
  auto trips = round_trips_of(run);
  trips.plots = {curves_of(run.measured), bars_of(run.measured.round_trips)};
  if (!run.measured.trips.empty()) trips.plots.push_back(series_of(run));
  report.sections = {std::move(trips), shares_section_of(run)};
  if (!run.figures.empty()) report.sections.push_back(figures_of(run));
  if (run.cost) report.sections.push_back(cost_section_of(*run.cost));
  if (!run.measured.outliers.empty()) report.sections.push_back(worst_of(run));
  return report;
}

Report report_of(std::span<const LatencyRun> runs) {
  const auto& first = runs.front();
  Report report{
      .title = fmt::format("Latency of {} at {}, {} runs", first.device, first.target, runs.size()),
      .facts = report_of(first).facts,
      .started = first.started};
  // What is not the same in all of them is in the table.
  std::erase_if(report.facts, [](const auto& fact) {
    return fact.first == "rate" || fact.first == "requests" || fact.first == "time";
  });
  ReportSection together{.title = "Side by side",
                         .table = {.columns = {"run", "50 %", "99 %", "most", "99 % corrected",
                                               "sent", "lost", "not sent in time"}}};
  Plot plot{.title = "Percentiles, as they were",
            .x = {"one of so many is longer", Scale::kLog},
            .y = {"round trip / ms"}};
  for (const auto& run : runs) {
    const auto& measured = run.measured;
    together.table.rows.push_back(
        {run.name, text_of(measured.round_trips.percentile(50)),
         text_of(measured.round_trips.percentile(99)), text_of(measured.round_trips.max()),
         text_of(measured.corrected.percentile(99)), std::to_string(measured.sent),
         std::to_string(measured.lost), std::to_string(measured.skipped)});
    plot.series.push_back(curve_of(measured.round_trips, run.name));
  }
  together.plots.push_back(std::move(plot));
  report.sections.push_back(std::move(together));
  for (const auto& run : runs) {
    auto alone = report_of(run);
    for (auto& row : alone.rows) {
      row.name = fmt::format("{}.{}", row.name, run.name);
      row.summary = fmt::format("{}: {}", run.name, row.summary);
      report.rows.push_back(std::move(row));
    }
    for (auto& section : alone.sections) {
      section.title = fmt::format("{}: {}", run.name, section.title);
      report.sections.push_back(std::move(section));
    }
  }
  return report;
}

std::string to_latency_log(const LatencyRun& run) {
  const std::chrono::duration<double> length = run.measured.time;
  return to_histogram_log(run.started.value_or(std::chrono::sys_seconds{}),
                          {{"raw", 0s, length, run.measured.round_trips},
                           {"corrected", 0s, length, run.measured.corrected}});
}

}  // namespace armjig
