// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>

#include <array>
#include <nlohmann/json.hpp>

#include "harness/latency/latency_run.hpp"
#include "harness/timing/histogram_log.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;

Json summary_of(const LatencyHistogram& histogram) {
  return {{"count", histogram.count()},
          {"min_ns", histogram.min().count()},
          {"mean_ns", histogram.mean().count()},
          {"p50_ns", histogram.percentile(50).count()},
          {"p99_ns", histogram.percentile(99).count()},
          {"max_ns", histogram.max().count()}};
}

Json round_trip_of(const Measured& measured) {
  Json json = summary_of(measured.round_trips);
  json["confidence"] = kLatencyConfidence;
  json["noise_floor"] = nullptr;
  if (const auto floor = noise_floor_of(measured)) {
    json["noise_floor"] = {{"low_ns", floor->low.count()}, {"high_ns", floor->high.count()}};
  }
  json["percentiles"] = Json::array();
  for (const auto& row : percentiles_of(measured)) {
    const auto end = [&row](Duration ConfidenceInterval::* which) {
      return row.interval ? Json((*row.interval.*which).count()) : Json(nullptr);
    };
    json["percentiles"].push_back({{"percent", row.percent},
                                   {"ns", row.raw.count()},
                                   {"low_ns", end(&ConfidenceInterval::low)},
                                   {"high_ns", end(&ConfidenceInterval::high)},
                                   {"corrected_ns", row.corrected.count()}});
  }
  return json;
}

std::string date_of(const LatencyRun& run) {
  if (run.started) return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", *run.started);
  return run.is_virtual() ? "virtual" : "unknown";
}

Json outliers_of(const LatencyRun& run) {
  constexpr std::array<const char*, 5> kWords{"due", "sent", "came", "answered", "lost"};
  Json all = Json::array();
  for (const auto& outlier : run.measured.outliers) {
    Json events = Json::array();
    for (std::size_t i = 0; i < outlier.event_count; ++i) {
      const auto& event = outlier.events[i];
      events.push_back({{"after_sending_ns", (event.time - outlier.trip.sent).count()},
                        {"event", kWords[static_cast<std::size_t>(event.kind)]},
                        {"bytes", event.bytes}});
    }
    all.push_back({{"sent_ns", outlier.trip.sent.time_since_epoch().count()},
                   {"round_trip_ns", outlier.trip.duration.count()},
                   {"who", blame_of(outlier, run)},
                   {"events", std::move(events)}});
  }
  return all;
}

Json comparison_of(const std::optional<LatencyComparison>& comparison) {
  if (!comparison) return nullptr;
  Json json{{"difference", to_string(comparison->difference)},
            {"confidence", comparison->confidence},
            {"rests_on", comparison->rests_on},
            {"figures", Json::array()}};
  for (const auto& one : comparison->figures) {
    json["figures"].push_back({{"figure", one.figure},
                               {"first_ns", one.first.count()},
                               {"second_ns", one.second.count()},
                               {"low_ns", one.interval.low.count()},
                               {"high_ns", one.interval.high.count()},
                               {"difference", to_string(one.difference)}});
  }
  return json;
}

Json error_of(const TrackingError& error) {
  return {{"p99", error.p99},
          {"rms", error.rms},
          {"most", error.most},
          {"skipped_share", error.skipped}};
}

Json cost_of(const std::optional<JitterCost>& cost) {
  if (!cost) return nullptr;
  Json json{{"unit", cost->unit},
            {"seed", cost->seed},
            {"virtual_ns", cost->time.count()},
            {"rate_hz", cost->rate},
            {"p99_ns", cost->p99.count()},
            {"steady", error_of(cost->steady)},
            {"measured", error_of(cost->measured)},
            {"limit", cost->limit},
            {"highest_rate_hz", cost->highest_rate ? Json(*cost->highest_rate) : Json(nullptr)},
            {"rates", Json::array()}};
  for (const auto& [rate, error] : cost->rates) {
    json["rates"].push_back({{"rate_hz", rate}, {"error", error_of(error)}});
  }
  return json;
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json json_of(const LatencyRun& run) {
  const auto& measured = run.measured;
  Json json{{"schema", "armjig.latency/1"},
            {"device", run.device},
            {"target", run.target},
            {"measured", run.exchange},
            {"path", run.path},
            {"machine", run.machine},
            {"load", run.load},
            {"date", date_of(run)},
            {"is_virtual", run.is_virtual()},
            {"is_recorded", run.is_recorded},
            {"left_out", run.left_out},
            {"is_interrupted", run.is_interrupted},
            {"period_ns", run.plan.period ? Json(run.plan.period->count()) : Json(nullptr)},
            {"burst", run.plan.burst},
            {"time_ns", measured.time.count()},
            {"sent", measured.sent},
            {"lost", measured.lost},
            {"skipped", measured.skipped},
            {"surplus", measured.surplus}};
  json["permissions"] = Json::array();
  for (const auto& one : run.privileges) {
    json["permissions"].push_back(
        {{"what", one.name}, {"is_granted", one.is_granted}, {"text", one.text}});
  }
  json["round_trip"] = round_trip_of(measured);
  json["corrected"] = summary_of(measured.corrected);
  json["lateness"] = summary_of(measured.lateness);
  json["sentinel"] = run.witness ? summary_of(run.witness->lateness) : Json(nullptr);
  json["shares"] = Json::array();
  if (measured.round_trips.count() > 0) {
    for (const auto& share : shares_of(run)) {
      json["shares"].push_back({{"of", share.of},
                                {"p50_ns", share.median.count()},
                                {"p99_ns", share.p99.count()},
                                {"rests_on", share.rests_on}});
    }
  }
  json["figures"] = Json::array();
  for (const auto& figure : run.figures) {
    json["figures"].push_back({{"name", figure.name},
                               {"value", figure.value},
                               {"unit", figure.unit},
                               {"rests_on", figure.rests_on}});
  }
  json["limits"] = Json::array();
  for (const auto& verdict : run.limits) {
    json["limits"].push_back({{"limit", verdict.limit.text},
                              {"actual", actual_text(verdict)},
                              {"is_kept", verdict.is_kept}});
  }
  json["comparison"] = comparison_of(run.comparison);
  json["cost"] = cost_of(run.cost);
  json["outliers"] = outliers_of(run);
  json["histogram"] = to_hdr_text(measured.round_trips);
  return json;
}

}  // namespace

std::string to_latency_json(const LatencyRun& run) { return text_of(json_of(run)); }

std::string to_latency_json(std::span<const LatencyRun> runs) {
  Json json{{"schema", "armjig.latency-runs/1"}, {"runs", Json::array()}};
  for (const auto& run : runs) {
    json["runs"].push_back({{"name", run.name}, {"run", json_of(run)}});
  }
  return text_of(json);
}

}  // namespace armjig
