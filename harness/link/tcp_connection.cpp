// SPDX-License-Identifier: Apache-2.0
#include "harness/link/tcp_connection.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>  // before Asio, which forgets it

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cerrno>

#include "harness/core/number.hpp"

namespace armjig {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr Duration kLongestPatience = std::chrono::hours{1};  // a far deadline must not overflow

bool is_port(std::string_view text) noexcept {
  return whole_text_as<std::uint16_t>(text).value_or(0) != 0;
}

/// `[::1]` without its brackets; empty if they do not match or an IPv6 address has none.
std::string_view bare_host(std::string_view host) noexcept {
  if (host.starts_with('[') && host.ends_with(']')) return host.substr(1, host.size() - 2);
  return host.find_first_of(":[]") == std::string_view::npos ? host : std::string_view{};
}

Error as_error(const error_code& error) noexcept {
  if (error.category() != boost::system::system_category()) return {ErrorCode::kNotFound, 0};
  switch (error.value()) {
    case EHOSTUNREACH:
    case ENETUNREACH:
    case EADDRNOTAVAIL:
      return {ErrorCode::kNotFound, error.value()};
    default:
      return error_from_errno(error.value());
  }
}

/// Asio throws where no `error_code` is asked for.
Result<Descriptor> connect_or_throw(const TcpAddress& address, Duration patience) {
  boost::asio::io_context context{1};
  error_code error;
  const auto endpoints = tcp::resolver{context}.resolve(address.host, address.port, error);
  if (error) return tl::unexpected{as_error(error)};
  tcp::socket socket{context};
  error = boost::asio::error::timed_out;
  boost::asio::async_connect(
      socket, endpoints,
      [&error](const error_code& outcome, const tcp::endpoint&) { error = outcome; });
  context.run_for(std::min(patience, kLongestPatience));
  if (error) return tl::unexpected{as_error(error)};
  socket.set_option(tcp::no_delay{true});
  socket.native_non_blocking(true);
  return Descriptor{socket.release()};
}

}  // namespace

Outcome<TcpAddress> parse_tcp_address(std::string_view text) {
  const auto colon = text.rfind(':');
  const auto host = bare_host(text.substr(0, colon));
  const auto port = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  if (host.empty() || !is_port(port)) {
    return problem(ErrorCode::kBadTarget, fmt::format("tcp:{}", text),
                   "write tcp:HOST:PORT with a port from 1 to 65535, as in tcp:127.0.0.1:4000");
  }
  return TcpAddress{std::string{host}, std::string{port}};
}

Result<Descriptor> connect_tcp(const TcpAddress& address, Duration patience) {
  try {
    return connect_or_throw(address, patience);
  } catch (const boost::system::system_error& error) {
    return tl::unexpected{as_error(error.code())};
  }
}

}  // namespace armjig
