// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "conformance/port_bench.hpp"
#include "harness/core/bytes.hpp"

namespace armjig {

/// A conversation with a device on a byte stream. The same calls mean the same in virtual and in
/// real time. Once a case is decided, or the port has failed, sending does nothing, nothing arrives
/// and no time passes.
class StreamBench : public DissectedBench<StreamPort> {
 public:
  StreamBench(Rig<StreamPort> rig, std::unique_ptr<Dissector> dissector);

  /// What the guard refuses decides the case.
  void send(Bytes bytes);

  /// The next message of the device, or bytes that are none; waits at most `within`.
  [[nodiscard]] std::optional<Message> receive(Duration within);

  /// Lets time pass. What arrives meanwhile stays to be received.
  void pause(Duration duration);

  /// Forgets what has arrived, until nothing more came for `quiet`.
  void drain(Duration quiet);

 private:
  void read_until(Instant deadline);

  std::deque<Message> arrived_;
};

}  // namespace armjig
