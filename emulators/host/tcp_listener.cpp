// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/tcp_listener.hpp"

#include <fmt/core.h>
#include <netinet/tcp.h>
#include <poll.h>

#include <utility>  // before Asio, which forgets it

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "emulators/host/outbox.hpp"

namespace armjig {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

/// When accepting fails, or there is no room.
constexpr auto kAcceptPause = std::chrono::milliseconds{100};

using KeepAliveIdle = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPIDLE>;
using KeepAliveInterval = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPINTVL>;
using KeepAliveCount = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPCNT>;

void tune(tcp::socket& socket) {
  try {
    socket.non_blocking(true);
    socket.set_option(tcp::no_delay{true});
    socket.set_option(tcp::socket::keep_alive{true});
    socket.set_option(KeepAliveIdle{15});
    socket.set_option(KeepAliveInterval{5});
    socket.set_option(KeepAliveCount{3});
  } catch (const boost::system::system_error&) {
    return;  // a client that has gone already; reading will tell
  }
}

/// Its handlers own it, so that it outlives those still on their way.
class Connection final : public TcpConnection, public std::enable_shared_from_this<Connection> {
 public:
  explicit Connection(tcp::socket socket) : socket_{std::move(socket)} { tune(socket_); }

  void start(Events events, LinkStatistics& statistics) override {
    events_ = std::move(events);
    statistics_ = &statistics;
    read_on();
  }

  void read_on() override {
    if (!is_read() || is_reading_ || !events_.wants_bytes()) return;
    is_reading_ = true;
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
      self->is_reading_ = false;
      if (error || !self->is_read()) return;
      self->read_some();
      self->read_on();
    });
  }

  std::size_t read_some() override {
    std::array<std::byte, kReadTurn> buffer;
    error_code error;
    const auto size = socket_.read_some(boost::asio::buffer(buffer), error);
    if (size > 0) {
      statistics_->bytes_in += size;
      events_.on_bytes(Bytes{buffer}.first(size));
    } else if (error && error != boost::asio::error::would_block) {
      is_at_end_ = true;
      events_.on_end(error == boost::asio::error::eof ? End::kSending : End::kAll);
    }
    return size;
  }

  [[nodiscard]] bool has_ended() const override {
    pollfd entry{.fd = native_, .events = POLLRDHUP, .revents = 0};
    return ::poll(&entry, 1, 0) > 0;
  }

  void push(Bytes message) override { outbox_.push(message); }

  void flush() override {
    while (socket_.is_open() && !outbox_.is_empty()) {
      const auto bytes = outbox_.waiting();
      error_code error;
      const auto size = socket_.write_some(boost::asio::buffer(bytes.data(), bytes.size()), error);
      if (error == boost::asio::error::would_block) return flush_when_ready();
      if (error) return lose();
      statistics_->bytes_out += size;
      outbox_.pop(size);
    }
  }

  void close(Farewell farewell) override {
    outbox_.clear();
    error_code ignored;
    if (farewell == Farewell::kReset) {
      ignored = socket_.set_option(tcp::socket::linger{true, 0}, ignored);
    } else {
      ignored = socket_.shutdown(tcp::socket::shutdown_send, ignored);
    }
    ignored = socket_.close(ignored);
  }

  [[nodiscard]] std::uint64_t dropped() const noexcept override { return outbox_.dropped(); }

 private:
  [[nodiscard]] bool is_read() const { return socket_.is_open() && !is_at_end_; }

  void flush_when_ready() {
    if (std::exchange(is_waiting_to_write_, true)) return;
    socket_.async_wait(tcp::socket::wait_write, [self = shared_from_this()](error_code error) {
      self->is_waiting_to_write_ = false;
      if (!error) self->flush();
    });
  }

  /// Who writes is in the middle of something and hears of it later.
  void lose() {
    outbox_.clear();
    is_at_end_ = true;
    boost::asio::post(socket_.get_executor(), [self = shared_from_this()] {
      if (self->socket_.is_open()) self->events_.on_end(End::kAll);
    });
  }

  tcp::socket socket_;
  int native_ = socket_.native_handle();
  Events events_;
  LinkStatistics* statistics_ = nullptr;
  Outbox outbox_;
  bool is_at_end_ = false;
  bool is_reading_ = false;
  bool is_waiting_to_write_ = false;
};

