// SPDX-License-Identifier: Apache-2.0
#include "emulators/usb/description.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace armjig::usb {
namespace {

enum Type : std::uint8_t { kDevice = 1, kConfig = 2, kString = 3, kInterface = 4, kEndpoint = 5 };

constexpr std::uint16_t kUsbVersion = 0x0200;
constexpr std::uint16_t kEnglish = 0x0409;
constexpr std::uint8_t kBusPowered = 0x80;
constexpr std::uint8_t kPower = 50;  // in units of 2 mA

// The strings, from 1 on.
enum Name : std::uint8_t { kManufacturer = 1, kProduct = 2, kSerialNumber = 3 };

void put(std::vector<std::byte>& out, std::initializer_list<unsigned> bytes) {
  for (const auto byte : bytes) out.push_back(static_cast<std::byte>(byte));
}

constexpr unsigned low(std::uint16_t word) { return word & 0xFFU; }
constexpr unsigned high(std::uint16_t word) { return word >> 8U; }

void put_interface(std::vector<std::byte>& out, const Interface& interface, std::uint8_t number) {
  put(out, {9, kInterface, number, 0, static_cast<unsigned>(interface.endpoints.size()),
            interface.code.main, interface.code.sub, interface.code.protocol, 0});
  out.insert(out.end(), interface.functional.begin(), interface.functional.end());
  for (const auto& endpoint : interface.endpoints) {
    put(out, {7, kEndpoint, endpoint.address, static_cast<unsigned>(endpoint.kind),
              low(endpoint.packet_size), high(endpoint.packet_size), endpoint.interval});
  }
}

std::vector<std::byte> text_descriptor(std::string_view text) {
  const auto shown = text.substr(0, kLongestText);
  std::vector<std::byte> out;
  put(out, {static_cast<unsigned>(2 + 2 * shown.size()), kString});
  for (const char c : shown) {
    const bool is_ascii = c >= ' ' && c <= '~';
    put(out, {static_cast<unsigned char>(is_ascii ? c : '?'), 0});
  }
  return out;
}

}  // namespace

std::vector<std::byte> device_descriptor(const Description& description) {
  const auto& identity = description.identity;
  std::vector<std::byte> out;
  put(out,
      {18, kDevice, low(kUsbVersion), high(kUsbVersion), description.code.main,
       description.code.sub, description.code.protocol, description.control_packet_size,
       low(identity.vendor), high(identity.vendor), low(identity.product), high(identity.product),
       low(kDeviceVersion), high(kDeviceVersion), kManufacturer, kProduct, kSerialNumber, 1});
  return out;
}

std::vector<std::byte> configuration_descriptor(const Description& description) {
  std::vector<std::byte> out;
  put(out, {9, kConfig, 0, 0, static_cast<unsigned>(description.interfaces.size()), kConfiguration,
            0, kBusPowered, kPower});
  for (std::size_t i = 0; i < description.interfaces.size(); ++i) {
    put_interface(out, description.interfaces[i], static_cast<std::uint8_t>(i));
  }
  const auto size = static_cast<std::uint16_t>(out.size());
  out[2] = static_cast<std::byte>(low(size));
  out[3] = static_cast<std::byte>(high(size));
  return out;
}

std::optional<std::vector<std::byte>> string_descriptor(const Description& description,
                                                        std::uint8_t index) {
  const auto& identity = description.identity;
  switch (index) {
    case 0: {
      std::vector<std::byte> languages;
      put(languages, {4, kString, low(kEnglish), high(kEnglish)});
      return languages;
    }
    case kManufacturer:
      return text_descriptor(identity.manufacturer);
    case kProduct:
      return text_descriptor(identity.product_name);
    case kSerialNumber:
      return text_descriptor(identity.serial_number);
    default:
      return std::nullopt;
  }
}

const Endpoint* find_endpoint(const Description& description, std::uint8_t address) noexcept {
  for (const auto& interface : description.interfaces) {
    const auto found = std::ranges::find(interface.endpoints, address, &Endpoint::address);
    if (found != interface.endpoints.end()) return &*found;
  }
  return nullptr;
}

}  // namespace armjig::usb
