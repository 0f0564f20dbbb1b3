// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/controller_set.hpp"

#include <cassert>
#include <numeric>

namespace armjig::morap {
namespace {

constexpr std::size_t kFloatSize = 4;
constexpr std::array kFilters{&ControllerSet::d, &ControllerSet::c, &ControllerSet::f};

void append(SetBytes& out, const Coefficients& filter) noexcept {
  assert(filter.count <= kMostCoefficients);
  out.push_back(std::byte{filter.count});
  for (std::size_t i = 0; i < filter.count; ++i) {
    store_f32_le(out.extend<kFloatSize>(), filter.values[i]);
  }
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
  std::size_t size = kSmallestSetSize;
  for (const auto filter : kFilters) size += kFloatSize * (set.*filter).count;
  return size;
}

std::uint8_t checksum(Bytes payload) noexcept {
  auto sum = std::accumulate(payload.begin(), payload.end(), 0U, [](unsigned total, std::byte b) {
    return total + std::to_integer<unsigned>(b);
  });
  while (sum > 0xFF) sum = (sum >> 8) + (sum & 0xFF);
  return static_cast<std::uint8_t>(~sum);
}

SetBytes encode(const ControllerSet& set) noexcept {
  SetBytes out;
  out.push_back(static_cast<std::byte>(set.kind));
  store_u16_le(out.extend<2>(), set.rate_hz);
  for (const auto filter : kFilters) append(out, set.*filter);
  store_f32_le(out.extend<kFloatSize>(), set.integral);
  out.push_back(std::byte{checksum(out)});
  return out;
}

std::variant<ControllerSet, SetFault> decode_set(Bytes in) noexcept {
  using enum SetFault::Kind;
  const SetFault cut_short{kTooShort, in.size()};
  SetReader reader{in};
  ControllerSet set;
  if (!reader.has(kHeadSize)) return cut_short;
  set.kind = ControllerKind{reader.take_byte()};
  set.rate_hz = load_u16_le(reader.take<2>());
  for (const auto member : kFilters) {
    auto& filter = set.*member;
    if (!reader.has(1)) return cut_short;
    filter.count = reader.take_byte();
    if (filter.count > kMostCoefficients) return SetFault{kCountAboveFour, reader.place() - 1};
    if (!reader.has(kFloatSize * filter.count)) return cut_short;
    for (std::size_t i = 0; i < filter.count; ++i) {
      filter.values[i] = load_f32_le(reader.take<kFloatSize>());
    }
  }
  if (!reader.has(kFloatSize + 1)) return cut_short;
  set.integral = load_f32_le(reader.take<kFloatSize>());
  const auto payload = in.first(reader.place());
  if (reader.take_byte() != checksum(payload)) return SetFault{kWrongChecksum, payload.size()};
  return set;
}

}  // namespace armjig::morap
