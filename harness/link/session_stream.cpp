// SPDX-License-Identifier: Apache-2.0
#include "harness/link/session_stream.hpp"

#include <utility>

namespace armjig {

Result<std::unique_ptr<StreamPort>> SessionStream::connect(std::shared_ptr<SessionSource> source,
                                                           Duration patience) {
  auto port = source->make_port();
  if (auto done = port->connect(port->now() + patience); !done) {
    return tl::unexpected{done.error()};
  }
  return std::unique_ptr<StreamPort>{new SessionStream{std::move(source), std::move(port)}};
}

Result<std::size_t> SessionStream::read(std::span<std::byte> into, Instant deadline) {
  const auto received = port_->receive(into, deadline);
  if (!received) return tl::unexpected{received.error()};
  if (received->arrival == SessionPort::Arrival::kDeadline) return 0;
  if (received->arrival == SessionPort::Arrival::kData) return received->size;
  return fail(ErrorCode::kDisconnected);
}

}  // namespace armjig
