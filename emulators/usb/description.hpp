// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// USB devices as their hosts see them (USB 2.0, chapters 8 and 9).
namespace armjig::usb {

/// In the address of an endpoint: from the device to the host.
inline constexpr std::uint8_t kIn = 0x80;

[[nodiscard]] constexpr bool is_in(std::uint8_t endpoint) noexcept { return (endpoint & kIn) != 0; }

enum class Speed : std::uint8_t { kLow, kFull };

/// Characters of a text at most.
inline constexpr std::size_t kLongestText = 126;

/// By which hosts tell a device from others.
struct Identity {
  std::uint16_t vendor{};
  std::uint16_t product{};
  std::string manufacturer;  ///< ASCII, at most `kLongestText`, like the next two
  std::string product_name;
  std::string serial_number;
};

/// An endpoint but for the first, which all devices have.
struct Endpoint {
  enum class Kind : std::uint8_t { kBulk = 2, kInterrupt = 3 };

  std::uint8_t address{};  ///< with `kIn`
  Kind kind{};
  std::uint16_t packet_size{};  ///< bytes at most; a shorter packet ends a transfer
  std::uint8_t interval{};      ///< of interrupts, in milliseconds
};

/// The code of a class, subclass and protocol, as the USB-IF gives them out.
struct ClassCode {
  std::uint8_t main{};
  std::uint8_t sub{};
  std::uint8_t protocol{};
};

struct Interface {
  ClassCode code;
  std::vector<std::byte> functional;  ///< descriptors of its class
  std::vector<Endpoint> endpoints;
};

/// A device with one configuration, whose value is 1; interfaces are numbered from 0.
struct Description {
  Identity identity;
  Speed speed = Speed::kFull;
  ClassCode code;
  std::uint8_t control_packet_size = 64;
  std::vector<Interface> interfaces;
};

inline constexpr std::uint8_t kConfiguration = 1;
/// Of the device itself, as binary-coded decimal.
inline constexpr std::uint16_t kDeviceVersion = 0x0100;

/// The descriptors as they go over the wire.
[[nodiscard]] std::vector<std::byte> device_descriptor(const Description& description);
[[nodiscard]] std::vector<std::byte> configuration_descriptor(const Description& description);
/// 0 is the list of languages, of which English is the only one. None: there is no such string.
[[nodiscard]] std::optional<std::vector<std::byte>> string_descriptor(
    const Description& description, std::uint8_t index);

/// None: the device has no such endpoint.
[[nodiscard]] const Endpoint* find_endpoint(const Description& description,
                                            std::uint8_t address) noexcept;

}  // namespace armjig::usb
