// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "harness/core/bytes.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {

/// What a strict receiver demands of the check byte.
enum class CheckPolicy : std::uint8_t { kIgnore, kBoardOnly, kBoardOrHost };

[[nodiscard]] constexpr bool allows(CheckPolicy policy, std::uint8_t check) noexcept {
  return policy == CheckPolicy::kIgnore || check == kCheckBoard ||
         (policy == CheckPolicy::kBoardOrHost && check == kCheckHost);
}

/// The strict receiver: cuts a byte stream into frames of one length and finds its way back after
/// any damage. A wrong frame costs one byte, then the search for `FF FF FF LEN` goes on right
/// behind it, so no good frame that follows garbage is lost. Cutting the stream differently never
/// changes what is found. Memory is fixed; nothing allocates or throws.
class Splitter {
 public:
  enum class FaultKind : std::uint8_t {
    kWrongLength,  ///< three start bytes, then a length that is not ours
    kWrongCheck,
    kWrongEnd,
  };
  /// A candidate that was not a frame.
  struct Fault {
    FaultKind kind{};
    std::uint8_t value{};  ///< the length, check or first wrong end byte that came
  };
  /// A whole frame, header to end bytes. Valid until the next `step` and as long as its input.
  struct Frame {
    Bytes bytes;
  };
  struct Step {
    std::size_t used{};  ///< bytes of `in` now spoken for; 0 only if `in` is empty
    std::variant<std::monostate, Frame, Fault> found;  ///< monostate: needs more bytes
  };

  /// For frames with that payload length, at most `kTelemetryPayloadSize`.
  constexpr explicit Splitter(std::size_t payload_size,
                              CheckPolicy check = CheckPolicy::kIgnore) noexcept
      : frame_size_{kHeaderSize + payload_size}, check_{check} {}

  /// Reads up to the end of the first frame or fault.
  [[nodiscard]] Step step(Bytes in) noexcept;

  /// Bytes at the end of the stream so far that may still become part of a frame.
  [[nodiscard]] std::size_t held() const noexcept { return held_; }

 private:
  [[nodiscard]] Step step_held(Bytes in) noexcept;
  [[nodiscard]] Step step_direct(Bytes in) noexcept;
  void hold(Bytes rest) noexcept;
  [[nodiscard]] std::byte length_byte() const noexcept;
  [[nodiscard]] std::variant<std::monostate, Frame, Fault> judge(Bytes candidate) const noexcept;
  [[nodiscard]] std::size_t next_candidate(Bytes rejected) const noexcept;

  std::size_t frame_size_;
  CheckPolicy check_;
  std::size_t held_ = 0;
  std::array<std::byte, kTelemetryFrameSize> buffer_{};
};

/// What a splitter of telemetry found, if it is a frame.
[[nodiscard]] inline std::optional<TelemetryFrame> telemetry_of(
    const Splitter::Step& step) noexcept {
  const auto* const found = std::get_if<Splitter::Frame>(&step.found);
  if (found == nullptr) return std::nullopt;
  return decode_telemetry(body_of(found->bytes.first<kTelemetryFrameSize>()));
}

}  // namespace armjig::parol6
