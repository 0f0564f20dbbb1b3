// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): POSIX, posix_openpt
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <utility>

#include "harness/link/descriptor.hpp"

/// Plain files of links, for tests and for what others are measured against.
namespace armjig::test {

/// The two files of a link.
struct LinkEnds {
  Descriptor near;  ///< never blocks
  Descriptor far;
};

inline LinkEnds make_socket_ends() {
  std::array<int, 2> ends{};
  (void)::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data());
  return {Descriptor{ends[0]}, Descriptor{ends[1]}};
}

/// A raw pseudo-terminal and its master.
inline LinkEnds make_terminal_ends() {
  Descriptor master{::posix_openpt(O_RDWR | O_NOCTTY)};
  (void)::grantpt(master.value());
  (void)::unlockpt(master.value());
  Descriptor slave{::open(::ptsname(master.value()), O_RDWR | O_NOCTTY | O_NONBLOCK)};
  termios settings{};
  ::tcgetattr(slave.value(), &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(slave.value(), TCSANOW, &settings);
  return {std::move(slave), std::move(master)};
}

/// Writes at once what is written.
inline void send_without_delay(const Descriptor& socket) {
  const int yes = 1;
  (void)::setsockopt(socket.value(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

/// A socket that listens on a free port of this machine.
struct ListeningSocket {
  Descriptor socket{::socket(AF_INET, SOCK_STREAM, 0)};
  sockaddr_in address{};

  ListeningSocket() {
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    (void)::bind(socket.value(), any(), size);
    (void)::listen(socket.value(), 1);
    (void)::getsockname(socket.value(), any(), &size);
  }
  [[nodiscard]] std::uint16_t port() const noexcept { return ntohs(address.sin_port); }
  [[nodiscard]] Descriptor accept() const {
    Descriptor peer{::accept(socket.value(), nullptr, nullptr)};
    send_without_delay(peer);
    return peer;
  }
  sockaddr* any() noexcept { return reinterpret_cast<sockaddr*>(&address); }
};

inline LinkEnds make_tcp_ends() {
  ListeningSocket listener;
  LinkEnds ends{Descriptor{::socket(AF_INET, SOCK_STREAM, 0)}, Descriptor{}};
  (void)::connect(ends.near.value(), listener.any(), sizeof listener.address);
  ends.far = listener.accept();
  (void)::fcntl(ends.near.value(), F_SETFL, O_NONBLOCK);
  send_without_delay(ends.near);
  return ends;
}

}  // namespace armjig::test
