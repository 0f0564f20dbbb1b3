// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/link/bus_port.hpp"
#include "harness/rig/log_file.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// `LoggedStream` for a bus: a line `write` or `read` for each part of a transaction, as the
/// recordings of captures/morap have them, with the time at which it began. What an adapter does
/// not tell is not in it: which byte was refused (`ack` ends behind the address), and in which part
/// of several (`ack` is empty); `refused` says that something was, `error` that the bus failed.
class LoggedBus final : public BusPort {
 public:
  /// Problems: the file cannot be written.
  [[nodiscard]] static Outcome<std::unique_ptr<BusPort>> log(std::unique_ptr<BusPort> port,
                                                             const std::string& path,
                                                             const DissectorEntry& device);
  LoggedBus(const LoggedBus&) = delete;
  LoggedBus& operator=(const LoggedBus&) = delete;
  ~LoggedBus() override;

  [[nodiscard]] bool has_operations() const noexcept override { return port_->has_operations(); }
  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override;
  [[nodiscard]] Result<Ack> start(BusAddress address, Access access) override;
  [[nodiscard]] Result<Ack> write(std::byte byte) override;
  [[nodiscard]] Result<std::byte> read(Ack reply) override;
  Result<void> stop() override;
  Result<void> recover() override;
  void wait_until(Instant time) override { port_->wait_until(time); }
  [[nodiscard]] Instant now() const override { return port_->now(); }
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

  LoggedBus(std::unique_ptr<BusPort> port, LogFile file, std::unique_ptr<Dissector> dissector);
  void note(const Part& part, std::string_view keys);
  void end_part(std::string_view keys);

  std::unique_ptr<BusPort> port_;
  LogFile file_;
  std::unique_ptr<Dissector> dissector_;
  std::optional<Part> part_;
};

}  // namespace armjig
