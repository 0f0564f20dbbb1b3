// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "harness/core/error.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/rig/log_file.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// Writes down every byte that passes, with its time and what it means: a line for each piece as it
/// was written or read, with a key `messages` for those that ended in it. Not in it: what a write
/// that failed may have sent in part, and the stops of the supervisor, which come when we are gone.
class LoggedStream final : public StreamPort {
 public:
  /// Problems: the file cannot be written.
  [[nodiscard]] static Outcome<std::unique_ptr<StreamPort>> log(std::unique_ptr<StreamPort> port,
                                                                const std::string& path,
                                                                const DissectorEntry& device);

  Result<void> write(Bytes bytes) override;
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;
  [[nodiscard]] Instant now() const override { return port_->now(); }
  [[nodiscard]] std::optional<int> descriptor() const override { return port_->descriptor(); }
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override;

 private:
  LoggedStream(std::unique_ptr<StreamPort> port, LogFile file,
               std::unique_ptr<Dissector> dissector);
  void write_line(Direction direction, Bytes bytes);

  std::unique_ptr<StreamPort> port_;
  LogFile file_;
  std::unique_ptr<Dissector> dissector_;
};

}  // namespace armjig