class Listener final : public TcpListener {
 public:
  Listener(boost::asio::io_context& context, const tcp::endpoint& endpoint, ListenerEvents events)
      // Takes over the port of a run that just ended, but not that of one that still listens.
      : acceptor_{context, endpoint},
        endpoint_{acceptor_.local_endpoint()},
        pause_{context},
        events_{std::move(events)} {
    accept();
  }

  [[nodiscard]] std::string target() const override {
    const auto host = endpoint_.address().to_string();
    return endpoint_.address().is_v6() ? fmt::format("tcp:[{}]:{}", host, endpoint_.port())
                                       : fmt::format("tcp:{}:{}", host, endpoint_.port());
  }

  void set_listening(bool is_wanted) override {
    if (is_wanted == acceptor_.is_open()) return;
    error_code error;
    if (!is_wanted) {
      error = acceptor_.close(error);
      return;
    }
    error = acceptor_.open(endpoint_.protocol(), error);
    if (!error) error = acceptor_.set_option(tcp::acceptor::reuse_address{true}, error);
    if (!error) error = acceptor_.bind(endpoint_, error);
    if (!error) error = acceptor_.listen(tcp::acceptor::max_listen_connections, error);
    if (!error) return accept();
    complain("cannot listen again yet", error);
    error_code ignored;
    ignored = acceptor_.close(ignored);
  }

 private:
  void accept() {
    if (std::exchange(is_accepting_, true)) return;
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      is_accepting_ = false;
      if (!error) events_.on_client(std::make_shared<Connection>(std::move(socket)));
      if (error && acceptor_.is_open()) complain("cannot take clients", error);
      if (!acceptor_.is_open()) return;
      if (!error && events_.has_room()) return accept();
      pause_.expires_after(kAcceptPause);
      pause_.async_wait([this](const error_code& cancelled) {
        if (!cancelled && acceptor_.is_open()) accept();
      });
    });
  }

  void complain(std::string_view what, const error_code& error) {
    if (error == boost::asio::error::operation_aborted) return;
    if (std::exchange(complaint_, error) == error) return;
    events_.on_log(fmt::format("{}: {}; trying again", what, error.message()));
  }

  tcp::acceptor acceptor_;
  tcp::endpoint endpoint_;
  boost::asio::steady_timer pause_;
  ListenerEvents events_;
  error_code complaint_;  ///< the last one
  bool is_accepting_ = false;
};

tl::unexpected<Problem> problem_of(const TcpOptions& options, const error_code& error) {
  const auto where = fmt::format("tcp:{}:{}", options.address, options.port);
  const auto code =
      error.value() == EADDRNOTAVAIL ? ErrorCode::kNotFound : error_from_errno(error.value()).code;
  switch (code) {
    case ErrorCode::kBusy:
      return problem(code, where, "choose another port, or 0 for any that is free");
    case ErrorCode::kNoPermission:
      return problem(code, where, "ports below 1024 are for root; choose a higher one");
    case ErrorCode::kNotFound:
      return problem(code, where, "this machine does not have that address");
    default:
      return problem(code, where, error.message());
  }
}

}  // namespace

Outcome<std::unique_ptr<TcpListener>> listen_on_tcp(boost::asio::io_context& context,
                                                    const TcpOptions& options,
                                                    ListenerEvents events) {
  error_code error;
  const auto address = boost::asio::ip::make_address(options.address, error);
  if (error) {
    return problem(ErrorCode::kBadValue, options.address,
                   "an IPv4 or IPv6 address is needed, as in 127.0.0.1");
  }
  try {
    return std::make_unique<Listener>(context, tcp::endpoint{address, options.port},
                                      std::move(events));
  } catch (const boost::system::system_error& failure) {
    return problem_of(options, failure.code());
  }
}

}  // namespace armjig
