// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "emulators/memory/hosted.hpp"
#include "emulators/replay/kept_record.hpp"
#include "emulators/replay/replay.hpp"

namespace armjig {

/// The same device, `nullptr` inside if it cannot be copied.
[[nodiscard]] AnyHosted clone(const AnyHosted& device);

/// Whether the host did it: bytes that it sent, operations on a bus, connections that it began or
/// ended, what was done beside the link.
[[nodiscard]] bool is_by_host(const KeptRecord& record);

/// The host of a recording, talking to a device in memory whatever the device says. Who wants to
/// know what that is overhears the device.
class RecordedHost {
 public:
  /// `touches_of` as in `PlayHow`. `lead`: bytes on a stream leave so much earlier, as there.
  /// A server listens from the beginning.
  RecordedHost(AnyHosted device, TouchesOf touches_of, Duration lead = {});
  /// The same host in the middle of the same talk, to another device: its own, or a copy of that,
  /// in whatever it is wrapped now.
  RecordedHost(const RecordedHost& like, AnyHosted device);

  /// Does what the record says, at its time; nothing if the device did it.
  void play(const KeptRecord& record);
  void advance_to(Instant time);

  /// Whether the bus is between two transactions. Other links always are.
  [[nodiscard]] bool is_idle() const noexcept { return is_idle_; }
  [[nodiscard]] Instant now() const noexcept { return now_; }
  [[nodiscard]] const AnyHosted& device() const noexcept { return device_; }

  /// Ends its connections and gives the device away.
  [[nodiscard]] AnyHosted leave() &&;

 private:
  void play_on(HostedStream& device, const KeptRecord& record);
  void play_on(HostedServer& device, const KeptRecord& record);
  void play_on(HostedBus& device, const KeptRecord& record);
  void clear_sent();
  void play_event(const KeptRecord& record);
  bool play_border(HostedServer& server, const KeptRecord& record);

  AnyHosted device_;
  TouchesOf touches_of_;
  Duration lead_{};
  Instant now_{};
  bool is_idle_ = true;
  std::map<std::uint32_t, ConnectionId> connections_;  ///< by number in the recording
};

}  // namespace armjig
