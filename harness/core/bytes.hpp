// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace armjig {

using Bytes = std::span<const std::byte>;

/// The same bytes as characters, whatever they are.
[[nodiscard]] inline std::string_view as_text(Bytes bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Reads a signed 24-bit big-endian field.
[[nodiscard]] constexpr std::int32_t load_i24_be(std::span<const std::byte, 3> in) noexcept {
  const auto raw = std::to_integer<std::uint32_t>(in[0]) << 24 |
                   std::to_integer<std::uint32_t>(in[1]) << 16 |
                   std::to_integer<std::uint32_t>(in[2]) << 8;
  return static_cast<std::int32_t>(raw) >> 8;  // C++20: right shift copies the sign
}

/// Writes the low 24 bits of `value`, most significant byte first.
constexpr void store_i24_be(std::span<std::byte, 3> out, std::int32_t value) noexcept {
  const auto raw = static_cast<std::uint32_t>(value);
  out[0] = static_cast<std::byte>(raw >> 16);
  out[1] = static_cast<std::byte>(raw >> 8);
  out[2] = static_cast<std::byte>(raw);
}

/// Reads an unsigned 16-bit big-endian field.
[[nodiscard]] constexpr std::uint16_t load_u16_be(std::span<const std::byte, 2> in) noexcept {
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(in[0]) << 8 |
                                    std::to_integer<unsigned>(in[1]));
}

/// Reads a signed 16-bit big-endian field.
[[nodiscard]] constexpr std::int16_t load_i16_be(std::span<const std::byte, 2> in) noexcept {
  return static_cast<std::int16_t>(load_u16_be(in));
}

/// Writes 16 bits, most significant byte first; a signed value keeps its two's complement.
constexpr void store_u16_be(std::span<std::byte, 2> out, std::uint16_t value) noexcept {
  out[0] = static_cast<std::byte>(value >> 8);
  out[1] = static_cast<std::byte>(value);
}

constexpr void store_i16_be(std::span<std::byte, 2> out, std::int16_t value) noexcept {
  store_u16_be(out, static_cast<std::uint16_t>(value));
}

/// Reads an unsigned 16-bit little-endian field.
[[nodiscard]] constexpr std::uint16_t load_u16_le(std::span<const std::byte, 2> in) noexcept {
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(in[1]) << 8 |
                                    std::to_integer<unsigned>(in[0]));
}

/// Writes 16 bits, least significant byte first.
constexpr void store_u16_le(std::span<std::byte, 2> out, std::uint16_t value) noexcept {
  out[0] = static_cast<std::byte>(value);
  out[1] = static_cast<std::byte>(value >> 8);
}

/// Reads a single-precision number, least significant byte first. Every bit survives, those of a
/// NaN too.
[[nodiscard]] constexpr float load_f32_le(std::span<const std::byte, 4> in) noexcept {
  // Written out, so that compilers see that it is one move.
  return std::bit_cast<float>(
      std::to_integer<std::uint32_t>(in[0]) | std::to_integer<std::uint32_t>(in[1]) << 8 |
      std::to_integer<std::uint32_t>(in[2]) << 16 | std::to_integer<std::uint32_t>(in[3]) << 24);
}

/// Writes the bits of a single-precision number, least significant byte first.
constexpr void store_f32_le(std::span<std::byte, 4> out, float value) noexcept {
  auto bits = std::bit_cast<std::uint32_t>(value);
  for (auto& byte : out) {
    byte = static_cast<std::byte>(bits);
    bits >>= 8;
  }
}

/// Up to `Capacity` bytes without heap.
template <std::size_t Capacity>
class BoundedBytes {
 public:
  constexpr BoundedBytes() noexcept = default;

  /// The next `size` bytes, to be written. Requires room for them.
  [[nodiscard]] constexpr std::span<std::byte> extend(std::size_t size) noexcept {
    assert(size <= Capacity - size_);
    size_ += size;
    return std::span{bytes_}.subspan(size_ - size, size);
  }
  template <std::size_t Size>
  [[nodiscard]] constexpr std::span<std::byte, Size> extend() noexcept {
    return extend(Size).template first<Size>();
  }
  constexpr void push_back(std::byte byte) noexcept { extend(1)[0] = byte; }

  [[nodiscard]] static constexpr std::size_t capacity() noexcept { return Capacity; }
  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr Bytes view() const noexcept { return Bytes{bytes_}.first(size_); }
  constexpr operator Bytes() const noexcept { return view(); }  // NOLINT(*-explicit-*): it is one

 private:
  std::array<std::byte, Capacity> bytes_{};
  std::size_t size_ = 0;
};

/// The `Size` bytes of `in` from `offset` on. Requires `offset + Size <= in.size()`.
template <std::size_t Size>
[[nodiscard]] constexpr auto slice(std::span<const std::byte> in, std::size_t offset) noexcept {
  return in.subspan(offset).template first<Size>();
}

template <std::size_t Size>
[[nodiscard]] constexpr auto slice(std::span<std::byte> in, std::size_t offset) noexcept {
  return in.subspan(offset).template first<Size>();
}

}  // namespace armjig
