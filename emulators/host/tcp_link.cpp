// SPDX-License-Identifier: Apache-2.0
#include <utility>  // before Asio, which forgets it

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <optional>
#include <variant>

#include "emulators/host/client_link.hpp"
#include "emulators/host/outbox.hpp"
#include "emulators/host/tcp_listener.hpp"
#include "harness/wire/telnet/com_port.hpp"

namespace armjig {
namespace {

/// For answers to a client that has ended its sending.
constexpr auto kLinger = std::chrono::seconds{1};

/// What one client has said and not said yet, where the link speaks RFC 2217.
struct TelnetClient {
  telnet::Decoder decoder;
  telnet::ComPortServer port;
  Outbox held;  ///< messages for a client that has suspended them
};

class TcpLink final : public ClientLink {
 public:
  TcpLink(boost::asio::io_context& context, TcpOptions::Protocol protocol, LinkEvents events)
      : protocol_{protocol}, linger_{context}, events_{std::move(events)} {}

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
    if (!telnet_) return pass(message);
    std::vector<std::byte> escaped;
    telnet::escape(message,
                   [&](Bytes piece) { escaped.insert(escaped.end(), piece.begin(), piece.end()); });
    telnet_->port.is_suspended() ? telnet_->held.push(escaped) : pass(escaped);
  }
  void read_on() override {
    if (client_) client_->read_on();
  }

  [[nodiscard]] std::vector<std::string> targets() const override {
    auto target = listener_->target();
    if (protocol_ == TcpOptions::Protocol::kRfc2217) target.replace(0, 3, "rfc2217");
    return {std::move(target)};
  }

  [[nodiscard]] LinkStatistics statistics() const override {
    auto statistics = statistics_;
    if (client_) statistics.frames_dropped += client_->dropped();
    if (telnet_) statistics.frames_dropped += telnet_->held.dropped();
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
                    .on_bytes = [this](Bytes bytes) { receive(bytes); },
                    .on_end = [this](TcpConnection::End end) { on_end(end); }},
                   statistics_);
    if (protocol_ == TcpOptions::Protocol::kPlain) return;
    telnet_.emplace();
    pass(telnet_->port.begin());
  }

  /// Hands over what is as it goes over the connection.
  void pass(Bytes bytes) {
    if (bytes.empty()) return;
    client_->push(bytes);
    client_->flush();
  }

  void receive(Bytes bytes) {
    if (!telnet_) return events_.on_bytes(*this, bytes);
    while (telnet_ && !bytes.empty()) {
      const auto step = telnet_->decoder.step(bytes);
      bytes = bytes.subspan(step.used);
      if (const auto* data = std::get_if<telnet::Data>(&step.found)) {
        events_.on_bytes(*this, data->bytes);
      } else if (const auto* negotiation = std::get_if<telnet::Negotiation>(&step.found)) {
        pass(telnet_->port.on(*negotiation));
      } else if (const auto* request = std::get_if<telnet::Subnegotiation>(&step.found)) {
        pass(telnet_->port.on(*request));
        if (!telnet_->port.is_suspended()) release();
      }
    }
  }

  /// What was held back goes.
  void release() {
    pass(telnet_->held.waiting());
    telnet_->held.pop(telnet_->held.waiting().size());
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
    if (!telnet_) return;
    telnet_->held.clear();
    statistics_.frames_dropped += telnet_->held.dropped();
    telnet_.reset();
  }

  TcpOptions::Protocol protocol_;
  boost::asio::steady_timer linger_;
  LinkEvents events_;
  std::unique_ptr<TcpListener> listener_;
  std::shared_ptr<TcpConnection> client_;
  std::optional<TelnetClient> telnet_;  ///< with `client_`, if the link speaks it
  bool is_at_end_ = false;              ///< the client sends no more
  LinkStatistics statistics_;
};

}  // namespace

Outcome<std::unique_ptr<ClientLink>> open_tcp_link(boost::asio::io_context& context,
                                                   const TcpOptions& options, LinkEvents events) {
  auto link = std::make_unique<TcpLink>(context, options.protocol, std::move(events));
  if (auto listening = link->listen(context, options); !listening) {
    return tl::unexpected{listening.error()};
  }
  return link;
}

}  // namespace armjig
