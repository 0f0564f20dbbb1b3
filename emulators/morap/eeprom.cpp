// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/eeprom.hpp"

#include <algorithm>

#include "harness/core/bytes.hpp"

namespace armjig::morap::emulation {
namespace {

// Places in bytes; a word has two. Filters are padded to full length and even places.
constexpr std::size_t kNodePlace = 2;
constexpr std::size_t kMarkerPlace = 4;
constexpr std::size_t kMotorPlace = 6;
constexpr std::size_t kPositionPlace = 40;
constexpr std::size_t kSpeedPlace = 104;
constexpr std::size_t kRatePlace = 2;
constexpr std::size_t kIntegralPlace = 58;
constexpr std::size_t kStoredSetSize = 62;

constexpr std::array kMotorFloats{
    &MotorConstants::resistance,      &MotorConstants::inductance,
    &MotorConstants::torque_constant, &MotorConstants::gear_ratio,
    &MotorConstants::friction,        &MotorConstants::efficiency,
    &MotorConstants::rated_current,   &MotorConstants::pulses_per_turn};

struct FilterPlace {
  Coefficients ControllerSet::* filter;
  std::size_t place;
};
constexpr std::array kPlaces{FilterPlace{&ControllerSet::d, 4}, FilterPlace{&ControllerSet::c, 22},
                             FilterPlace{&ControllerSet::f, 40}};

ControllerSet decode_stored_set(Bytes in) noexcept {
  ControllerSet set;
  set.kind = ControllerKind{std::to_integer<std::uint8_t>(in[0])};
  set.rate_hz = load_u16_le(slice<2>(in, kRatePlace));
  for (const auto& [member, place] : kPlaces) {
    auto& filter = set.*member;
    filter.count =
        std::min<std::uint8_t>(std::to_integer<std::uint8_t>(in[place]), kMostCoefficients);
    for (std::size_t i = 0; i < kMostCoefficients; ++i) {
      filter.values[i] = load_f32_le(slice<4>(in, place + 2 + 4 * i));
    }
  }
  set.integral = load_f32_le(slice<4>(in, kIntegralPlace));
  return set;
}

void store_set(std::span<std::byte> out, const ControllerSet& set) noexcept {
  store_u16_le(slice<2>(out, 0), static_cast<std::uint16_t>(set.kind));
  store_u16_le(slice<2>(out, kRatePlace), set.rate_hz);
  for (const auto& [member, place] : kPlaces) {
    const auto& filter = set.*member;
    store_u16_le(slice<2>(out, place), filter.count);
    for (std::size_t i = 0; i < kMostCoefficients; ++i) {
      store_f32_le(slice<4>(out, place + 2 + 4 * i), filter.values[i]);
    }
  }
  store_f32_le(slice<4>(out, kIntegralPlace), set.integral);
}

Eeprom image_of(std::uint8_t node, const MotorConstants& motor, const Coefficients& position,
                const ControllerSet& speed) noexcept {
  return {Eeprom::kMarker,
          node,
          motor,
          {ControllerKind::kPosition, 625, position, position, {1, {-0.9716F}}, 0.0F},
          speed};
}

}  // namespace

ReadBack read_back(const ControllerSet& set) noexcept {
  std::array<std::byte, kStoredSetSize> memory{};
  store_set(memory, set);
  ReadBack bytes;
  auto rest = bytes.extend(wire_size(set));
  const auto send = [&](std::size_t place, std::size_t size) {
    const auto known = Bytes{memory}.subspan(place);
    std::ranges::copy(known.first(std::min(size, known.size())), rest.begin());
    rest = rest.subspan(size);
  };
  send(0, 1);
  send(kRatePlace, 2);
  for (const auto& [filter, place] : kPlaces) {
    send(place, 1);
    send(place + 2, std::size_t{4} * (set.*filter).count);
  }
  send(kIntegralPlace, 4);
  rest[0] = std::byte{checksum(bytes.view().first(bytes.size() - 1))};
  return bytes;
}

Eeprom decode_eeprom(std::span<const std::byte, kEepromSize> image) noexcept {
  const Bytes in{image};
  Eeprom eeprom;
  eeprom.node = std::to_integer<std::uint8_t>(in[kNodePlace]);
  eeprom.marker = load_u16_le(slice<2>(in, kMarkerPlace));
  for (std::size_t i = 0; i < kMotorFloats.size(); ++i) {
    eeprom.motor.*kMotorFloats[i] = load_f32_le(slice<4>(in, kMotorPlace + 4 * i));
  }
  eeprom.position = decode_stored_set(in.subspan(kPositionPlace));
  eeprom.speed = decode_stored_set(in.subspan(kSpeedPlace));
  return eeprom;
}

EepromImage encode(const Eeprom& eeprom) noexcept {
  EepromImage image;
  image.fill(std::byte{0xFF});
  const std::span<std::byte> out{image};
  store_u16_le(slice<2>(out, kNodePlace), eeprom.node);
  store_u16_le(slice<2>(out, kMarkerPlace), eeprom.marker);
  for (std::size_t i = 0; i < kMotorFloats.size(); ++i) {
    store_f32_le(slice<4>(out, kMotorPlace + 4 * i), eeprom.motor.*kMotorFloats[i]);
  }
  store_set(out.subspan(kPositionPlace), eeprom.position);
  store_set(out.subspan(kSpeedPlace), eeprom.speed);
  return image;
}

bool is_usable(const Eeprom& eeprom, const Profile& profile) noexcept {
  return eeprom.marker == Eeprom::kMarker && eeprom.position.kind == ControllerKind::kPosition &&
         eeprom.speed.kind == ControllerKind::kSpeed && eeprom.node <= profile.last_node;
}

Eeprom dcx22l(std::uint8_t node) noexcept {
  return image_of(node, kDcx22l.constants, {2, {-1.5711F, 2.2623F}},
                  {ControllerKind::kSpeed,
                   500,
                   {2, {0.0604F, 0.0604F}},
                   {2, {-1.0024F, 1.6352F}},
                   {1, {-0.5948F}},
                   0.4904F});
}

Eeprom dcx26l(std::uint8_t node) noexcept {
  return image_of(node, kDcx26l.constants, {2, {-1.5937F, 2.0104F}},
                  {ControllerKind::kSpeed,
                   400,
                   {2, {0.0284F, 0.0284F}},
                   {2, {-0.5653F, 0.8839F}},
                   {1, {-0.6251F}},
                   0.2524F});
}

Eeprom eeprom_of(const KnownMotor& motor, std::uint8_t node) noexcept {
  return motor.name == kDcx26l.name ? dcx26l(node) : dcx22l(node);
}

}  // namespace armjig::morap::emulation
