// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "harness/core/error.hpp"
#include "harness/link/session_port.hpp"
#include "harness/rig/log_file.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// What the ports to one server write to: connections are numbered in the order of their
/// beginnings.
struct SessionLog {
  /// Problems: the file cannot be written.
  [[nodiscard]] static Outcome<std::shared_ptr<SessionLog>> create(const std::string& path,
                                                                   const DissectorEntry& device);

  LogFile file;
  const DissectorEntry& device;
  int connections = 0;  ///< so far
};

/// `LoggedStream` for a server: every segment of every connection, how each began and ended, and
/// what was said.
class LoggedSession final : public SessionPort {
 public:
  /// `offset` is what the log's clock is ahead of the port's.
  LoggedSession(std::unique_ptr<SessionPort> port, std::shared_ptr<SessionLog> log,
                Duration offset = {});
  LoggedSession(const LoggedSession&) = delete;
  LoggedSession& operator=(const LoggedSession&) = delete;
  ~LoggedSession() override { write_end("client-close"); }

  Result<void> connect(Instant deadline) override;
  Result<void> send(Bytes segment) override;
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override;
  void half_close() override;
  void close() override;
  void reset() override;
  [[nodiscard]] Instant now() const override { return port_->now(); }
  [[nodiscard]] std::optional<int> descriptor() const override { return port_->descriptor(); }

 private:
  void write_bytes(Direction direction, Bytes bytes);
  void write_end(std::string_view how);
  void write_disconnect(std::string_view how);

  void add(std::string_view keys, std::span<const Message> messages = {});
  [[nodiscard]] Instant time() const { return now() + offset_; }

  std::unique_ptr<SessionPort> port_;
  std::shared_ptr<SessionLog> log_;
  Duration offset_;
  std::unique_ptr<Dissector> dissector_;  ///< of the connection
  int connection_ = 0;
  bool is_open_ = false;
};

}  // namespace armjig
