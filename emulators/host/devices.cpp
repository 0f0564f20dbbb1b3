// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/devices.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "emulators/demo/demo.hpp"
#include "emulators/faults/faulty.hpp"
#include "emulators/host/kinovazed_options.hpp"
#include "emulators/host/memory_server.hpp"
#include "emulators/host/parol6_options.hpp"
#include "harness/link/memory_stream.hpp"

namespace armjig {
namespace {

Outcome<Faulty<demo::StreamDevice>> make_demo(const DeviceOptions& options,
                                              const std::string& where) {
  std::vector<Fault> faults;
  for (const auto& [name, value] : options) {
    if (name == "profile" && (value == "firmware" || value == "documented")) continue;
    if (name != "fault") {
      return problem(ErrorCode::kUnknownOption, where, "the demo device has profile and fault");
    }
    const auto fault = parse_fault(value, demo::reply_fields());
    if (!fault) return tl::unexpected{fault.error()};
    faults.push_back(*fault);
  }
  return Faulty{demo::StreamDevice{}, std::move(faults), demo::kMessageSize};
}

/// A device behind a link of the operating system.
template <auto make>
Outcome<std::unique_ptr<HostedStream>> host(const DeviceOptions& options,
                                            const std::string& where) {
  auto device = make(options, where);
  if (!device) return tl::unexpected{device.error()};
  return make_hosted(*std::move(device));
}

/// The same device in memory.
template <auto make>
Outcome<std::unique_ptr<StreamPort>> open(const Target& target) {
  auto device = make(target.options, target.text);
  if (!device) return tl::unexpected{device.error()};
  return std::make_unique<MemoryStream<typename decltype(device)::value_type>>(*std::move(device));
}

std::span<const DeviceInput> no_inputs() noexcept { return {}; }

constexpr std::array kDevices{
    HostEntry{"demo", host<make_demo>, open<make_demo>, no_inputs},
    HostEntry{"parol6", host<parol6::make_arm>, open<parol6::make_arm>, parol6::arm_inputs},
};

Outcome<std::unique_ptr<HostedServer>> host_kinovazed(const DeviceOptions& options,
                                                      const std::string& where) {
  auto server = kinovazed::make_server(options, where);
  if (!server) return tl::unexpected{server.error()};
  return make_hosted_server(*std::move(server));
}

Outcome<std::unique_ptr<SessionSource>> open_kinovazed(const Target& target) {
  auto server = host_kinovazed(target.options, target.text);
  if (!server) return tl::unexpected{server.error()};
  return make_memory_server(*std::move(server));
}

constexpr std::array kServers{
    ServerEntry{"kinovazed", host_kinovazed, 51717, open_kinovazed, kinovazed::server_inputs}};

std::string all_names() {
  std::string names;
  for (const auto& entry : kServers) names += std::string{entry.device} + ", ";
  for (const auto& entry : kDevices) {
    names += std::string{entry.device} + ", ";
  }
  names.resize(names.size() - 2);
  return names;
}

}  // namespace

std::span<const HostEntry> hosted_devices() noexcept { return kDevices; }
std::span<const ServerEntry> hosted_servers() noexcept { return kServers; }

const HostEntry& hosted_device(std::string_view device) noexcept {
  return *std::ranges::find(kDevices, device, &HostEntry::device);
}

const ServerEntry& hosted_server(std::string_view device) noexcept {
  return *std::ranges::find(kServers, device, &ServerEntry::device);
}

Outcome<std::unique_ptr<HostedStream>> make_hosted_device(const std::string& device,
                                                          const DeviceOptions& options) {
  const auto* const entry = std::ranges::find(kDevices, device, &HostEntry::device);
  if (entry == kDevices.end()) {
    return problem(ErrorCode::kUnknownDevice, device, "there are: " + all_names());
  }
  return entry->make(options, device);
}

}  // namespace armjig
