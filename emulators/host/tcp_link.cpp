// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <netinet/tcp.h>
#include <poll.h>

#include <utility>  // before Asio, which forgets it

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "emulators/host/client_link.hpp"
#include "emulators/host/outbox.hpp"

namespace armjig {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

/// For answers to a client that has ended its sending.
constexpr auto kLinger = std::chrono::seconds{1};
/// When accepting fails, for want of descriptors perhaps.
constexpr auto kAcceptPause = std::chrono::milliseconds{100};

using KeepAliveIdle = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPIDLE>;
using KeepAliveInterval = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPINTVL>;
using KeepAliveCount = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPCNT>;

/// A client whose machine vanished is noticed after half a minute.
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

/// One connection. Its handlers own it, so that it outlives those still on their way.
struct Client {
  explicit Client(tcp::socket connected)
      : socket{std::move(connected)}, linger{socket.get_executor()} {}

  tcp::socket socket;
  boost::asio::steady_timer linger;
  Outbox outbox;
  bool is_at_end = false;  ///< sends no more
  bool is_waiting_to_write = false;
};

class TcpLink final : public ClientLink {
 public:
  TcpLink(boost::asio::io_context& context, tcp::acceptor acceptor, LinkEvents events)
      : acceptor_{std::move(acceptor)}, pause_{context}, events_{std::move(events)} {
    accept();
  }

  void send(Bytes message) override {
    if (!client_) {
      ++statistics_.frames_dropped;
      return;
    }
    const auto client = client_;
    client->outbox.push(message);
    write_waiting(client);
  }

  [[nodiscard]] std::vector<std::string> targets() const override {
    error_code error;
    const auto endpoint = acceptor_.local_endpoint(error);
    const auto host = endpoint.address().to_string();
    return {fmt::format(fmt::runtime(endpoint.address().is_v6() ? "tcp:[{}]:{}" : "tcp:{}:{}"),
                        host, endpoint.port())};
  }

  [[nodiscard]] LinkStatistics statistics() const override {
    auto statistics = statistics_;
    if (client_) statistics.frames_dropped += client_->outbox.dropped();
    return statistics;
  }

 private:
  using ClientPointer = std::shared_ptr<Client>;

  void accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (error) return accept_later();
      admit(std::move(socket));
      accept();
    });
  }

  void accept_later() {
    pause_.expires_after(kAcceptPause);
    pause_.async_wait([this](const error_code& error) {
      if (!error) accept();
    });
  }

  void admit(tcp::socket socket) {
    const auto former = client_;
    if (former) hear_out(former);
    if (client_ && !client_->is_at_end) {
      ++statistics_.refused;
      events_.on_log("a second client was refused: one is connected already");
      return;
    }
    if (client_) drop(former);
    ++statistics_.clients;
    tune(socket);
    client_ = std::make_shared<Client>(std::move(socket));
    read_when_ready(client_);
  }

  /// Reads what the client sent before another one came; it may turn out to be gone. One that is
  /// gone is read to its end, any other only for some turns.
  void hear_out(const ClientPointer& client) {
    int turns = 16;
    while (client_ == client && !client->is_at_end) {
      if (!has_ended(client->socket) && turns-- == 0) return;
      if (read_some(client) == 0) return;
    }
  }

  /// Whether the client sends no more, though it may have sent what is not read yet.
  static bool has_ended(tcp::socket& socket) {
    pollfd entry{.fd = socket.native_handle(), .events = POLLRDHUP, .revents = 0};
    return ::poll(&entry, 1, 0) > 0;
  }

  void read_when_ready(const ClientPointer& client) {
    client->socket.async_wait(tcp::socket::wait_read, [this, client](const error_code& error) {
      if (error || client_ != client || client->is_at_end) return;
      read_some(client);
      if (client_ == client && !client->is_at_end) read_when_ready(client);
    });
  }

  /// 0: nothing more has come, or this was the end.
  std::size_t read_some(const ClientPointer& client) {
    std::array<std::byte, kTurn> buffer;
    error_code error;
    const auto size = client->socket.read_some(boost::asio::buffer(buffer), error);
    if (size > 0) {
      statistics_.bytes_in += size;
      events_.on_bytes(*this, Bytes{buffer}.first(size));
    } else if (error == boost::asio::error::eof) {
      end(client);
    } else if (error && error != boost::asio::error::would_block) {
      drop(client);
    }
    return size;
  }

  void end(const ClientPointer& client) {
    client->is_at_end = true;
    client->linger.expires_after(kLinger);
    client->linger.async_wait([this, client](const error_code& /*cancelled*/) {
      if (client_ == client) drop(client);
    });
  }

  /// `client` must not be `client_` itself, which is forgotten here.
  void drop(const ClientPointer& client) {
    client->outbox.clear();
    statistics_.frames_dropped += client->outbox.dropped();
    error_code ignored;
    ignored = client->socket.close(ignored);
    client->linger.cancel();
    client_.reset();
  }

  void write_waiting(const ClientPointer& client) {
    auto& outbox = client->outbox;
    while (!outbox.is_empty()) {
      const auto bytes = outbox.waiting();
      error_code error;
      const auto size =
          client->socket.write_some(boost::asio::buffer(bytes.data(), bytes.size()), error);
      if (error == boost::asio::error::would_block) return write_when_ready(client);
      if (error) return drop(client);
      statistics_.bytes_out += size;
      outbox.pop(size);
    }
  }

  void write_when_ready(const ClientPointer& client) {
    if (std::exchange(client->is_waiting_to_write, true)) return;
    client->socket.async_wait(tcp::socket::wait_write, [this, client](const error_code& error) {
      client->is_waiting_to_write = false;
      if (!error && client_ == client) write_waiting(client);
    });
  }

  tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  LinkEvents events_;
  ClientPointer client_;
  LinkStatistics statistics_;
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

Outcome<std::unique_ptr<ClientLink>> open_tcp_link(boost::asio::io_context& context,
                                                   const TcpOptions& options, LinkEvents events) {
  error_code error;
  const auto address = boost::asio::ip::make_address(options.address, error);
  if (error) {
    return problem(ErrorCode::kBadValue, options.address,
                   "an IPv4 or IPv6 address is needed, as in 127.0.0.1");
  }
  try {
    // Takes over the port of a run that just ended, but not that of one that still listens.
    tcp::acceptor acceptor{context, tcp::endpoint{address, options.port}};
    return std::make_unique<TcpLink>(context, std::move(acceptor), std::move(events));
  } catch (const boost::system::system_error& failure) {
    return problem_of(options, failure.code());
  }
}

}  // namespace armjig
