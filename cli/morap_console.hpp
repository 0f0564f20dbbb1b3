// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/device_console.hpp"
#include "harness/drive/morap/joint.hpp"
#include "harness/rig/bus_rig.hpp"

namespace armjig::cli {

/// The commands of `armjig console morap`. All but `wait` are done at once. They are for one node,
/// which `node` changes.
class MorapConsole final : public DeviceConsole {
 public:
  MorapConsole(BusRig rig, Say say);

  [[nodiscard]] Outcome<void> cycle() override;
  void begin(std::string_view line) override;
  [[nodiscard]] bool is_busy() const noexcept override { return master_.now() < waits_until_; }
  [[nodiscard]] bool wants_to_quit() const noexcept override { return wants_to_quit_; }
  /// Disables every node that was told to move, and ends a `wait`.
  void stop() override;
  /// The node that commands are for.
  [[nodiscard]] std::string occupation() override;
  [[nodiscard]] std::vector<std::string> candidates(std::string_view line) const override;
  [[nodiscard]] Instant now() override { return master_.now(); }

  // A bus is there as soon as it is open; nodes are heard when they are asked.
  [[nodiscard]] bool hears_the_device() const noexcept override { return true; }
  [[nodiscard]] Duration hears_within() const noexcept override { return {}; }
  [[nodiscard]] std::string_view silence() const noexcept override { return {}; }

 private:
  using Words = std::vector<std::string>;
  struct Command;
  static const std::vector<Command>& commands();

  void do_reference(const Words& words);
  void do_program(const Words& words);
  void do_pen(const Words& words);
  void tell(morap::BusCode code, std::string_view done);
  void tell(const morap::ProgramResult& result);
  bool number(const std::string& word, float& value);

  BusRig rig_;
  Say say_;
  morap::Master master_;
  morap::Joint joint_;
  std::vector<BusAddress> moved_;
  Instant waits_until_{};
  bool wants_to_quit_ = false;
};

/// The console's entry.
[[nodiscard]] Outcome<std::unique_ptr<DeviceConsole>> open_morap_console(const RigOptions& how,
                                                                         const std::string& target,
                                                                         Say say);

}  // namespace armjig::cli
