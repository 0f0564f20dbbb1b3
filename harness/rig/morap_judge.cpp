// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/morap_judge.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap {
namespace {

constexpr std::size_t kCounterRange = 256;  // of the node's byte counter
constexpr std::array kDisable{static_cast<std::byte>(CommandId::kDisable)};

/// What is known of the node at an address.
enum class Drive : std::uint8_t {
  kUnknown,
  kStands,  ///< we disabled it, and nobody sent a reference since
  kMoves,
};

bool is_node(BusAddress address) noexcept {
  return (address.value & 0xF0U) == kNodeBaseAddress;  // a node's identifier is in the lower half
}

bool is_reference(CommandId id) noexcept {
  return id >= CommandId::kPosition && id <= CommandId::kTorque;
}

bool is_calibration(CommandId id) noexcept {
  return id == CommandId::kCalibrateZero || id == CommandId::kCalibrateAngle;
}

bool has_zero_count(const ControllerSet& set) noexcept {
  return set.d.count == 0 || set.c.count == 0 || set.f.count == 0;
}

/// Why no node must ever get the command; empty if it may. `surplus` bytes follow it.
std::string_view danger_of(const Command& command, std::size_t surplus) noexcept {
  if (const auto* value = std::get_if<float>(&command.payload)) {
    if (surplus > 0) return "bytes behind a number overwrite the node's memory";
    if (!std::isfinite(*value))
      return "what a node does with a number that is not finite, nobody knows";
  }
  if (const auto* set = std::get_if<ControllerSet>(&command.payload)) {
    if (has_zero_count(*set)) return "a filter without coefficients shifts the node's memory";
    if (set->rate_hz == 0) return "a rate of 0 makes the node divide by zero";
  }
  if (const auto* request = std::get_if<TuneRequest>(&command.payload)) {
    if (!(std::fabs(request->inertia) > 0.0F)) return "without inertia the tuner divides by zero";
  }
  return {};
}

class NodeJudge final : public BusJudge {
 public:
  std::optional<Refusal> judge(const BusMessage& message, const Permissions& permissions) override {
    if (message.address.value == pen::kAddress) return judge_pen(message, permissions);
    if (message.access == Access::kRead || message.write.empty()) return std::nullopt;
    if (!is_node(message.address)) return demand(Hazard::kState, permissions, "an unknown device");
    return judge_write(message, permissions);
  }

  std::vector<BusAddress> moving() const override {
    std::vector<BusAddress> addresses;
    for (std::uint8_t address = 0; address < drives_.size(); ++address) {
      if (drives_[address] == Drive::kMoves) addresses.push_back({address});
    }
    return addresses;
  }

  Bytes stop_bytes() const override { return kDisable; }

 private:
  static std::optional<Refusal> demand(Hazard hazard, const Permissions& permissions,
                                       std::string_view what) {
    if (permissions.allow(hazard)) return std::nullopt;
    return Refusal{hazard, std::string{what} + " needs --allow " + std::string{to_string(hazard)}};
  }

  static std::optional<Refusal> judge_pen(const BusMessage& message,
                                          const Permissions& permissions) {
    if (message.access == Access::kRead) {
      return Refusal{Hazard::kGrip, "a pen has nothing to read, and may hang"};
    }
    if (message.write.empty()) return std::nullopt;
    const bool has_position =
        message.write[0] == static_cast<std::byte>(pen::CommandId::kSetPosition);
    if (message.write.size() > (has_position ? 2U : 1U)) {
      return Refusal{Hazard::kGrip, "bytes behind a command hang the pen"};
    }
    return demand(Hazard::kGrip, permissions, "the pen");
  }

  std::optional<Refusal> judge_write(const BusMessage& message, const Permissions& permissions) {
    const auto data = message.write;
    if (data.size() >= kCounterRange) {
      return Refusal{Hazard::kMove, "byte 256 of a write would be a new command"};
    }
    const auto decoded = decode_command(data);
    const auto* found = std::get_if<DecodedCommand>(&decoded);
    if (found == nullptr) return judge_incomplete(data, permissions);
    const auto& [command, size] = *found;
    if (const auto danger = danger_of(command, data.size() - size); !danger.empty()) {
      return Refusal{Hazard::kMove, std::string{danger}};
    }
    auto& drive = drives_[message.address.value & 0x7FU];
    if (auto refusal = judge_command(command.id, drive, permissions)) return refusal;
    if (is_reference(command.id)) drive = Drive::kMoves;
    if (is_calibration(command.id) && drive == Drive::kUnknown) drive = Drive::kMoves;
    if (command.id == CommandId::kDisable || command.id == CommandId::kCalibrationUnknown) {
      drive = Drive::kStands;
    }
    return std::nullopt;
  }

  /// Cut short or unknown, it does nothing. A set that is refused changes the programming status.
  static std::optional<Refusal> judge_incomplete(Bytes data, const Permissions& permissions) {
    const bool is_set = !data.empty() && data[0] == static_cast<std::byte>(CommandId::kProgram);
    return is_set ? demand(Hazard::kState, permissions, "programming") : std::nullopt;
  }

  static std::optional<Refusal> judge_command(CommandId id, Drive drive,
                                              const Permissions& permissions) {
    if (is_reference(id)) return demand(Hazard::kMove, permissions, "a reference");
    const bool changes_loop = is_calibration(id) || id == CommandId::kProgram ||
                              id == CommandId::kDefaultControllers || id == CommandId::kTune;
    if (!changes_loop) return std::nullopt;
    if (drive == Drive::kStands) return demand(Hazard::kState, permissions, find_command(id)->name);
    return demand(Hazard::kMove, permissions,
                  std::string{find_command(id)->name} +
                      " of a node that may follow a reference (disable it first, or it)");
  }

  std::array<Drive, 128> drives_{};
};

}  // namespace

std::unique_ptr<BusJudge> make_judge() { return std::make_unique<NodeJudge>(); }

}  // namespace armjig::morap
