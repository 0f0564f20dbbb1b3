// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/session_host.hpp"

#include <fmt/core.h>

#include <utility>  // before Asio, which forgets it

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <map>

#include "emulators/host/outbox.hpp"
#include "emulators/host/paced_clock.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using boost::asio::ip::tcp;
using boost::system::error_code;
using Wall = PacedClock::Wall;

constexpr auto kKeepUp = 10ms;
constexpr auto kBudget = 50ms;
constexpr Duration kStride = 1s;
constexpr auto kShortWait = 50us;
constexpr auto kAcceptPause = 100ms;
constexpr std::size_t kTurn = 16384;
/// A client whose bytes the server leaves is not read any further.
constexpr std::size_t kMostUnread = std::size_t{16} * 1024;
/// More clients than that wait in the kernel's backlog.
constexpr std::size_t kMostClients = 16;

/// One connection. Its handlers own it, so that it outlives those still on their way.
struct Peer {
  explicit Peer(tcp::socket connected) : socket{std::move(connected)} {}

  tcp::socket socket;
  HostedServer::ConnectionId id{};
  Outbox outbox;
  bool has_ended = false;  ///< sends no more
  bool is_reading = false;
  bool is_waiting_to_write = false;
};
using PeerPointer = std::shared_ptr<Peer>;

}  // namespace

class SessionHost::Loop {
 public:
  Loop(std::unique_ptr<HostedServer> server, const SessionHostOptions& options,
       const tcp::endpoint& endpoint)
      : server_{std::move(server)},
        log_{options.log},
        clock_{options.speed, Wall::now()},
        timer_{context_},
        pause_{context_},
        signals_{context_},
        acceptor_{context_, endpoint},
        endpoint_{acceptor_.local_endpoint()} {
    if (options.on_signal == HostOptions::OnSignal::kStop) {
      signals_.add(SIGINT);
      signals_.add(SIGTERM);
      signals_.async_wait([this](const error_code& error, int) {
        if (!error) stop();
      });
    }
    // The server looks for its arm before it listens; nobody shall have to wait for that.
    while (!server_->is_listening() && server_->next_event() &&
           server_->next_event()->time_since_epoch() < kStride) {
      start_ = *server_->next_event();
      server_->advance_to(start_);
    }
    reached_ = start_;
    accept();
    pump();
  }

  void run() { context_.run(); }
  void stop() { context_.stop(); }

  void set_input(std::string name, std::int64_t value, std::function<void(bool is_taken)> tell) {
    boost::asio::post(context_, [this, name = std::move(name), value, tell = std::move(tell)] {
      catch_up();
      tell(server_->set_input(reached_, name, value));
      pump();
    });
  }

  [[nodiscard]] std::string target() const {
    const auto host = endpoint_.address().to_string();
    return endpoint_.address().is_v6() ? fmt::format("tcp:[{}]:{}", host, endpoint_.port())
                                       : fmt::format("tcp:{}:{}", host, endpoint_.port());
  }

  [[nodiscard]] HostStatistics statistics() const {
    auto links = statistics_;
    for (const auto& [id, peer] : peers_) links.frames_dropped += peer->outbox.dropped();
    return {.links = links, .lost = clock_.lost()};
  }

