// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/faults/fault.hpp"
#include "harness/core/emulation.hpp"

namespace armjig {

/// A device on a stream with defects in what it sends. Needs a device that sends whole messages.
template <EmulatedStream Device>
class Faulty : public Sending<SentBytes>, public InputsOf<Device> {
 public:
  /// `message_size`: of what the device receives.
  Faulty(Device device, std::vector<Fault> faults, std::size_t message_size)
      : device_{std::move(device)},
        faults_{std::move(faults)},
        memories_(faults_.size()),
        message_size_{message_size} {}

  void receive(Instant time, Bytes bytes) {
    const auto kept = has(Fault::Kind::kLosesSplits) ? bytes.size() / message_size_ * message_size_
                                                     : bytes.size();
    device_.receive(time, bytes.first(kept));
    take_sent();
    release(time);
  }
  void advance_to(Instant time) {
    device_.advance_to(time);
    take_sent();
    release(time);
  }
  [[nodiscard]] std::optional<Instant> next_event() const {
    auto next = device_.next_event();
    for (const auto& message : held_) {
      if (!next || message.time < *next) next = message.time;
    }
    return next;
  }

  bool set_input(Instant time, std::string_view input, std::int64_t value)
    requires requires(Device device) { device.set_input(time, input, value); }
  {
    return device_.set_input(time, input, value);
  }

 private:
  static constexpr int kOneIn = 10;
  static constexpr Duration kLateness = std::chrono::milliseconds{20};
  static constexpr Duration kRepeatAfter = std::chrono::milliseconds{100};

  [[nodiscard]] bool has(Fault::Kind kind) const noexcept {
    return std::ranges::find(faults_, kind, &Fault::kind) != faults_.end();
  }

  void take_sent() {
    for (auto message : device_.sent()) {
      for (std::size_t i = 0; i < faults_.size(); ++i) {
        apply_fault(faults_[i], message.bytes, memories_[i]);
      }
      hold(std::move(message));
    }
    device_.clear_sent();
  }

  /// Applies the faults of messages.
  void hold(SentBytes message) {
    const bool is_chosen = ++messages_ % kOneIn == 0;
    if (is_chosen && has(Fault::Kind::kMissing)) return;
    if (is_chosen && has(Fault::Kind::kCutShort)) message.bytes.pop_back();
    if (has(Fault::Kind::kLate)) message.time += kLateness;
    held_.push_back(message);
    if (is_chosen && has(Fault::Kind::kTwice)) held_.push_back(message);
    if (!is_chosen || !has(Fault::Kind::kUnasked)) return;
    message.time += kRepeatAfter;
    held_.push_back(std::move(message));
  }

  /// Lets go what is due.
  void release(Instant time) {
    const auto is_due = [time](const SentBytes& message) { return message.time <= time; };
    std::ranges::copy_if(held_, std::back_inserter(sent_), is_due);
    std::erase_if(held_, is_due);
  }

  Device device_;
  std::vector<Fault> faults_;
  std::vector<std::optional<std::int64_t>> memories_;  ///< one for each fault
  std::size_t message_size_;
  int messages_ = 0;
  std::vector<SentBytes> held_;  ///< not sent yet
};

}  // namespace armjig
