// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "conformance/bench.hpp"
#include "harness/core/bytes.hpp"
#include "harness/rig/rig.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// A conversation with a device on a byte stream. The same calls mean the same in virtual and in
/// real time. Once a case is decided, or the port has failed, sending does nothing, nothing arrives
/// and no time passes.
class StreamBench : public Bench {
 public:
  StreamBench(Rig rig, const DissectorEntry& device);

  /// What the guard forbids skips the case, for the device has not done anything wrong.
  void send(Bytes bytes);

  /// The next message of the device, or bytes that are none; waits at most `within`.
  [[nodiscard]] std::optional<Message> receive(Duration within);

  /// Lets time pass. What arrives meanwhile stays to be received.
  void pause(Duration duration);

  /// Forgets what has arrived, until nothing more came for `quiet`.
  void drain(Duration quiet);

  /// Does at the device what its link cannot: a switch, an input, the power. Skips the case where
  /// nobody can.
  void touch(std::string_view input, std::int64_t value);

  [[nodiscard]] Instant now() const override;
  [[nodiscard]] const std::optional<Error>& error() const override { return error_; }
  [[nodiscard]] std::string last_exchange() const override;

 protected:
  void forget_exchange() override { exchange_.clear(); }

 private:
  [[nodiscard]] bool is_deaf() const noexcept { return error_ || is_over(); }
  void read_until(Instant deadline);
  void skip_if_stopped();
  void remember(const Message& message);

  Rig rig_;
  std::unique_ptr<Dissector> dissector_;
  std::deque<Message> arrived_;
  std::deque<Message> exchange_;
  std::optional<Error> error_;
  bool knows_it_is_stopped_ = false;
};

}  // namespace armjig