 private:
  void accept() {
    if (std::exchange(is_accepting_, true)) return;
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      is_accepting_ = false;
      if (!error) admit(std::move(socket));
      if (!acceptor_.is_open()) return;
      if (!error && peers_.size() < kMostClients) return accept();
      pause_.expires_after(kAcceptPause);
      pause_.async_wait([this](const error_code& cancelled) {
        if (!cancelled && acceptor_.is_open()) accept();
      });
    });
  }

  void admit(tcp::socket socket) {
    catch_up();
    const auto id = server_->connect(reached_);
    if (!id) {
      ++statistics_.refused;
      return;
    }
    error_code ignored;
    ignored = socket.non_blocking(true, ignored);
    ignored = socket.set_option(tcp::no_delay{true}, ignored);
    ++statistics_.clients;
    const auto peer = std::make_shared<Peer>(std::move(socket));
    peer->id = *id;
    peers_[*id] = peer;
    read_when_ready(peer);
    pump();
  }

  void read_when_ready(const PeerPointer& peer) {
    if (peer->has_ended || server_->unread(peer->id) >= kMostUnread) return;
    if (std::exchange(peer->is_reading, true)) return;
    peer->socket.async_wait(tcp::socket::wait_read, [this, peer](const error_code& error) {
      peer->is_reading = false;
      if (error || !is_known(peer)) return;
      catch_up();
      read_some(peer);
      pump();
      if (is_known(peer)) read_when_ready(peer);
    });
  }

  [[nodiscard]] bool is_known(const PeerPointer& peer) const {
    const auto found = peers_.find(peer->id);
    return found != peers_.end() && found->second == peer;
  }

  void read_some(const PeerPointer& peer) {
    std::array<std::byte, kTurn> buffer;
    error_code error;
    const auto size = peer->socket.read_some(boost::asio::buffer(buffer), error);
    if (size > 0) {
      statistics_.bytes_in += size;
      server_->receive(reached_, peer->id, Bytes{buffer}.first(size));
    } else if (error == boost::asio::error::eof) {
      peer->has_ended = true;
      server_->half_close(reached_, peer->id);
    } else if (error && error != boost::asio::error::would_block) {
      peer->has_ended = true;
      server_->reset(reached_, peer->id);
    }
  }

  /// Lets the server do what is due, forwards what it sends, and sees to it that this happens
  /// again.
  void pump() {
    catch_up();
    server_->advance_to(reached_);
    forward();
    follow_listening();
    const auto now = Wall::now();
    const auto next = server_->next_event();
    const auto due =
        next ? std::min(clock_.wall_time(at(*next - start_), now), now + kKeepUp) : now + kKeepUp;
    if (due - now < kShortWait) return pump_soon();
    timer_.expires_at(due);
    timer_.async_wait([this](const error_code& error) {
      if (!error) pump();
    });
  }

  void pump_soon() {
    if (std::exchange(is_pump_posted_, true)) return;
    boost::asio::post(context_, [this] {
      is_pump_posted_ = false;
      pump();
    });
  }

  void catch_up() {
    const auto start = Wall::now();
    const auto present = start_ + clock_.virtual_time(start).time_since_epoch();
    while (reached_ < present) {
      reached_ = std::min(present, reached_ + kStride);
      server_->advance_to(reached_);
      if (reached_ < present && Wall::now() - start > kBudget) {
        clock_.lose(present - reached_);
        return;
      }
    }
  }

  void forward() {
    PeerPointer peer;  // of the event before: mostly there is only one
    for (const auto& event : server_->sent()) {
      if (!peer || peer->id != event.connection) {
        if (peer) write_waiting(peer);
        const auto found = peers_.find(event.connection);
        peer = found == peers_.end() ? nullptr : found->second;
      }
      if (!peer) continue;
      if (event.kind == SessionEvent::Kind::kData) {
        peer->outbox.push(event.bytes);
      } else {
        write_waiting(peer);
        end(peer, event.kind);
        peer.reset();
      }
    }
    server_->clear_sent();
    if (peer) write_waiting(peer);
    for (const auto& line : server_->take_log()) log_(line);
    // Whose bytes the server has read meanwhile may send on.
    for (const auto& [id, each] : peers_) read_when_ready(each);
  }

  void end(const PeerPointer& peer, SessionEvent::Kind kind) {
    error_code ignored;
    if (kind == SessionEvent::Kind::kReset) {
      ignored = peer->socket.set_option(boost::asio::socket_base::linger{true, 0}, ignored);
    } else {
      ignored = peer->socket.shutdown(tcp::socket::shutdown_send, ignored);
    }
    ignored = peer->socket.close(ignored);
    statistics_.frames_dropped += peer->outbox.dropped();
    peers_.erase(peer->id);
  }

  void write_waiting(const PeerPointer& peer) {
    if (!is_known(peer)) return;
    auto& outbox = peer->outbox;
    while (!outbox.is_empty()) {
      const auto bytes = outbox.waiting();
      error_code error;
      const auto size =
          peer->socket.write_some(boost::asio::buffer(bytes.data(), bytes.size()), error);
      if (error == boost::asio::error::would_block) return write_when_ready(peer);
      if (error) {
        outbox.clear();
        peer->has_ended = true;
        return server_->reset(reached_, peer->id);
      }
      statistics_.bytes_out += size;
      outbox.pop(size);
    }
  }

  void write_when_ready(const PeerPointer& peer) {
    if (std::exchange(peer->is_waiting_to_write, true)) return;
    peer->socket.async_wait(tcp::socket::wait_write, [this, peer](const error_code& error) {
      peer->is_waiting_to_write = false;
      if (!error) write_waiting(peer);
    });
  }

  /// A server that is dead refuses connections, and one that has come back takes them again.
  void follow_listening() {
    if (server_->is_listening() == acceptor_.is_open()) return;
    error_code error;
    if (acceptor_.is_open()) {
      error = acceptor_.close(error);
      return;
    }
    error = acceptor_.open(endpoint_.protocol(), error);
    error = acceptor_.set_option(tcp::acceptor::reuse_address{true}, error);
    error = acceptor_.bind(endpoint_, error);
    if (!error) error = acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
    if (!error) return accept();
    log_(fmt::format("cannot listen again yet: {}", error.message()));
    error = acceptor_.close(error);
  }

  boost::asio::io_context context_{1};
  std::unique_ptr<HostedServer> server_;
  std::function<void(std::string_view line)> log_;
  PacedClock clock_;
  Instant start_{};  ///< the server's time when the clock was 0
  Instant reached_{};
  boost::asio::steady_timer timer_;
  boost::asio::steady_timer pause_;
  boost::asio::signal_set signals_;
  tcp::acceptor acceptor_;
  tcp::endpoint endpoint_;
  std::map<HostedServer::ConnectionId, PeerPointer> peers_;
  LinkStatistics statistics_;
  bool is_accepting_ = false;
  bool is_pump_posted_ = false;
};

