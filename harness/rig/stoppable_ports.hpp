// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "harness/link/port_around.hpp"

/// Around each kind of port: as long as somebody wants an end, every call fails with `kForbidden`,
/// and those that wait end soon. The link is not lost: what has to be put in order can be
/// afterwards.
namespace armjig {

/// Whether work on a port is to end. Asked often, so it is quick.
using MustStop = std::function<bool()>;

class StoppableStream final : public StreamAround {
 public:
  StoppableStream(std::unique_ptr<StreamPort> port, MustStop must_stop)
      : StreamAround{std::move(port)}, must_stop_{std::move(must_stop)} {}

  Result<void> write(Bytes bytes) override;
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;

 private:
  MustStop must_stop_;
};

class StoppableSession final : public SessionAround {
 public:
  StoppableSession(std::unique_ptr<SessionPort> port, MustStop must_stop)
      : SessionAround{std::move(port)}, must_stop_{std::move(must_stop)} {}

  Result<void> connect(Instant deadline) override;
  Result<void> send(Bytes segment) override;
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override;
  void half_close() override { inner().half_close(); }
  void close() override { inner().close(); }
  void reset() override { inner().reset(); }

 private:
  MustStop must_stop_;
};

class StoppableSource final : public SourceAround {
 public:
  StoppableSource(std::unique_ptr<SessionSource> source, const MustStop& must_stop);

  void pause(Duration duration) override;

 private:
  MustStop must_stop_;
};

class StoppableBus final : public BusAround {
 public:
  StoppableBus(std::unique_ptr<BusPort> port, MustStop must_stop)
      : BusAround{std::move(port)}, must_stop_{std::move(must_stop)} {}

  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override;
  [[nodiscard]] Result<Ack> start(BusAddress address, Access access) override;
  [[nodiscard]] Result<Ack> write(std::byte byte) override;
  [[nodiscard]] Result<std::byte> read(Ack reply) override;
  Result<void> stop() override { return inner().stop(); }
  void wait_until(Instant time) override;

 private:
  MustStop must_stop_;
};

}  // namespace armjig
