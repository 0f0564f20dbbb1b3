// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"

namespace armjig {

/// A connection to a server as a byte stream, for who does not care about connections. When it has
/// ended, in whichever way, so has the stream.
class SessionStream final : public StreamPort {
 public:
  /// Connects; `source` may live on in others. Errors: those of `SessionPort::connect`.
  [[nodiscard]] static Result<std::unique_ptr<StreamPort>> connect(
      std::shared_ptr<SessionSource> source, Duration patience);
  SessionStream(const SessionStream&) = delete;
  SessionStream& operator=(const SessionStream&) = delete;
  ~SessionStream() override { port_->close(); }

  Result<void> write(Bytes bytes) override { return port_->send(bytes); }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;
  [[nodiscard]] Instant now() const override { return port_->now(); }
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override {
    return source_->touch(input, value);
  }
  /// The connection behind it.
  [[nodiscard]] SessionPort& session() noexcept { return *port_; }

 private:
  SessionStream(std::shared_ptr<SessionSource> source, std::unique_ptr<SessionPort> port)
      : source_{std::move(source)}, port_{std::move(port)} {}

  std::shared_ptr<SessionSource> source_;
  std::unique_ptr<SessionPort> port_;
};

}  // namespace armjig
