// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/link/port_around.hpp"
#include "harness/rig/wire_log.hpp"

/// A recording around each kind of port.
namespace armjig {

/// A record for each piece as it was written or read.
class LoggedStream final : public StreamAround {
 public:
  LoggedStream(std::unique_ptr<StreamPort> port, std::shared_ptr<WireLog> log);

  Result<void> write(Bytes bytes) override;
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override;

 private:
  WireLog::Talk talk_;
};

/// Every segment of every connection, and how each began and ended.
class LoggedSession final : public SessionAround {
 public:
  /// `offset` is what the log's clock is ahead of the port's.
  LoggedSession(std::unique_ptr<SessionPort> port, std::shared_ptr<WireLog> log,
                Duration offset = {});
  ~LoggedSession() override { write_end("client-close"); }

  Result<void> connect(Instant deadline) override;
  Result<void> send(Bytes segment) override;
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override;
  void half_close() override;
  void close() override;
  void reset() override;

 private:
  void write_bytes(Direction direction, Bytes bytes);
  void write_end(std::string_view how);
  void write_border(std::string_view direction, std::string_view how);
  [[nodiscard]] Instant time() const { return now() + offset_; }

  std::shared_ptr<WireLog> log_;
  Duration offset_;
  std::optional<WireLog::Talk> talk_;  ///< of the connection
  std::uint32_t connection_ = 0;
  bool is_open_ = false;
};

/// A record `write` or `read` for each part of a transaction, as the recordings of captures/morap
/// have them, with the time at which it began. What an adapter does not tell is not in it: which
/// byte was refused (`ack` ends after the address), and in which part of several (`ack` is empty);
/// `refused` says that something was, `error` that the bus failed.
class LoggedBus final : public BusAround {
 public:
  LoggedBus(std::unique_ptr<BusPort> port, std::shared_ptr<WireLog> log);
  ~LoggedBus() override;

  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override;
  [[nodiscard]] Result<Ack> start(BusAddress address, Access access) override;
  [[nodiscard]] Result<Ack> write(std::byte byte) override;
  [[nodiscard]] Result<std::byte> read(Ack reply) override;
  Result<void> stop() override;
  Result<void> recover() override;
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override;

 private:
  /// From a start to the next one, or to the stop.
  struct Part {
    Instant begin{};
    BusAddress address{};
    Access access{};
    std::vector<std::byte> bytes{};
    std::string acks{};  ///< `A` or `N` for each byte that was answered
  };

  void note(const Part& part, BusPart::Ending ending, std::optional<ErrorCode> error,
            const WireLog::Keys& more = {});
  void end_part(BusPart::Ending ending, std::optional<ErrorCode> error = {});

  WireLog::Talk talk_;
  std::optional<Part> part_;
};

/// Every connection to a server logged, by one clock.
class LoggedSource final : public SourceAround {
 public:
  LoggedSource(std::unique_ptr<SessionSource> inner, std::shared_ptr<WireLog> log);
  bool touch(std::string_view input, std::int64_t value) override;

 private:
  std::shared_ptr<WireLog> log_;
};

}  // namespace armjig
