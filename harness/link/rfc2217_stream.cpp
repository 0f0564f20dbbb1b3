// SPDX-License-Identifier: Apache-2.0
#include "harness/link/rfc2217_stream.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "harness/link/descriptor.hpp"
#include "harness/link/port_around.hpp"
#include "harness/link/real_streams.hpp"
#include "harness/link/serial_stream.hpp"
#include "harness/wire/telnet/com_port.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
constexpr Duration kPatience = 3s;

telnet::ComPortSettings settings_of(const SerialLine& line) {
  constexpr std::array<std::uint8_t, 3> kParities{1, 2, 3};  // none, odd, even
  return {.baud_rate = line.baud,
          .parity = kParities.at(static_cast<std::size_t>(line.parity)),
          .stop_size = line.stop_bits};
}

/// When nothing else of the program is left. Stops are short; more than has room stays unsaid, for
/// half a message is none.
void send_last_escaped(int descriptor, Bytes message) noexcept {
  BoundedBytes<512> escaped;
  if (message.size() > escaped.capacity() / 2) return;
  telnet::escape(message, [&](Bytes piece) {
    std::ranges::copy(piece, escaped.extend(piece.size()).begin());
  });
  send_last(descriptor, escaped);
}

class Rfc2217Stream final : public StreamAround {
 public:
  Rfc2217Stream(std::unique_ptr<StreamPort> inner, const SerialLine& line) noexcept
      : StreamAround{std::move(inner)}, client_{settings_of(line)} {}

  /// Until everything is acknowledged.
  Outcome<void> agree(const SerialLine& line, std::string_view target) {
    const auto wrong = [target](ErrorCode code, std::string hint) {
      return problem(code, std::string{target}, std::move(hint));
    };
    const auto deadline = now() + kPatience;
    auto passed = inner().write(client_.begin());
    while (passed && !client_.is_ready()) {
      if (client_.is_no_port() || now() >= deadline) {
        return wrong(client_.is_no_port() ? ErrorCode::kBadTarget : ErrorCode::kTimedOut,
                     "what listens there does not speak RFC 2217; a connection without it is "
                     "tcp:HOST:PORT");
      }
      if (const auto& refused = client_.refused()) {
        return wrong(ErrorCode::kBadTarget, hint_of(*refused, line));
      }
      passed = receive(deadline);
    }
    if (passed) return {};
    return wrong(passed.error().code, "the connection has ended while the port was set");
  }

  Result<void> write(Bytes bytes) override {
    escaped_.clear();
    telnet::escape(bytes, [this](Bytes piece) {
      escaped_.insert(escaped_.end(), piece.begin(), piece.end());
    });
    return inner().write(escaped_);
  }

  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    // Once even if the deadline has passed: what has come already is to be had.
    do {
      if (!came_.empty()) break;
      if (auto received = receive(deadline); !received) return tl::unexpected{received.error()};
    } while (came_.empty() && now() < deadline);
    const auto size = std::min(into.size(), came_.size());
    const auto end = came_.begin() + static_cast<std::ptrdiff_t>(size);
    std::copy(came_.begin(), end, into.begin());
    came_.erase(came_.begin(), end);
    return size;
  }

  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    const auto inner = StreamAround::lifeline();
    if (!inner) return std::nullopt;
    return Lifeline{inner->descriptor, send_last_escaped, /*is_plain=*/false};
  }

 private:
  static std::string hint_of(const telnet::ComPortClient::Refused& refused,
                             const SerialLine& line) {
    switch (refused.code) {
      case telnet::ComPortCode::kBaudRate:
        return fmt::format("its port does not take {} baud but {}; write ,BAUD after it", line.baud,
                           refused.value);
      case telnet::ComPortCode::kParity:
        return fmt::format("its port does not take {} parity", to_string(line.parity));
      default:
        return fmt::format("its port does not take 8 data bits and {} stop bits", line.stop_bits);
    }
  }

  /// Takes what comes first until then: data for later, and what is said of the port.
  Result<void> receive(Instant deadline) {
    std::array<std::byte, 4096> buffer;
    const auto size = inner().read(buffer, deadline);
    if (!size) return tl::unexpected{size.error()};
    for (auto bytes = Bytes{buffer}.first(*size); !bytes.empty();) {
      const auto step = decoder_.step(bytes);
      bytes = bytes.subspan(step.used);
      if (const auto* data = std::get_if<telnet::Data>(&step.found)) {
        came_.insert(came_.end(), data->bytes.begin(), data->bytes.end());
      } else if (const auto* negotiation = std::get_if<telnet::Negotiation>(&step.found)) {
        const auto answer = client_.on(*negotiation);
        if (answer.size() == 0) continue;
        if (auto sent = inner().write(answer); !sent) return sent;
      } else if (const auto* said = std::get_if<telnet::Subnegotiation>(&step.found)) {
        client_.on(*said);
      }
    }
    return {};
  }

  telnet::Decoder decoder_;
  telnet::ComPortClient client_;
  std::vector<std::byte> came_;
  std::vector<std::byte> escaped_;
};

}  // namespace

Outcome<std::unique_ptr<StreamPort>> speak_rfc2217(std::unique_ptr<StreamPort> connection,
                                                   const SerialLine& line,
                                                   std::string_view target) {
  auto port = std::make_unique<Rfc2217Stream>(std::move(connection), line);
  if (auto agreed = port->agree(line, target); !agreed) return tl::unexpected{agreed.error()};
  return port;
}

Outcome<std::unique_ptr<StreamPort>> open_rfc2217(std::string_view address, SerialLine usual) {
  const auto target = fmt::format("rfc2217:{}", address);
  const auto place = parse_serial_address(address, usual);
  auto connection =
      place.and_then([](const SerialAddress& at) { return open_tcp_stream(at.path); });
  if (connection) return speak_rfc2217(*std::move(connection), place->line, target);
  const auto& error = connection.error();
  return problem(error.code, target,
                 error.code == ErrorCode::kBadTarget
                     ? "write rfc2217:HOST:PORT or rfc2217:HOST:PORT,BAUD"
                     : error.hint);
}

}  // namespace armjig
