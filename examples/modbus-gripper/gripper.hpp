// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/faults/faulty.hpp"
#include "emulators/faults/named_fault.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/core/device_input.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/error.hpp"
#include "harness/core/option.hpp"
#include "rtu.hpp"

namespace gripper {

/// What is wrong with a gripper on purpose, by name.
using Defects = std::set<std::string, std::less<>>;
/// All that there are, by chapter of the suite.
[[nodiscard]] std::span<const armjig::Named<std::string_view>> defects() noexcept;

/// The gripper without its line: takes requests for it or for all and sends replies, both without
/// CRC. A write of several registers takes effect as a whole.
class Gripper : public armjig::Sending<armjig::SentBytes> {
 public:
  static constexpr armjig::Duration kReplyDelay = std::chrono::milliseconds{1};

  explicit Gripper(Defects defects = {}) : defects_{std::move(defects)} {}

  void receive(armjig::Instant time, armjig::Bytes request);
  void advance_to(armjig::Instant time);
  [[nodiscard]] std::optional<armjig::Instant> next_event() const noexcept;
  bool set_input(armjig::Instant time, std::string_view name, std::int64_t value);
  [[nodiscard]] static std::span<const armjig::DeviceInput> inputs() noexcept;

 private:
  /// The jaws go from one width to another at constant speed.
  struct Move {
    unsigned from = kWidest;
    unsigned to = kWidest;
    unsigned speed = 1;
    armjig::Instant start{};
    Status end = Status::kStopped;
  };

  [[nodiscard]] bool has(std::string_view defect) const { return defects_.contains(defect); }
  /// 1 with the defect, to be added to something.
  [[nodiscard]] unsigned one(std::string_view defect) const { return has(defect) ? 1 : 0; }
  [[nodiscard]] Exception act(armjig::Instant time, armjig::Bytes request, Frame& reply);
  [[nodiscard]] Exception read(armjig::Instant time, armjig::Bytes request, Frame& reply) const;
  [[nodiscard]] Exception store(armjig::Instant time, unsigned first, armjig::Bytes words);
  void control(armjig::Instant time);
  [[nodiscard]] unsigned position(armjig::Instant time) const;
  [[nodiscard]] Status status(armjig::Instant time) const;
  [[nodiscard]] unsigned value(unsigned place, armjig::Instant time) const;

  Defects defects_;
  std::array<unsigned, kStatus> settings_{0, kWidest, 500, 20};
  Move move_;
  unsigned object_ = 0;  ///< its width; 0: there is none
  bool is_jammed_ = false;
  std::deque<armjig::SentBytes> due_;
};

/// A gripper on a Modbus line: silence, addresses, CRC; faults are in its replies.
class Unit : public armjig::Sending<armjig::SentBytes> {
 public:
  Unit(std::uint8_t address, unsigned baud, Defects defects = {},
       std::vector<armjig::Fault> faults = {});

  void receive(armjig::Instant time, armjig::Bytes bytes);
  void advance_to(armjig::Instant time);
  [[nodiscard]] std::optional<armjig::Instant> next_event() const;
  bool set_input(armjig::Instant time, std::string_view name, std::int64_t value) {
    return gripper_.set_input(time, name, value);
  }
  [[nodiscard]] static auto inputs() noexcept { return Gripper::inputs(); }

 private:
  [[nodiscard]] bool has(std::string_view defect) const { return defects_.contains(defect); }
  void take(armjig::Instant time, Frame frame);

  armjig::Faulty<Gripper> gripper_;
  std::uint8_t address_;
  Defects defects_;
  Receiver receiver_;
};
static_assert(armjig::EmulatedStream<Unit>);

/// One that options describe. `where` is for problems: `kUnknownOption`, `kBadValue`.
[[nodiscard]] armjig::Outcome<Unit> make(const armjig::DeviceOptions& options,
                                         const std::string& where, unsigned baud);
[[nodiscard]] std::span<const armjig::OptionRow> options() noexcept;

/// A recording driven into a gripper at 19,200 baud. Its times are those of the last character of a
/// request and of the first of a reply.
[[nodiscard]] armjig::Outcome<armjig::Replayed> replay(const armjig::Trace& trace);

}  // namespace gripper
