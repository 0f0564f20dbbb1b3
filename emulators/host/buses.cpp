// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/buses.hpp"

#include <algorithm>
#include <array>

#include "emulators/host/morap_bus.hpp"

namespace armjig {
namespace {

constexpr std::array kBuses{
    BusEntry{"morap", morap::make_bus, morap::open_emulated_bus},
};

}  // namespace

std::span<const BusEntry> hosted_buses() noexcept { return kBuses; }

const BusEntry* find_hosted_bus(std::string_view device) noexcept {
  const auto* const found = std::ranges::find(kBuses, device, &BusEntry::device);
  return found == kBuses.end() ? nullptr : found;
}

}  // namespace armjig
