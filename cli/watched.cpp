// SPDX-License-Identifier: Apache-2.0
#include "cli/watched.hpp"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <optional>
#include <utility>
#include <variant>

#include "cli/kinovazed_view.hpp"
#include "cli/parol6_view.hpp"
#include "cli/server_stream.hpp"
#include "cli/target_options.hpp"
#include "harness/capture/message_json.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/drive/parol6/telemetry_json.hpp"
#include "harness/wire/demo/demo.hpp"
#include "harness/wire/dissector.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"
#include "harness/wire/parol6/splitter.hpp"

namespace armjig::cli {
namespace {

/// Shows whatever the dissector finds.
class WatchedDemo final : public Watched {
 public:
  std::vector<std::byte> request(Instant /*now*/) override {
    ++sent_;
    const auto query = demo::encode(demo::Operation::kQuery);
    return {query.begin(), query.end()};
  }
  void receive(Instant now, Bytes bytes) override {
    messages_.clear();
    dissector_->feed(Direction::kFromDevice, now, bytes, messages_);
    for (const auto& message : messages_) {
      if (!message.fault.empty()) continue;
      ++answers_;
      newest_ = message;
    }
  }
  void finish() override {}
  [[nodiscard]] std::uint64_t answers() const override { return answers_; }
  [[nodiscard]] std::vector<std::string> json_lines() const override {
    std::vector<std::string> lines;
    for (const auto& message : messages_) lines.push_back(to_json(message));
    return lines;
  }
  [[nodiscard]] std::string line() const override {
    std::string text{newest_.name};
    for (const auto& field : newest_.fields) {
      text +=
          fmt::format("  {} {}", field.name, field_text(field, field_value(field, newest_.raw)));
    }
    return text;
  }
  [[nodiscard]] std::string panel() const override {
    return answers_ == 0 ? std::string{} : to_text(newest_);
  }
  [[nodiscard]] std::string link() const override {
    return fmt::format("link       {} sent, {} answered\n", sent_, answers_);
  }

 private:
  std::unique_ptr<Dissector> dissector_ = demo::make_dissector();
  std::vector<Message> messages_;
  Message newest_;
  std::uint64_t sent_ = 0;
  std::uint64_t answers_ = 0;
};

/// Frames that a board answers without doing anything, counted by the drive.
class WatchedBoard final : public Watched {
 public:
  explicit WatchedBoard(Duration period) : drive_{period} {}

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
      const auto* found = std::get_if<parol6::Splitter::Frame>(&step.found);
      if (found == nullptr) continue;
      const auto whole = found->bytes.first<parol6::kTelemetryFrameSize>();
      frames_.emplace_back(now, parol6::decode_telemetry(parol6::body_of(whole)));
    }
  }
  void finish() override { drive_.give_up_outstanding(); }
  [[nodiscard]] std::uint64_t answers() const override {
    return drive_.statistics().answered + drive_.statistics().surplus;
  }
  [[nodiscard]] std::vector<std::string> json_lines() const override {
    std::vector<std::string> lines;
    for (const auto& [time, frame] : frames_) {
      lines.push_back(parol6::to_json(time, frame, drive_.statistics()));
    }
    return lines;
  }
  [[nodiscard]] std::string line() const override {
    if (!drive_.telemetry()) return {};
    const auto& link = drive_.statistics();
    return fmt::format("{}  sent {} lost {} late {} bad {}", one_line(*drive_.telemetry()),
                       link.sent, link.lost, link.late, link.bad);
  }
  [[nodiscard]] std::string panel() const override {
    return drive_.telemetry() ? cli::panel(*drive_.telemetry()) : std::string{};
  }
  [[nodiscard]] std::string link() const override { return link_panel(drive_.statistics()); }

 private:
  parol6::Drive drive_;
  parol6::Splitter splitter_{parol6::kTelemetryPayloadSize};
  std::vector<std::pair<Instant, parol6::TelemetryFrame>> frames_;
};

/// Beats and events, which come by themselves.
class WatchedServer final : public Watched {
 public:
  std::vector<std::byte> request(Instant /*now*/) override { return {}; }
  void receive(Instant now, Bytes bytes) override {
    messages_.clear();
    dissector_->feed(Direction::kFromDevice, now, bytes, messages_);
    while (!bytes.empty()) {
      const auto step = splitter_.step(bytes);
      bytes = bytes.subspan(step.used);
      if (step.found == kinovazed::LineSplitter::Found::kLine) take_line(step.line);
    }
  }
  void finish() override {}
  [[nodiscard]] std::uint64_t answers() const override { return beats_; }
  [[nodiscard]] std::vector<std::string> json_lines() const override {
    std::vector<std::string> lines;
    for (const auto& message : messages_) lines.push_back(to_json(message));
    return lines;
  }
  [[nodiscard]] std::string line() const override {
    return beat_ ? fmt::format("{}  ({})", state_of(*beat_), flags_of(*beat_)) : std::string{};
  }
  [[nodiscard]] std::string panel() const override {
    if (!beat_) return {};
    return fmt::format("state      {}\nbeat       {}\n", state_of(*beat_), flags_of(*beat_));
  }
  [[nodiscard]] std::string link() const override {
    return fmt::format("link       {} beats, {} events, {} lines that are no message\n", beats_,
                       events_, bad_);
  }

 private:
  void take_line(std::string_view line) {
    const auto message = kinovazed::decode_message(line);
    if (!message) {
      ++bad_;
    } else if (const auto* const beat = std::get_if<kinovazed::Heartbeat>(&*message)) {
      beat_ = *beat;
      ++beats_;
    } else {
      ++events_;
    }
  }

  std::unique_ptr<Dissector> dissector_ = kinovazed::make_dissector();
  kinovazed::LineSplitter splitter_;
  std::vector<Message> messages_;
  std::optional<kinovazed::Heartbeat> beat_;
  std::uint64_t beats_ = 0;
  std::uint64_t events_ = 0;
  std::uint64_t bad_ = 0;
};

std::unique_ptr<Watched> make_kinovazed(Duration /*period*/) {
  return std::make_unique<WatchedServer>();
}
Outcome<Rig> open_demo(const RigOptions& options) { return open_rig("demo", options); }
Outcome<Rig> open_parol6(const RigOptions& options) { return open_rig("parol6", options); }

std::unique_ptr<Watched> make_demo(Duration /*period*/) { return std::make_unique<WatchedDemo>(); }
std::unique_ptr<Watched> make_parol6(Duration period) {
  return std::make_unique<WatchedBoard>(period);
}

constexpr std::array kWatched{
    WatchedEntry{"demo", 10, make_demo, open_demo},
    WatchedEntry{"kinovazed", 10, make_kinovazed, open_kinova_stream},
    WatchedEntry{"parol6", 100, make_parol6, open_parol6},
};

}  // namespace

std::span<const WatchedEntry> watched_devices() noexcept { return kWatched; }

}  // namespace armjig::cli
