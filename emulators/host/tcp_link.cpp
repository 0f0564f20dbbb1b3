// SPDX-License-Identifier: Apache-2.0
#include <utility>  // before Asio, which forgets it

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "emulators/host/client_link.hpp"
#include "emulators/host/tcp_listener.hpp"

namespace armjig {
namespace {

/// For answers to a client that has ended its sending.
constexpr auto kLinger = std::chrono::seconds{1};

class TcpLink final : public ClientLink {
 public:
  TcpLink(boost::asio::io_context& context, LinkEvents events)
      : linger_{context}, events_{std::move(events)} {}

  [[nodiscard]] Outcome<void> listen(boost::asio::io_context& context, const TcpOptions& options) {
    return listen_on_tcp(
               context, options,
               {.on_client =
                    [this](std::shared_ptr<TcpConnection> client) { admit(std::move(client)); },
                .has_room = [] { return true; },
                .on_log = events_.on_log})
        .map([this](auto listener) { listener_ = std::move(listener); });
  }

  void send(Bytes message) override {
    if (!client_) {
      ++statistics_.frames_dropped;
      return;
    }
    client_->push(message);
    client_->flush();
  }
  void read_on() override {
    if (client_) client_->read_on();
  }

  [[nodiscard]] std::vector<std::string> targets() const override { return {listener_->target()}; }

  [[nodiscard]] LinkStatistics statistics() const override {
    auto statistics = statistics_;
    if (client_) statistics.frames_dropped += client_->dropped();
    return statistics;
  }

 private:
  void admit(std::shared_ptr<TcpConnection> client) {
    hear_out();
    if (client_ && !is_at_end_) {
      ++statistics_.refused;
      events_.on_log("a second client was refused: one is connected already");
      return;
    }
    drop();
    ++statistics_.clients;
    client_ = std::move(client);
    is_at_end_ = false;
    client_->start({.wants_bytes = events_.wants_bytes,
                    .on_bytes = [this](Bytes bytes) { events_.on_bytes(*this, bytes); },
                    .on_end = [this](TcpConnection::End end) { on_end(end); }},
                   statistics_);
  }

  /// Reads what the client sent before another one came; it may turn out to be gone. One that is
  /// gone is read to its end, any other only for some turns.
  void hear_out() {
    const auto client = client_;
    int turns = 16;
    while (client && client_ == client && !is_at_end_) {
      if (!client->has_ended() && turns-- == 0) return;
      if (client->read_some() == 0) return;
    }
  }

  void on_end(TcpConnection::End end) {
    if (end == TcpConnection::End::kAll) return drop();
    is_at_end_ = true;
    linger_.expires_after(kLinger);
    linger_.async_wait([this](const boost::system::error_code& cancelled) {
      if (!cancelled) drop();
    });
  }

  void drop() {
    if (!client_) return;
    client_->close(TcpConnection::Farewell::kEnd);
    statistics_.frames_dropped += client_->dropped();
    linger_.cancel();
    client_.reset();
  }

  boost::asio::steady_timer linger_;
  LinkEvents events_;
  std::unique_ptr<TcpListener> listener_;
  std::shared_ptr<TcpConnection> client_;
  bool is_at_end_ = false;  ///< the client sends no more
  LinkStatistics statistics_;
};

}  // namespace

Outcome<std::unique_ptr<ClientLink>> open_tcp_link(boost::asio::io_context& context,
                                                   const TcpOptions& options, LinkEvents events) {
  auto link = std::make_unique<TcpLink>(context, std::move(events));
  if (auto listening = link->listen(context, options); !listening) {
    return tl::unexpected{listening.error()};
  }
  return link;
}

}  // namespace armjig
