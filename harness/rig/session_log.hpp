// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "harness/core/error.hpp"
#include "harness/link/session_port.hpp"
#include "harness/rig/log_file.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// `LoggedStream` for a server: every segment of every connection, how each began and ended, and
/// what was said.
class LoggedSession final : public SessionPort {
 public:
  /// Problems: the file cannot be written.
  [[nodiscard]] static Outcome<std::unique_ptr<SessionPort>> log(std::unique_ptr<SessionPort> port,
                                                                 const std::string& path,
                                                                 const DissectorEntry& device);

  Result<void> connect(Instant deadline) override;
  Result<void> send(Bytes segment) override;
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override;
  void half_close() override;
  void close() override;
  void reset() override;
  [[nodiscard]] Instant now() const override { return port_->now(); }
  [[nodiscard]] std::optional<int> descriptor() const override { return port_->descriptor(); }

 private:
  LoggedSession(std::unique_ptr<SessionPort> port, LogFile file, const DissectorEntry& device);
  void write_bytes(Direction direction, Bytes bytes);
  void write_end(std::string_view how);
  void write_disconnect(std::string_view how);

  std::unique_ptr<SessionPort> port_;
  LogFile file_;
  const DissectorEntry& device_;
  std::unique_ptr<Dissector> dissector_;  ///< of the connection
  int connection_ = -1;
  bool is_open_ = false;
};

}  // namespace armjig
