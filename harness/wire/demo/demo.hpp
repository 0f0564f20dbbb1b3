// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "harness/core/bytes.hpp"
#include "harness/wire/dissection.hpp"
#include "harness/wire/dissector.hpp"
#include "harness/wire/field.hpp"

/// A device that nobody built: the smallest that goes through every room, and the worked example of
/// docs/adding-a-device.md. It starts and halts. A request is `A5 op ~op`, its reply `5A state
/// ~state`; a request that is damaged gets no reply.
namespace armjig::demo {

enum class Operation : std::uint8_t { kQuery = 'q', kStart = 's', kHalt = 'h' };
enum class State : std::uint8_t { kReady = 0, kRunning = 1, kHalted = 2, kUnknownOperation = 0xEE };

inline constexpr std::size_t kMessageSize = 3;
inline constexpr std::byte kRequestStart{0xA5};
inline constexpr std::byte kReplyStart{0x5A};

using MessageBytes = std::array<std::byte, kMessageSize>;

[[nodiscard]] MessageBytes encode(Operation operation) noexcept;
[[nodiscard]] MessageBytes encode(State state) noexcept;

/// Finds messages that begin with `start` in a byte stream; a damaged one costs its first byte.
class Splitter {
 public:
  explicit Splitter(std::byte start) noexcept : start_{start} {}

  /// Takes one byte. The second byte of a message if it ended one.
  std::optional<std::byte> step(std::byte byte) noexcept;

 private:
  void drop_until_start() noexcept;

  std::byte start_;
  MessageBytes held_{};
  std::size_t size_ = 0;
};

[[nodiscard]] std::span<const Field> request_fields() noexcept;
[[nodiscard]] std::span<const Field> reply_fields() noexcept;

[[nodiscard]] std::unique_ptr<Dissector> make_dissector();

[[nodiscard]] Dissection dissection();

}  // namespace armjig::demo
