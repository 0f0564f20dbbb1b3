// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/support/sockets.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <bit>
#include <stdexcept>

namespace armjig::testing {
namespace {

void require(bool is_true, const char* what) {
  if (!is_true) throw std::runtime_error{what};
}

}  // namespace

Listener::Listener(int backlog) : socket_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* const any = std::bit_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  require(socket_.is_open(), "socket");
  require(::bind(socket_.value(), any, size) == 0, "bind");
  require(::listen(socket_.value(), backlog) == 0, "listen");
  require(::getsockname(socket_.value(), any, &size) == 0, "getsockname");
  port_ = ntohs(address.sin_port);
}

std::string Listener::address() const { return "127.0.0.1:" + std::to_string(port_); }

Descriptor Listener::accept() const {
  Descriptor accepted{::accept4(socket_.value(), nullptr, nullptr, SOCK_CLOEXEC)};
  require(accepted.is_open(), "accept");
  return accepted;
}

void send_plain(const Descriptor& socket, Bytes bytes) {
  const Stopwatch clock;
  require(send_all(socket, bytes, clock, std::chrono::seconds{10}).has_value(), "send");
}

std::string receive_plain(const Descriptor& socket, std::size_t size) {
  std::string received(size, '\0');
  const auto got = ::recv(socket.value(), received.data(), size, MSG_WAITALL);
  received.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return received;
}

void close_with_reset(Descriptor& socket) {
  const linger now{.l_onoff = 1, .l_linger = 0};
  ::setsockopt(socket.value(), SOL_SOCKET, SO_LINGER, &now, sizeof now);
  socket.close();
}

}  // namespace armjig::testing
