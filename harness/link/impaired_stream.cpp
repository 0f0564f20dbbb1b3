// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impaired_stream.hpp"

#include <tuple>
#include <utility>

namespace armjig {

ImpairedStream::ImpairedStream(std::unique_ptr<StreamPort> inner, const Impairment& impairment)
    : StreamAround{std::move(inner)}, paths_{impairment} {}

ImpairedStream::~ImpairedStream() {
  if (!failure_) std::ignore = send_due(Instant::max());
}

Result<void> ImpairedStream::write(Bytes bytes) {
  const auto time = now();
  if (const auto error = failure(time)) return tl::unexpected{*error};
  paths_.out.push(time, bytes);
  if (auto sent = send_due(time); !sent) return sent;
  if (const auto error = failure(time)) return tl::unexpected{*error};
  return {};
}

Result<std::size_t> ImpairedStream::read(std::span<std::byte> into, Instant deadline) {
  if (into.empty()) return 0;
  for (bool has_fetched = false;; has_fetched = true) {
    const auto time = now();  // one for all, or what falls between two would be waited for too long
    if (const auto sent = send_due(time); !sent && !failure_) return tl::unexpected{sent.error()};
    if (const auto size = paths_.take(into, failure_ ? Instant::max() : time); size > 0) {
      return size;
    }
    if (const auto error = failure(time)) return tl::unexpected{*error};
    // A real device may send without end what is delayed beyond the deadline.
    if (has_fetched && time >= deadline) return 0;
    const auto fetched = fetch(paths_.next_due(time, deadline));
    if (!fetched && !failure_) return tl::unexpected{fetched.error()};
  }
}

Result<void> ImpairedStream::send_due(Instant until) {
  while (const auto delivery = paths_.out.pop(until)) {
    if (const auto sent = inner().write(delivery->bytes); !sent) return failed(sent.error());
  }
  return {};
}

/// Waits for bytes of the inner port until `limit`.
Result<void> ImpairedStream::fetch(Instant limit) {
  const auto size = inner().read(buffer_, limit);
  if (!size) return failed(size.error());
  paths_.in.push(now(), Bytes{buffer_}.first(*size));
  return {};
}

/// Why nothing works any more, if so.
std::optional<Error> ImpairedStream::failure(Instant time) {
  if (!failure_ && paths_.is_broken(time)) {
    paths_.drop();
    failure_ = Error{ErrorCode::kDisconnected};
  }
  return failure_;
}

tl::unexpected<Error> ImpairedStream::failed(const Error& error) {
  if (error.code == ErrorCode::kDisconnected) {
    failure_ = error;
    paths_.out.drop();
  }
  return tl::unexpected{error};
}

}  // namespace armjig