SessionHost::SessionHost(std::unique_ptr<Loop> loop) noexcept : loop_{std::move(loop)} {}
SessionHost::SessionHost(SessionHost&& other) noexcept = default;
SessionHost& SessionHost::operator=(SessionHost&& other) noexcept = default;
SessionHost::~SessionHost() = default;

Outcome<SessionHost> SessionHost::open(std::unique_ptr<HostedServer> server,
                                       const SessionHostOptions& options) {
  const auto where = fmt::format("tcp:{}:{}", options.tcp.address, options.tcp.port);
  if (!PacedClock::is_speed(options.speed)) {
    return problem(ErrorCode::kBadValue, "speed",
                   "it is a factor from 0.001 to 10000; 1 is real time");
  }
  error_code error;
  const auto address = boost::asio::ip::make_address(options.tcp.address, error);
  if (error) {
    return problem(ErrorCode::kBadValue, options.tcp.address,
                   "an IPv4 or IPv6 address is needed, as in 127.0.0.1");
  }
  try {
    return SessionHost{std::make_unique<Loop>(std::move(server), options,
                                              tcp::endpoint{address, options.tcp.port})};
  } catch (const boost::system::system_error& failure) {
    const auto code = error_from_errno(failure.code().value()).code;
    const auto* const hint = code == ErrorCode::kBusy
                                 ? "choose another port, or 0 for any that is free"
                                 : "choose another address or port";
    return problem(code, where, hint);
  }
}

std::string SessionHost::target() const { return loop_->target(); }
void SessionHost::run() { loop_->run(); }
void SessionHost::stop() { loop_->stop(); }
void SessionHost::set_input(std::string name, std::int64_t value,
                            std::function<void(bool is_taken)> tell) {
  loop_->set_input(std::move(name), value, std::move(tell));
}
HostStatistics SessionHost::statistics() const { return loop_->statistics(); }

}  // namespace armjig
