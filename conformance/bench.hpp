// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// A conversation with a device on a stream, for the body of a conformance case. The same calls
/// mean the same in virtual and in real time. Once the port has failed, sending does nothing and
/// nothing arrives any more; the engine sees `error` and blames the rig, not the device.
class Bench {
 public:
  Bench(StreamPort& port, const DissectorEntry& device);

  void send(Bytes bytes);

  /// The next message of the device, or bytes that are none; waits at most `within`.
  [[nodiscard]] std::optional<Message> receive(Duration within);

  /// Lets time pass. What arrives meanwhile stays to be received.
  void pause(Duration duration);

  /// Forgets what has arrived, until nothing more came for `quiet`.
  void drain(Duration quiet);

  [[nodiscard]] Instant now() const { return port_.now(); }
  [[nodiscard]] const std::optional<Error>& error() const noexcept { return error_; }

  /// The last few messages both ways, oldest first, decoded. Starts anew with `forget_exchange`.
  [[nodiscard]] std::string last_exchange() const;
  void forget_exchange() noexcept { exchange_.clear(); }

 private:
  void read_until(Instant deadline);
  void remember(const Message& message);

  StreamPort& port_;
  std::unique_ptr<Dissector> dissector_;
  std::deque<Message> arrived_;
  std::deque<Message> exchange_;
  std::optional<Error> error_;
};

}  // namespace armjig
