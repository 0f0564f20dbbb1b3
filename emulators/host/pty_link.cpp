// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <unistd.h>

#include <utility>  // before Asio, which forgets it

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>

#include "emulators/host/client_link.hpp"
#include "emulators/host/outbox.hpp"
#include "emulators/host/pseudo_terminal.hpp"
#include "emulators/host/stable_link.hpp"

namespace armjig {
namespace {

using boost::asio::posix::stream_descriptor;
using boost::system::error_code;

/// While no client is there the master is always "ready", with an error; so it is looked at in this
/// interval instead.
constexpr auto kLookInterval = std::chrono::milliseconds{2};

class PtyLink final : public ClientLink {
 public:
  PtyLink(boost::asio::io_context& context, PseudoTerminal terminal, StableLink link,
          LinkEvents events)
      : terminal_{std::move(terminal)},
        link_{std::move(link)},
        events_{std::move(events)},
        ready_{context, terminal_.master().value()},
        timer_{context} {
    look_again();
  }
  ~PtyLink() override { ready_.release(); }  // `terminal_` closes it

  void send(Bytes message) override {
    if (!is_client_there_) {
      ++dropped_;
      return;
    }
    outbox_.push(message);
    write_waiting();
  }

  void read_on() override {
    if (!is_client_there_ || is_reading_ || !events_.wants_bytes()) return;
    is_reading_ = true;
    ready_.async_wait(stream_descriptor::wait_read, [this](const error_code& error) {
      is_reading_ = false;
      if (!error) read_turn();
    });
  }

  [[nodiscard]] std::vector<std::string> targets() const override {
    std::vector targets{"pty:" + terminal_.path()};
    if (!link_.path().empty()) targets.push_back("pty:" + link_.path());
    return targets;
  }

  [[nodiscard]] LinkStatistics statistics() const override {
    auto statistics = statistics_;
    statistics.frames_dropped = dropped_ + outbox_.dropped();
    return statistics;
  }

 private:
  void look_again() {
    timer_.expires_after(kLookInterval);
    timer_.async_wait([this](const error_code& error) {
      if (!error) look_for_client();
    });
  }

  void look_for_client() {
    pollfd entry{.fd = terminal_.master().value(), .events = POLLIN, .revents = 0};
    ::poll(&entry, 1, 0);
    // One that came, wrote and went in the meantime has left its bytes.
    const bool is_there = (entry.revents & POLLHUP) == 0 || (entry.revents & POLLIN) != 0;
    if (!is_there) return look_again();
    is_client_there_ = true;
    ++statistics_.clients;
    read_on();
  }

  void read_turn() {
    std::array<std::byte, kReadTurn> buffer;
    const auto size = ::read(terminal_.master().value(), buffer.data(), buffer.size());
    if (size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR)) return forget_client();
    if (size > 0) {
      const auto bytes = Bytes{buffer}.first(static_cast<std::size_t>(size));
      statistics_.bytes_in += bytes.size();
      events_.on_bytes(*this, bytes);
    }
    read_on();
  }

  /// Before anything is read from the next client, so it cannot lose an answer.
  void forget_client() {
    is_client_there_ = false;
    outbox_.clear();
    terminal_.reset();
    look_again();
  }

  void write_waiting() {
    while (!outbox_.is_empty()) {
      const auto bytes = outbox_.waiting();
      const auto size = ::write(terminal_.master().value(), bytes.data(), bytes.size());
      if (size <= 0) return write_when_ready();  // also if it has gone: reading will tell
      statistics_.bytes_out += static_cast<std::uint64_t>(size);
      outbox_.pop(static_cast<std::size_t>(size));
    }
  }

  void write_when_ready() {
    if (std::exchange(is_waiting_to_write_, true)) return;
    ready_.async_wait(stream_descriptor::wait_write, [this](const error_code& error) {
      is_waiting_to_write_ = false;
      if (!error) write_waiting();
    });
  }

  PseudoTerminal terminal_;
  StableLink link_;
  LinkEvents events_;
  stream_descriptor ready_;
  boost::asio::steady_timer timer_;
  Outbox outbox_;
  bool is_client_there_ = false;
  bool is_reading_ = false;
  bool is_waiting_to_write_ = false;
  std::uint64_t dropped_ = 0;  ///< beside the outbox
  LinkStatistics statistics_;
};

}  // namespace

Outcome<std::unique_ptr<ClientLink>> open_pty_link(boost::asio::io_context& context,
                                                   const PtyOptions& options, LinkEvents events) {
  auto terminal = PseudoTerminal::open();
  if (!terminal) return tl::unexpected{terminal.error()};
  StableLink link;
  if (!options.link.empty()) {
    auto created = StableLink::create(options.link, terminal->path());
    if (!created) return tl::unexpected{created.error()};
    link = std::move(*created);
  }
  return std::make_unique<PtyLink>(context, std::move(*terminal), std::move(link),
                                   std::move(events));
}

}  // namespace armjig
