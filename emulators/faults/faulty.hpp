// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/emulation.hpp"
#include "harness/core/error.hpp"
#include "harness/wire/field.hpp"

namespace armjig {

/// A defect that a real board could have, put on an emulated one to see it found.
struct Fault {
  enum class Kind : std::uint8_t {
    kZero,         ///< the field is always 0
    kStuck,        ///< the field keeps its first value
    kOffByOne,     ///< the field is one too high
    kSwapBytes,    ///< the field has its least significant byte first
    kReverseBits,  ///< each byte of the field has its bit order turned round
    kLosesSplits,  ///< a message that does not arrive in one piece is lost
  };
  Kind kind{};
  const Field* field{};  ///< none for `kLosesSplits`
};

/// Reads `KIND:FIELD` or `KIND`, for example `swap-bytes:speed.j1` or `loses-splits`. Fields are
/// those of what the device sends.
[[nodiscard]] Outcome<Fault> parse_fault(std::string_view text, std::span<const Field> fields);

/// The forms that `parse_fault` takes, for help texts.
[[nodiscard]] std::string fault_forms();

/// Changes one message as the fault demands. `first` remembers what `kStuck` needs.
void apply_fault(const Fault& fault, std::span<std::byte> message,
                 std::optional<std::int64_t>& first) noexcept;

/// A device on a stream with defects. Needs a device that sends whole messages.
template <EmulatedStream Device>
class Faulty {
 public:
  Faulty(Device device, std::vector<Fault> faults, std::size_t message_size)
      : device_{std::move(device)},
        faults_{std::move(faults)},
        firsts_(faults_.size()),
        message_size_{message_size} {}

  void receive(Instant time, Bytes bytes) {
    const bool loses_splits = std::ranges::any_of(
        faults_, [](const Fault& fault) { return fault.kind == Fault::Kind::kLosesSplits; });
    const auto kept = loses_splits ? bytes.size() / message_size_ * message_size_ : bytes.size();
    device_.receive(time, bytes.first(kept));
    take_sent();
  }
  void advance_to(Instant time) {
    device_.advance_to(time);
    take_sent();
  }
  [[nodiscard]] std::optional<Instant> next_event() const { return device_.next_event(); }
  [[nodiscard]] std::span<const SentBytes> sent() const noexcept { return sent_; }
  void clear_sent() noexcept { sent_.clear(); }

  bool set_input(Instant time, std::string_view input, std::int64_t value)
    requires requires(Device device) { device.set_input(time, input, value); }
  {
    return device_.set_input(time, input, value);
  }

 private:
  void take_sent() {
    for (auto message : device_.sent()) {
      for (std::size_t i = 0; i < faults_.size(); ++i) {
        apply_fault(faults_[i], message.bytes, firsts_[i]);
      }
      sent_.push_back(std::move(message));
    }
    device_.clear_sent();
  }

  Device device_;
  std::vector<Fault> faults_;
  std::vector<std::optional<std::int64_t>> firsts_;
  std::size_t message_size_;  ///< of what the device receives
  std::vector<SentBytes> sent_;
};

}  // namespace armjig
