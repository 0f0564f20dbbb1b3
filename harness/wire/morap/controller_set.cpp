// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/controller_set.hpp"

#include <cassert>
#include <cstring>

namespace armjig::morap {
namespace {

constexpr std::size_t kFloatSize = 4;
constexpr std::array kFilters{&ControllerSet::d, &ControllerSet::c, &ControllerSet::f};

/// Writes a filter; what is left of `out`.
std::span<std::byte> put(std::span<std::byte> out, const Coefficients& filter) noexcept {
  assert(filter.count <= kMostCoefficients);
  const std::size_t count = filter.count;
  out[0] = static_cast<std::byte>(count);
  for (std::size_t i = 0; i < count; ++i) {
    store_f32_le(slice<kFloatSize>(out, 1 + kFloatSize * i), filter.values[i]);
  }
  return out.subspan(1 + kFloatSize * count);
}

/// Takes bytes off the front of a set, as long as there are any.
class SetReader {
 public:
  explicit SetReader(Bytes in) noexcept : in_{in} {}

  [[nodiscard]] bool has(std::size_t size) const noexcept { return in_.size() - place_ >= size; }
  [[nodiscard]] std::size_t place() const noexcept { return place_; }

  template <std::size_t Size>
  std::span<const std::byte, Size> take() noexcept {
    place_ += Size;
    return slice<Size>(in_, place_ - Size);
  }
  std::uint8_t take_byte() noexcept { return std::to_integer<std::uint8_t>(take<1>()[0]); }

 private:
  Bytes in_;
  std::size_t place_ = 0;
};

constexpr std::size_t kHeadSize = 3;

}  // namespace

std::size_t wire_size(const ControllerSet& set) noexcept {
  return kSmallestSetSize + kFloatSize * (std::size_t{set.d.count} + set.c.count + set.f.count);
}

/// 256 is 1 modulo 255, so that words fold to what their bytes do, in any order of bytes; and
/// nothing folds to 0 but 0.
std::uint8_t checksum(Bytes payload) noexcept {
  std::uint64_t sum = 0;
  for (; payload.size() >= sizeof(std::uint32_t);
       payload = payload.subspan(sizeof(std::uint32_t))) {
    std::uint32_t word{};
    std::memcpy(&word, payload.data(), sizeof word);
    sum += word;
  }
  for (const auto byte : payload) sum += std::to_integer<std::uint64_t>(byte);
  sum = (sum >> 32) + (sum & 0xFFFFFFFF);
  sum = (sum >> 16) + (sum & 0xFFFF);
  while (sum > 0xFF) sum = (sum >> 8) + (sum & 0xFF);
  return static_cast<std::uint8_t>(~sum);
}

SetBytes encode(const ControllerSet& set) noexcept {
  SetBytes out;
  encode_into(out.extend(wire_size(set)), set);
  return out;
}

void encode_into(std::span<std::byte> out, const ControllerSet& set) noexcept {
  out[0] = static_cast<std::byte>(set.kind);
  store_u16_le(slice<2>(out, 1), set.rate_hz);
  auto rest = out.subspan(kHeadSize);
  for (const auto filter : kFilters) rest = put(rest, set.*filter);
  store_f32_le(slice<kFloatSize>(rest, 0), set.integral);
  out.back() = std::byte{checksum(out.first(out.size() - 1))};
}

std::optional<SetFault> decode_into(ControllerSet& out, Bytes in) noexcept {
  using enum SetFault::Kind;
  const SetFault cut_short{kTooShort, in.size()};
  SetReader reader{in};
  if (!reader.has(kHeadSize)) return cut_short;
  out.kind = ControllerKind{reader.take_byte()};
  out.rate_hz = load_u16_le(reader.take<2>());
  for (const auto member : kFilters) {
    auto& filter = out.*member;
    if (!reader.has(1)) return cut_short;
    const auto count = reader.take_byte();
    filter.count = count;
    if (count > kMostCoefficients) return SetFault{kCountAboveFour, reader.place() - 1};
    if (!reader.has(kFloatSize * count)) return cut_short;
    for (std::size_t i = 0; i < count; ++i) {
      filter.values[i] = load_f32_le(reader.take<kFloatSize>());
    }
  }
  if (!reader.has(kFloatSize + 1)) return cut_short;
  out.integral = load_f32_le(reader.take<kFloatSize>());
  const auto payload = in.first(reader.place());
  if (reader.take_byte() != checksum(payload)) return SetFault{kWrongChecksum, payload.size()};
  return std::nullopt;
}

std::variant<ControllerSet, SetFault> decode_set(Bytes in) noexcept {
  std::variant<ControllerSet, SetFault> result;
  if (const auto fault = decode_into(*std::get_if<ControllerSet>(&result), in)) result = *fault;
  return result;
}

}  // namespace armjig::morap
