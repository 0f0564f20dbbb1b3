// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "emulators/host/client_link.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"

/// What is made of TCP sockets. Everything here runs on the thread of one io_context.
namespace armjig {

/// A client on TCP. What it does not read waits here, up to a limit (`Outbox`). One whose machine
/// has vanished is noticed after half a minute. Closes with its last owner.
class TcpConnection {
 public:
  enum class End : std::uint8_t {
    kSending,  ///< the client sends no more
    kAll,      ///< it has reset the connection, or that broke
  };
  /// What it tells and asks, never from inside `push` and `flush`, and nothing after `close`.
  struct Events {
    std::function<bool()> wants_bytes;  ///< no: they stay in the kernel
    std::function<void(Bytes bytes)> on_bytes;
    std::function<void(End end)> on_end;
  };

  TcpConnection() = default;
  TcpConnection(const TcpConnection&) = delete;
  TcpConnection& operator=(const TcpConnection&) = delete;
  virtual ~TcpConnection() = default;

  /// From now on the client is read. `statistics` has to live until `close`.
  virtual void start(Events events, LinkStatistics& statistics) = 0;
  /// Goes on reading, after `wants_bytes` has said no.
  virtual void read_on() = 0;
  /// Reads what has come, a turn at most. 0: nothing more has come, or this was the end.
  virtual std::size_t read_some() = 0;
  /// Whether the client sends no more, though it may have sent what is not read yet.
  [[nodiscard]] virtual bool has_ended() const = 0;

  /// Queues a whole message, or drops it. Requires that it is not empty.
  virtual void push(Bytes message) = 0;
  /// Writes what the client takes now; the rest follows when it reads.
  virtual void flush() = 0;

  enum class Farewell : std::uint8_t { kEnd, kReset };
  /// What still waits is dropped.
  virtual void close(Farewell farewell) = 0;
  /// Messages so far.
  [[nodiscard]] virtual std::uint64_t dropped() const noexcept = 0;
};

struct ListenerEvents {
  std::function<void(std::shared_ptr<TcpConnection> client)> on_client;
  std::function<bool()> has_room;  ///< no: who comes waits in the kernel
  std::function<void(std::string_view line)> on_log;
};

/// Takes connections. That it cannot, for want of descriptors perhaps, is said once in the log; it
/// tries again and again.
class TcpListener {
 public:
  TcpListener() = default;
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;
  virtual ~TcpListener() = default;

  /// As `--target` takes it.
  [[nodiscard]] virtual std::string target() const = 0;
  /// No: connections are refused until it is so again. That this cannot be is said in the log.
  virtual void set_listening(bool is_wanted) = 0;
};

/// Problems: `kBadValue` (not an address), `kBusy`, `kNoPermission`, `kNotFound` (not an address of
/// this machine), `kSystem`.
[[nodiscard]] Outcome<std::unique_ptr<TcpListener>> listen_on_tcp(boost::asio::io_context& context,
                                                                  const TcpOptions& options,
                                                                  ListenerEvents events);

}  // namespace armjig
