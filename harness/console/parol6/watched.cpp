// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <utility>
#include <variant>

#include "harness/console/parol6/console.hpp"
#include "harness/console/parol6/view.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/drive/parol6/telemetry_json.hpp"
#include "harness/wire/parol6/splitter.hpp"

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
    while (!bytes.empty()) {
      const auto step = splitter_.step(bytes);
      bytes = bytes.subspan(step.used);
      const auto* found = std::get_if<Splitter::Frame>(&step.found);
      if (found == nullptr) continue;
      const auto whole = found->bytes.first<kTelemetryFrameSize>();
      frames_.emplace_back(now, decode_telemetry(body_of(whole)));
    }
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
