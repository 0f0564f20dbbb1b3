// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/morap_judge.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/link/bus_port.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::rig {
namespace {

constexpr std::size_t kCounterRange = 256;  // of the node's byte counter
constexpr std::size_t kAddresses = 128;

/// What disables the node at each address.
constexpr auto kStops = [] {
  std::array<std::array<std::byte, 2>, kAddresses> stops{};
  for (std::size_t address = 0; address < kAddresses; ++address) {
    stops[address] = {static_cast<std::byte>(address << 1U),
                      static_cast<std::byte>(CommandId::kDisable)};
  }
  return stops;
}();

/// What is known of the node at an address.
enum class Drive : std::uint8_t {
  kUnknown,
  kStands,  ///< we disabled it, and nobody sent a reference since
  kMoves,
};

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

using Drives = std::array<Drive, kAddresses>;

/// What a message means for the node that has all of it.
void follow(Drives& drives, const BusMessage& message) noexcept {
  if (message.access == Access::kRead || message.write.empty()) return;
  if (!is_node_address(message.address.value)) return;
  const auto decoded = decode_command(message.write);
  const auto* found = std::get_if<DecodedCommand>(&decoded);
  if (found == nullptr) return;
  const auto id = found->command.id;
  auto& drive = drives[message.address.value];
  if (is_reference(id)) drive = Drive::kMoves;
  if (is_calibration(id) && drive == Drive::kUnknown) drive = Drive::kMoves;
  if (id == CommandId::kDisable || id == CommandId::kCalibrationUnknown) drive = Drive::kStands;
}

/// Of a transaction's bytes. Requires a message that is not empty.
BusMessage message_of(Bytes bytes) noexcept {
  const auto head = std::to_integer<std::uint8_t>(bytes[0]);
  const BusAddress address{static_cast<std::uint8_t>(head >> 1U)};
  return {address, (head & 1U) != 0 ? Access::kRead : Access::kWrite, bytes.subspan(1), {}};
}

class NodeJudge final : public Judge {
 public:
  NodeJudge() { stop_.reserve(kAddresses); }

  std::optional<Refusal> judge(Messages messages, const Permissions& permissions) override {
    auto drives = drives_;
    auto worst = drives_;
    for (const auto bytes : messages) {
      const auto message = message_of(bytes);
      if (auto refusal = judge_message(message, drives, permissions)) return refusal;
      follow(drives, message);
      const auto address = message.address.value;
      if (drives[address] == Drive::kMoves) worst[address] = Drive::kMoves;
    }
    drives_ = worst;
    renew_stop();
    return std::nullopt;
  }

  /// What ends motion counts when the node has it.
  void observe(Bytes bytes) override {
    follow(drives_, message_of(bytes));
    renew_stop();
  }

  [[nodiscard]] bool may_be_moving() const override { return !stop_.empty(); }
  [[nodiscard]] Messages stop() const override { return stop_; }

 private:
  void renew_stop() {
    stop_.clear();
    for (std::size_t address = 0; address < kAddresses; ++address) {
      if (drives_[address] == Drive::kMoves) stop_.emplace_back(kStops[address]);
    }
  }

  static std::optional<Refusal> judge_message(const BusMessage& message, const Drives& drives,
                                              const Permissions& permissions) {
    if (message.address.value == pen::kAddress) return judge_pen(message, permissions);
    if (message.access == Access::kRead || message.write.empty()) return std::nullopt;
    if (!is_node_address(message.address.value))
      return demand(Hazard::kState, permissions, "an unknown device");
    return judge_write(message.write, drives[message.address.value], permissions);
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

  static std::optional<Refusal> judge_write(Bytes data, Drive drive,
                                            const Permissions& permissions) {
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
    return judge_command(command.id, drive, permissions);
  }

  /// Cut short or unknown, it does nothing. A set that is refused changes the programming status.
  static std::optional<Refusal> judge_incomplete(Bytes data, const Permissions& permissions) {
    const bool is_set = !data.empty() && data[0] == static_cast<std::byte>(CommandId::kProgram);
    return is_set ? demand(Hazard::kProgram, permissions, "programming") : std::nullopt;
  }

  static std::optional<Refusal> judge_command(CommandId id, Drive drive,
                                              const Permissions& permissions) {
    if (is_reference(id)) return demand(Hazard::kMove, permissions, "a reference");
    if (!is_calibration(id) && !is_programming(id)) return std::nullopt;
    if (drive == Drive::kStands) {
      const auto hazard = is_calibration(id) ? Hazard::kState : Hazard::kProgram;
      return demand(hazard, permissions, find_command(id)->name);
    }
    return demand(Hazard::kMove, permissions,
                  std::string{find_command(id)->name} +
                      " of a node that may follow a reference (disable it first, or it)");
  }

  Drives drives_{};
  std::vector<Bytes> stop_;
};

}  // namespace

std::unique_ptr<Judge> make_judge() { return std::make_unique<NodeJudge>(); }

}  // namespace armjig::morap::rig
