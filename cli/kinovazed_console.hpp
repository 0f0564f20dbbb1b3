// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_table.hpp"
#include "cli/device_console.hpp"
#include "harness/drive/kinovazed/client.hpp"
#include "harness/rig/server_rig.hpp"

namespace armjig::cli {

/// The commands of `armjig console kinovazed`.
class KinovaConsole final : public DeviceConsole {
 public:
  /// `target` is for messages.
  KinovaConsole(ServerRig rig, std::string target, const kinovazed::DriveOptions& options, Say say);

  [[nodiscard]] Outcome<void> cycle() override;
  void begin(std::string_view line) override;
  [[nodiscard]] bool is_busy() const noexcept override {
    return asked_ || wait_until_ || (steering_ && steering_->until);
  }
  [[nodiscard]] bool wants_to_quit() const noexcept override { return wants_to_quit_; }
  /// Lets the stick go; ends an objective by a change of mode, any other motion by an EStop.
  void stop() override;
  [[nodiscard]] std::string occupation() override;
  [[nodiscard]] std::vector<std::string> candidates(std::string_view line) const override {
    return candidates_in(rows(), line);
  }
  [[nodiscard]] Instant now() override { return rig_.port().now(); }
  [[nodiscard]] bool hears_the_device() const noexcept override {
    return client_.drive().heartbeat().has_value();
  }
  [[nodiscard]] Duration hears_within() const noexcept override {
    return kinovazed::patience::kBeat;
  }
  [[nodiscard]] std::string_view silence() const noexcept override {
    return "no beat came: is it a KinovaZED server, and serves it nobody else?";
  }

 private:
  using Row = CommandRow<KinovaConsole>;
  [[nodiscard]] static std::span<const Row> rows() noexcept;

  Read help(Words words);
  Read status(Words words);
  template <kinovazed::Verb verb>
  Read plain(Words words);
  Read mode(Words words);
  Read move(Words words);
  template <kinovazed::Verb verb>
  Read objective(Words words);
  Read position(Words words);
  Read stop_arm(Words words);
  Read wait(Words words);
  Read quit(Words words);

  /// What was asked for and has not ended.
  struct Asked {
    kinovazed::RequestId id{};
    std::string name;
    Instant since{};
  };
  /// A deflected stick, which has to be renewed.
  struct Steering {
    kinovazed::Deflection deflection;
    Instant renew{};
    std::optional<Duration> time;  ///< once it has begun
    std::optional<Instant> until;  ///< none: until something else is said
  };

  void ask(std::string_view name, const kinovazed::Command& command);
  void follow(std::string_view name, const Result<kinovazed::RequestId>& id);
  void renew_stick();
  void take(const kinovazed::DriveEvent& event);
  void take_ending(const kinovazed::DriveEvent& event);

  ServerRig rig_;
  std::string target_;
  Say say_;
  kinovazed::Client client_;
  std::optional<Asked> asked_;
  std::optional<Steering> steering_;
  std::optional<Instant> wait_until_;
  bool wants_to_quit_ = false;
};

/// Opens the target.
[[nodiscard]] Outcome<std::unique_ptr<DeviceConsole>> open_kinova_console(const RigOptions& how,
                                                                          const std::string& target,
                                                                          Say say);

}  // namespace armjig::cli
