// SPDX-License-Identifier: Apache-2.0
#include "emulators/i2c/bus.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace armjig::i2c {
namespace {

using enum BusReply::Outcome;

constexpr std::byte kIdle{0xFF};
constexpr int kRecoveryClocks = 9;
constexpr std::string_view kPower = "power";

}  // namespace

static_assert(EmulatedBus<Bus>);

std::string name_at(std::uint8_t address) { return fmt::format("0x{:02X}", address); }

BusReply Bus::start(Instant time, std::uint8_t address, bool is_read) {
  time = when_clock_is_free(time);
  if (clocks_to_release_ > 0) return {kDataHeld, time};
  leave_devices(time);
  address_ = address;
  byte_ = 0;
  const auto end = time + kBit + kByte;
  if (take_trouble(Trouble::Kind::kArbitrationLost)) return {kArbitrationLost, end};
  if (take_trouble(Trouble::Kind::kNack)) return finish(end, kNack);
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (!devices_[i].acknowledges(address)) continue;
    devices_[i].start(end, is_read);
    addressed_.push_back(i);
  }
  return finish(end, addressed_.empty() ? kNack : kAck);
}

BusReply Bus::write(Instant time, std::byte byte) {
  time = when_clock_is_free(time);
  ++byte_;
  const auto end = time + kByte;
  if (clocks_to_release_ > 0) return {kDataHeld, end};
  if (take_trouble(Trouble::Kind::kArbitrationLost)) {
    leave_devices(end);
    return {kArbitrationLost, end};
  }
  if (take_trouble(Trouble::Kind::kNack)) return finish(end, kNack);
  bool is_acknowledged = false;
  for (const auto i : addressed_) {
    if (devices_[i].write(end, byte)) is_acknowledged = true;
  }
  return finish(end, is_acknowledged ? kAck : kNack);
}

BusReply Bus::read(Instant time) {
  time = when_clock_is_free(time);
  ++byte_;
  if (clocks_to_release_ > 0) return {kDataHeld, time + kByte};
  auto byte = kIdle;
  for (const auto i : addressed_) byte &= devices_[i].read(time);
  return finish(time + kByte, kAck, byte);
}

BusReply Bus::stop(Instant time) {
  time = when_clock_is_free(time);
  if (clocks_to_release_ > 0) return {kDataHeld, time + kBit};
  leave_devices(time + kBit);
  return {kAck, time + kBit};
}

BusReply Bus::recover(Instant time) {
  time = when_clock_is_free(time) + kRecoveryClocks * kBit;
  clocks_to_release_ = std::max(0, clocks_to_release_ - kRecoveryClocks);
  return stop(time);
}

void Bus::advance_to(Instant time) {
  for (auto& device : devices_) device.advance_to(time);
}

std::span<const DeviceInput> Bus::inputs() noexcept {
  static constexpr std::array kInputs{
      DeviceInput{kPower, "any: off and on, all that is on the bus"}};
  return kInputs;
}

bool Bus::set_input(Instant time, std::string_view name, std::int64_t value) {
  if (name == kPower) {
    advance_to(time);
    for (auto& device : devices_) device.restart(time);
    return !devices_.empty();
  }
  if (const auto found = named(name)) {
    return devices_[found->first].set_input(time, found->second, value);
  }
  return std::ranges::any_of(
      devices_, [&](BusDevice& device) { return device.set_input(time, name, value); });
}

std::optional<std::int64_t> Bus::observe(Instant time, std::string_view name) {
  if (const auto found = named(name)) return devices_[found->first].observe(time, found->second);
  for (auto& device : devices_) {
    if (const auto seen = device.observe(time, name)) return seen;
  }
  return std::nullopt;
}

std::optional<std::pair<std::size_t, std::string_view>> Bus::named(std::string_view name) const {
  const auto dot = name.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const auto found = std::ranges::find(names_, name.substr(0, dot));
  if (found == names_.end()) return std::nullopt;
  return std::pair{static_cast<std::size_t>(found - names_.begin()), name.substr(dot + 1)};
}

std::optional<Trouble> Bus::take_trouble(Trouble::Kind kind) {
  const auto found = std::ranges::find_if(troubles_, [&](const Trouble& trouble) {
    return trouble.kind == kind && trouble.byte == byte_ &&
           trouble.address.value_or(address_) == address_;
  });
  if (found == troubles_.end()) return std::nullopt;
  const auto trouble = *found;
  troubles_.erase(found);
  return trouble;
}

/// What can happen behind any byte: the clock is stretched, the data line sticks, power fails.
BusReply Bus::finish(Instant end, BusReply::Outcome outcome, std::byte byte) {
  Duration stretch{};
  for (const auto i : addressed_) stretch = std::max(stretch, devices_[i].stretch());
  if (const auto trouble = take_trouble(Trouble::Kind::kStretch)) {
    stretch = std::max(stretch, trouble->duration);
  }
  clock_held_until_ = end + stretch;
  if (const auto trouble = take_trouble(Trouble::Kind::kDataHeld)) {
    clocks_to_release_ = trouble->clocks;
  }
  if (take_trouble(Trouble::Kind::kDeviceRestarts)) {
    for (const auto i : addressed_) devices_[i].restart(end);
    addressed_.clear();  // they have forgotten that they were addressed
  }
  return {outcome, clock_held_until_, byte};
}

Instant Bus::when_clock_is_free(Instant time) const noexcept {
  return std::max(time, clock_held_until_);
}

void Bus::leave_devices(Instant time) {
  for (const auto i : addressed_) devices_[i].stop(time);
  addressed_.clear();
}

}  // namespace armjig::i2c
