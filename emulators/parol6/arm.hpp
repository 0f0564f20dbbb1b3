// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/parol6/board.hpp"
#include "emulators/parol6/gripper.hpp"
#include "emulators/parol6/plant.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/device_input.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/time.hpp"

namespace armjig::parol6::emulation {

struct ArmOptions {
  Plant plant = standard_plant();
  BoardTiming timing{};
  BoardProfile profile = kFirmwareBoard;
  BoardFigures figures{};
  std::optional<GripperOptions> gripper = GripperOptions{};  ///< none: nothing is on the CAN
};

/// All that `Arm::set_input` knows; `N` is the number of a joint, 1 to 6.
[[nodiscard]] std::span<const DeviceInput> arm_inputs() noexcept;

/// A PAROL6 as a host sees it: the control board on its serial link, with or without a gripper on
/// the board's CAN. A regular value: a copy is a snapshot.
class Arm : public Sending<SentBytes> {
 public:
  explicit Arm(const ArmOptions& options = {});

  /// Bytes that become readable at `time`. Times of all inputs and of `advance_to` must not
  /// decrease.
  void receive(Instant time, Bytes bytes);

  /// Does everything up to and including `time`.
  void advance_to(Instant time);

  /// When telemetry may be sent if nothing more comes. The gripper's answers cause none.
  [[nodiscard]] std::optional<Instant> next_event() const noexcept { return board_.next_event(); }

  /// Changes the surroundings at `time`: presses the stop, toggles an input, moves an axis by hand.
  /// `change` gets a `Plant&`.
  template <class Change>
  void touch(Instant time, Change change) {
    advance_before(time);
    board_.touch(time, std::move(change));
  }
  /// The same for what the fingers meet. Without a gripper nothing happens.
  void touch_gripper(Instant time, const GripperPlant& plant);

  /// A frame of somebody else on the CAN. The gripper does not listen to it.
  void receive_can(Instant time, const CanFrame& frame);

  /// What a person beside the arm can do, by `arm_inputs`. False: there is no such thing, or it
  /// does not take that value.
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value);

  /// Power off and on for board and gripper; axes and fingers stay where they are.
  void reboot(Instant time);

  [[nodiscard]] const Board& board() const noexcept { return board_; }
  [[nodiscard]] const std::optional<Gripper>& gripper() const noexcept { return gripper_; }

 private:
  void advance_before(Instant time);
  void take_emissions();

  Board board_;
  std::optional<Gripper> gripper_;
  std::uint64_t can_data_{};  ///< as the input `can.data` has it
};

static_assert(EmulatedStream<Arm>);

}  // namespace armjig::parol6::emulation
