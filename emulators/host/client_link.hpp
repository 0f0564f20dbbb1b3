// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"

namespace boost::asio {
class io_context;  // NOLINT(readability-identifier-naming): theirs
}

/// How bytes of clients reach a hosted device. Everything here runs on the thread of one
/// io_context.
namespace armjig {

/// What passed over one link, or all of them.
struct LinkStatistics {
  std::uint64_t clients = 0;         ///< came, one after the other
  std::uint64_t refused = 0;         ///< came while another one was there
  std::uint64_t bytes_in = 0;        ///< from clients
  std::uint64_t bytes_out = 0;       ///< to clients
  std::uint64_t frames_dropped = 0;  ///< because no client was there or it did not read

  LinkStatistics& operator+=(const LinkStatistics& other) noexcept {
    clients += other.clients;
    refused += other.refused;
    bytes_in += other.bytes_in;
    bytes_out += other.bytes_out;
    frames_dropped += other.frames_dropped;
    return *this;
  }
  friend bool operator==(const LinkStatistics&, const LinkStatistics&) = default;
};

/// So much is read before others have their turn.
inline constexpr std::size_t kReadTurn = 16'384;

/// A place where one client at a time finds the device. Never waits for a client.
class ClientLink {
 public:
  ClientLink() = default;
  ClientLink(const ClientLink&) = delete;
  ClientLink& operator=(const ClientLink&) = delete;
  virtual ~ClientLink() = default;

  /// Hands a whole message to the client, now or when it reads again, or drops it.
  virtual void send(Bytes message) = 0;
  /// Goes on reading, after `LinkEvents::wants_bytes` has said no.
  virtual void read_on() = 0;

  /// The places as `--target` takes them, the stable one last.
  [[nodiscard]] virtual std::vector<std::string> targets() const = 0;
  [[nodiscard]] virtual LinkStatistics statistics() const = 0;
};

/// What a link tells and asks. The bytes are valid during the call.
struct LinkEvents {
  std::function<void(ClientLink& from, Bytes bytes)> on_bytes;
  std::function<bool()> wants_bytes;
  std::function<void(std::string_view line)> on_log;
};

struct PtyOptions {
  std::string link;  ///< path of a stable symbolic link (see `StableLink`); empty for none
};

/// Listens on a new pseudo-terminal. Clients follow each other; two at once cannot be told apart.
/// Problems: those of `PseudoTerminal` and `StableLink`.
[[nodiscard]] Outcome<std::unique_ptr<ClientLink>> open_pty_link(boost::asio::io_context& context,
                                                                 const PtyOptions& options,
                                                                 LinkEvents events);

struct TcpOptions {
  std::string address = "127.0.0.1";  ///< to listen on, IPv4 or IPv6
  std::uint16_t port = 0;             ///< 0: any that is free
  enum class Protocol : std::uint8_t { kPlain, kRfc2217 };
  Protocol protocol = Protocol::kPlain;  ///< of a byte stream
};

/// Listens on TCP for one client at a time; a second one is closed at once. A client that only
/// ended its sending still gets answers for a second, if no other comes. With `kRfc2217` a client
/// also gets a serial port to set (`telnet::ComPortServer`), which changes nothing for the device.
/// Problems: those of `listen_on_tcp`.
[[nodiscard]] Outcome<std::unique_ptr<ClientLink>> open_tcp_link(boost::asio::io_context& context,
                                                                 const TcpOptions& options,
                                                                 LinkEvents events);

}  // namespace armjig
