// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <utility>

#include "harness/console/parol6/console.hpp"
#include "harness/console/parol6/view.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/drive/parol6/telemetry_json.hpp"
#include "harness/wire/parol6/splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::parol6::console {

using namespace drive;

namespace {

/// Frames that a board answers without doing anything, counted by the drive.
class WatchedBoard final : public WatchedStream {
 public:
  WatchedBoard(Rig<StreamPort> rig, Duration period)
      : WatchedStream{StreamLink{std::move(rig)}}, drive_{period} {}

  void finish() override { drive_.give_up_outstanding(); }
  std::uint64_t answers() const override {
    return drive_.statistics().answered + drive_.statistics().surplus;
  }
  std::vector<std::string> json_lines() const override {
    std::vector<std::string> lines;
    for (const auto& [time, frame] : frames_) {
      lines.push_back(to_json(time, frame, drive_.statistics()));
    }
    return lines;
  }
  std::vector<std::string> lines() const override {
    if (!drive_.telemetry()) return {};
    const auto& link = drive_.statistics();
    return {fmt::format("{}  sent {} lost {} late {} bad {}", one_line(*drive_.telemetry()),
                        link.sent, link.lost, link.late, link.bad)};
  }
  std::string panel() const override {
    return drive_.telemetry() ? console::panel(*drive_.telemetry()) : std::string{};
  }
  std::string link() const override { return link_panel(drive_.statistics()); }

 private:
  std::vector<std::byte> request(Instant now) override {
    const auto frame = drive_.tick(now);
    return {frame.begin(), frame.end()};
  }
  void receive(Instant now, Bytes bytes) override {
    frames_.clear();
    drive_.receive(now, bytes);
    (void)drive_.take_events();
    for_each_step(splitter_, bytes, [&](const Splitter::Step& step) {
      if (const auto frame = telemetry_of(step)) frames_.emplace_back(now, *frame);
    });
  }

  Drive drive_;
  Splitter splitter_{kTelemetryPayloadSize};
  std::vector<std::pair<Instant, TelemetryFrame>> frames_;
};

}  // namespace

Outcome<std::unique_ptr<Watched>> watch(Rig<StreamPort> rig, const std::string& /*target*/,
                                        const WatchHow& how) {
  return std::make_unique<WatchedBoard>(std::move(rig), how.period);
}

}  // namespace armjig::parol6::console
