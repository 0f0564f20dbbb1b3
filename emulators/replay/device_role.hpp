// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "emulators/memory/hosted.hpp"
#include "emulators/replay/kept_record.hpp"
#include "harness/capture/capture.hpp"
#include "harness/wire/dissector.hpp"

/// The device's side of a recording, played to any host: it says what it said when the host has
/// said what it had said before, after the same time, and keeps what the host says now.
namespace armjig {

struct DeviceRole {
  double speed = 1;  ///< 2: in half the time; what is kept has the times of the recording
  /// What the host says so much later than it had is waited for no longer, but its first word is.
  Duration patience = std::chrono::seconds{2};
  Duration trailing{};  ///< listens so much longer than the recording lasts
  /// Messages of the host are counted by it, since they may come in other pieces.
  MakeDissector make_dissector{};
};

/// What is to be compared, of the host, in order of time.
struct HostSaid {
  std::vector<KeptRecord> expected;
  std::vector<KeptRecord> actual;
  std::size_t not_awaited{};  ///< messages that patience ended for
  /// What the device cannot play, by its name, and how often.
  std::map<std::string, std::size_t> left_out;
};

/// A device that plays its part of a recording, and what its host said so far; the second lives as
/// long as anybody has it. On a stream or a server it is gone when the recording is over. On a bus
/// it answers each operation by the next recorded one on that address in that direction; one that
/// nobody recorded is not acknowledged, or reads 0xFF.
struct PlayedDevice {
  AnyHosted device;
  std::shared_ptr<const HostSaid> said;
};

/// `kind` is that of the link whose records these are, with the events beside it: `kStream`,
/// `kSession` or `kBus`.
[[nodiscard]] PlayedDevice play_device(LinkKind kind, std::vector<KeptRecord> records,
                                       const DeviceRole& role);

}  // namespace armjig
