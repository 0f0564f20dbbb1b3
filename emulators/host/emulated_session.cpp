// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/emulated_session.hpp"

#include <utility>

#include "emulators/host/devices.hpp"

namespace armjig {
namespace {

/// The only port of a server, which it keeps.
class OnlyPort final : public SessionPort {
 public:
  explicit OnlyPort(std::unique_ptr<SessionSource> source)
      : source_{std::move(source)}, port_{source_->make_port()} {}

  Result<void> connect(Instant deadline) override { return port_->connect(deadline); }
  Result<void> send(Bytes segment) override { return port_->send(segment); }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    return port_->receive(into, deadline);
  }
  void half_close() override { port_->half_close(); }
  void close() override { port_->close(); }
  void reset() override { port_->reset(); }
  [[nodiscard]] Instant now() const override { return port_->now(); }

 private:
  std::unique_ptr<SessionSource> source_;
  std::unique_ptr<SessionPort> port_;
};

}  // namespace

Outcome<std::unique_ptr<SessionPort>> open_kinovazed_session(const Target& target) {
  auto source = hosted_server("kinovazed").open(target);
  if (!source) return tl::unexpected{source.error()};
  return std::make_unique<OnlyPort>(*std::move(source));
}

}  // namespace armjig
