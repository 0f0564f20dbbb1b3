// SPDX-License-Identifier: Apache-2.0
#include "harness/link/tcp_session.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <thread>
#include <utility>

#include "harness/link/descriptor.hpp"
#include "harness/link/tcp_connection.hpp"

namespace armjig {
namespace {

/// A reset after the server's own end arrives as EPIPE.
bool is_reset(int error_number) noexcept {
  return error_number == ECONNRESET || error_number == EPIPE;
}

class TcpSession final : public SessionPort {
 public:
  explicit TcpSession(TcpAddress address, Stopwatch clock = {})
      : address_{std::move(address)}, clock_{clock} {}
  ~TcpSession() override { close_in_order(); }

  Result<void> connect(Instant deadline) override {
    if (socket_.is_open()) return fail(ErrorCode::kBusy);
    auto socket = connect_tcp(address_, deadline - clock_.now());
    if (!socket) return tl::unexpected{socket.error()};
    socket_ = std::move(*socket);
    was_reset_ = false;
    return {};
  }

  Result<void> send(Bytes segment) override {
    if (!socket_.is_open()) return fail(ErrorCode::kDisconnected);
    auto sent = send_all(socket_, segment, clock_, kWritePatience);
    // The kernel tells of a reset once; `receive` must not take what follows for an orderly end.
    if (!sent && is_reset(sent.error().detail)) was_reset_ = !is_half_closed_;
    return sent;
  }

  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    assert(!into.empty());
    while (socket_.is_open() && !was_reset_) {
      const auto size = ::recv(socket_.value(), into.data(), into.size(), 0);
      if (size > 0) return Received{Arrival::kData, static_cast<std::size_t>(size)};
      if (size == 0) {
        // Said again, it takes time, or who waits for something else keeps a processor busy.
        if (std::exchange(is_end_told_, true)) {
          std::this_thread::sleep_for(
              std::clamp(deadline - clock_.now(), Duration{}, kBetweenEnds));
        }
        return Received{Arrival::kEnd, 0};
      }
      if (is_reset(errno)) {
        was_reset_ = true;
      } else if (errno == EAGAIN || errno == EINTR) {
        const auto is_ready = wait_for(socket_, Readiness::kReadable, clock_, deadline);
        if (!is_ready) return tl::unexpected{is_ready.error()};
        if (!*is_ready) return Received{Arrival::kDeadline, 0};
      } else {
        return fail(ErrorCode::kDisconnected, errno);
      }
    }
    if (!socket_.is_open()) return fail(ErrorCode::kDisconnected);
    forget();
    return Received{Arrival::kReset, 0};
  }

  void half_close() override {
    if (!socket_.is_open()) return;
    ::shutdown(socket_.value(), SHUT_WR);
    is_half_closed_ = true;
  }

  void close() override { close_in_order(); }

  void reset() override {
    if (!socket_.is_open()) return;
    const linger now{.l_onoff = 1, .l_linger = 0};
    ::setsockopt(socket_.value(), SOL_SOCKET, SO_LINGER, &now, sizeof now);
    forget();
  }

  [[nodiscard]] Instant now() const override { return clock_.now(); }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    return socket_.is_open() ? std::optional{Lifeline{socket_.value(), send_last}} : std::nullopt;
  }

 private:
  /// Closing with unread bytes would send a reset.
  void close_in_order() noexcept {
    if (!socket_.is_open()) return;
    ::shutdown(socket_.value(), SHUT_WR);
    std::array<std::byte, 4096> unread;
    int patience = 1000;  // a server that never stops sending gets its reset
    while (patience-- > 0 && ::recv(socket_.value(), unread.data(), unread.size(), 0) > 0) {
    }
    forget();
  }

  void forget() noexcept {
    socket_.close();
    is_half_closed_ = false;
    was_reset_ = false;
    is_end_told_ = false;
  }

  static constexpr Duration kBetweenEnds = std::chrono::milliseconds{100};

  TcpAddress address_;
  Stopwatch clock_;
  Descriptor socket_;
  bool is_half_closed_ = false;
  bool was_reset_ = false;
  bool is_end_told_ = false;  ///< of the server
};

class TcpServer final : public SessionSource {
 public:
  explicit TcpServer(TcpAddress address) : address_{std::move(address)} {}

  std::unique_ptr<SessionPort> make_port() override {
    return std::make_unique<TcpSession>(address_, clock_);
  }
  [[nodiscard]] Instant now() const override { return clock_.now(); }
  void pause(Duration duration) override { std::this_thread::sleep_for(duration); }

 private:
  TcpAddress address_;
  Stopwatch clock_;
};

/// `Made` at an address.
template <class Made, class Base>
Outcome<std::unique_ptr<Base>> made_at(std::string_view address) {
  auto where = parse_tcp_address(address);
  if (!where) return tl::unexpected{where.error()};
  return std::make_unique<Made>(*std::move(where));
}

}  // namespace

Outcome<std::unique_ptr<SessionSource>> open_tcp_server(std::string_view address) {
  return made_at<TcpServer, SessionSource>(address);
}

Outcome<std::unique_ptr<SessionPort>> make_tcp_session(std::string_view address) {
  return made_at<TcpSession, SessionPort>(address);
}

}  // namespace armjig
