// SPDX-License-Identifier: Apache-2.0
#include "cli/server_stream.hpp"

#include <chrono>
#include <memory>
#include <utility>

#include "emulators/host/emulated_session.hpp"
#include "harness/link/reopening_stream.hpp"
#include "harness/rig/server_rig.hpp"

namespace armjig::cli {
namespace {

constexpr Duration kPatience = std::chrono::seconds{2};

/// The only connection of a rig. When it has ended, so has the stream.
class ServerStream final : public StreamPort {
 public:
  explicit ServerStream(ServerRig rig) : rig_{std::move(rig)} {}
  ~ServerStream() override { rig_.port().close(); }

  Result<void> write(Bytes bytes) override { return rig_.port().send(bytes); }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    const auto received = rig_.port().receive(into, deadline);
    if (!received) return tl::unexpected{received.error()};
    if (received->arrival == SessionPort::Arrival::kDeadline) return 0;
    if (received->arrival == SessionPort::Arrival::kData) return received->size;
    return fail(ErrorCode::kDisconnected);
  }
  [[nodiscard]] Instant now() const override { return rig_.port().now(); }

 private:
  ServerRig rig_;
};

Outcome<std::unique_ptr<StreamPort>> connect(const RigOptions& options) {
  auto rig = ServerRig::open("kinovazed", options, open_kinovazed_session);
  if (!rig) return tl::unexpected{rig.error()};
  if (const auto done = rig->port().connect(rig->port().now() + kPatience); !done) {
    return problem(done.error().code, options.target.text, "is the server running?");
  }
  return std::make_unique<ServerStream>(*std::move(rig));
}

}  // namespace

Outcome<Rig> open_kinova_stream(const RigOptions& options) {
  auto port = connect(options);
  if (!port) return tl::unexpected{port.error()};
  if (options.when_gone == WhenGone::kFail || options.target.is_emulated()) {
    return Rig{*std::move(port)};
  }
  return Rig{
      std::make_unique<ReopeningStream>(*std::move(port), [options] { return connect(options); })};
}

}  // namespace armjig::cli
