// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/parameter_parser.hpp"

#include <array>
#include <bit>

namespace armjig::morap::emulation {
namespace {

constexpr std::array kFilters{&ControllerSet::d, &ControllerSet::c, &ControllerSet::f};

void replace_byte(float& value, std::size_t place, std::byte byte) noexcept {
  const auto shift = 8 * place;
  const auto kept = std::bit_cast<std::uint32_t>(value) & ~(0xFFU << shift);
  value = std::bit_cast<float>(kept | std::to_integer<std::uint32_t>(byte) << shift);
}

}  // namespace

ParameterParser::Verdict ParameterParser::step(std::byte byte, ControllerSet& staging) noexcept {
  switch (part_) {
    case Part::kKind:
      staging.kind = ControllerKind{std::to_integer<std::uint8_t>(byte)};
      next(Part::kRate);
      return Verdict::kGoesOn;
    case Part::kRate:
      if (place_ == 0) {
        staging.rate_hz = static_cast<std::uint16_t>((staging.rate_hz & 0xFF00U) |
                                                     std::to_integer<unsigned>(byte));
        ++place_;
        return Verdict::kGoesOn;
      }
      staging.rate_hz = static_cast<std::uint16_t>((staging.rate_hz & 0xFFU) |
                                                   std::to_integer<unsigned>(byte) << 8);
      for (const auto filter : kFilters) (staging.*filter).count = 0;
      next(Part::kCount);
      return Verdict::kGoesOn;
    case Part::kCount:
      return take_count(byte, staging);
    case Part::kCoefficients:
      take_coefficient(byte, staging);
      return Verdict::kGoesOn;
    case Part::kIntegral:
      replace_byte(staging.integral, place_, byte);
      if (++place_ == sizeof(float)) next(Part::kCheck);
      return Verdict::kGoesOn;
    case Part::kCheck: {
      next(Part::kDone);
      const auto expected = encode(staging).view().back();
      return byte == expected ? Verdict::kAccepted : Verdict::kRefused;
    }
    case Part::kDone:
      break;
  }
  return Verdict::kGoesOn;
}

ParameterParser::Verdict ParameterParser::take_count(std::byte byte,
                                                     ControllerSet& staging) noexcept {
  const auto count = std::to_integer<std::uint8_t>(byte);
  (staging.*kFilters[filter_]).count = count;
  if (count > kMostCoefficients) {
    next(Part::kDone);
    return Verdict::kRefused;
  }
  if (count > 0) {
    next(Part::kCoefficients);
  } else {
    next_filter();
  }
  return Verdict::kGoesOn;
}

void ParameterParser::take_coefficient(std::byte byte, ControllerSet& staging) noexcept {
  auto& filter = staging.*kFilters[filter_];
  replace_byte(filter.values[place_ / sizeof(float)], place_ % sizeof(float), byte);
  if (++place_ == filter.count * sizeof(float)) next_filter();
}

void ParameterParser::next(Part part) noexcept {
  part_ = part;
  place_ = 0;
}

void ParameterParser::next_filter() noexcept {
  next(++filter_ < kFilters.size() ? Part::kCount : Part::kIntegral);
}

}  // namespace armjig::morap::emulation
