// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/telnet/com_port.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace armjig::telnet {
namespace {

using Answer = ComPortServer::Answer;

/// Carrier, DSR and CTS, in the bits of a 16450's modem status.
constexpr std::uint8_t kModemState = 0x80 | 0x20 | 0x10;
/// Holding and shift register are empty, in the bits of its line status.
constexpr std::uint8_t kLineState = 0x40 | 0x20;
constexpr std::string_view kName = "armjig";

void append(Answer& answer, Bytes bytes) {
  std::ranges::copy(bytes, answer.extend(bytes.size()).begin());
}

/// Of a server, unless `first` is another number for code 0.
constexpr std::uint8_t kOfServer = 100;
constexpr std::uint8_t kOfClient = 0;

void append(Answer& answer, ComPortCode code, Bytes value, std::uint8_t first = kOfServer) {
  answer.push_back(kIac);
  answer.push_back(kSubnegotiationBegin);
  answer.push_back(static_cast<std::byte>(Option::kComPort));
  answer.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(code) + first));
  escape(value, [&](Bytes piece) { append(answer, piece); });
  answer.push_back(kIac);
  answer.push_back(kSubnegotiationEnd);
}

void append(Answer& answer, ComPortCode code, std::uint8_t value, std::uint8_t first = kOfServer) {
  const auto byte = static_cast<std::byte>(value);
  append(answer, code, Bytes{&byte, 1}, first);
}

/// Most significant byte first.
std::array<std::byte, 4> four_bytes(std::uint32_t value) {
  std::array<std::byte, 4> bytes{};
  store_u16_be(std::span{bytes}.first<2>(), static_cast<std::uint16_t>(value >> 16));
  store_u16_be(std::span{bytes}.last<2>(), static_cast<std::uint16_t>(value));
  return bytes;
}

/// A number of that many bytes, most significant first; 0, which asks, for any other length.
std::uint32_t number(Bytes bytes, std::size_t size) {
  if (bytes.size() != size) return 0;
  std::uint32_t value = 0;
  for (const auto byte : bytes) value = value << 8 | std::to_integer<std::uint32_t>(byte);
  return value;
}

}  // namespace

Answer ComPortServer::begin() noexcept {
  using enum Agreements::Direction;
  Answer answer;
  for (const auto option : {Option::kBinary, Option::kSuppressGoAhead}) {
    append(answer, agreements_.ask(option, kTheirs));
    append(answer, agreements_.ask(option, kOurs));
  }
  append(answer, agreements_.ask(Option::kComPort, kTheirs));
  return answer;
}

Answer ComPortServer::on(Negotiation negotiation) noexcept {
  Answer answer;
  const bool had_com_port = agreements_.has_com_port();
  append(answer, agreements_.on(negotiation));
  if (!had_com_port && agreements_.has_com_port()) {
    append(answer, ComPortCode::kNotifyModemState, kModemState & modem_mask_);
  }
  return answer;
}

Answer ComPortServer::on(const Subnegotiation& request) noexcept {
  Answer answer;
  if (request.option != Option::kComPort || !agreements_.has_com_port() || request.bytes.empty())
    return answer;
  const auto code = static_cast<ComPortCode>(request.bytes[0]);
  const auto value = request.bytes.subspan(1);
  const auto byte = static_cast<std::uint8_t>(number(value, 1));
  switch (code) {
    case ComPortCode::kSignature:
      // With a text it is the client's own name, which wants no answer.
      if (value.empty()) append(answer, code, std::as_bytes(std::span{kName}));
      break;
    case ComPortCode::kBaudRate: {
      if (const auto rate = number(value, 4); rate != 0) settings_.baud_rate = rate;
      append(answer, code, four_bytes(settings_.baud_rate));
      break;
    }
    case ComPortCode::kDataSize:
      settle(code, byte, settings_.data_size, 5, 8, answer);
      break;
    case ComPortCode::kParity:
      settle(code, byte, settings_.parity, 1, 5, answer);
      break;
    case ComPortCode::kStopSize:
      settle(code, byte, settings_.stop_size, 1, 3, answer);
      break;
    case ComPortCode::kControl:
      if (value.size() == 1) set_control(byte, answer);
      break;
    case ComPortCode::kNotifyLineState:
      append(answer, code, kLineState);
      break;
    case ComPortCode::kNotifyModemState:
      append(answer, code, kModemState);
      break;
    case ComPortCode::kSuspend:
      is_suspended_ = true;
      break;
    case ComPortCode::kResume:
      is_suspended_ = false;
      break;
    case ComPortCode::kLineStateMask:
      if (value.size() != 1) break;
      append(answer, code, byte);
      if ((kLineState & byte) != 0) {
        append(answer, ComPortCode::kNotifyLineState, kLineState & byte);
      }
      break;
    case ComPortCode::kModemStateMask:
      if (value.size() != 1) break;
      modem_mask_ = byte;
      append(answer, code, byte);
      if ((kModemState & byte) != 0) {
        append(answer, ComPortCode::kNotifyModemState, kModemState & byte);
      }
      break;
    case ComPortCode::kPurge:
      if (byte >= 1 && byte <= 3) append(answer, code, byte);
      break;
  }
  return answer;
}

void ComPortServer::settle(ComPortCode code, std::uint8_t value, std::uint8_t& setting,
                           std::uint8_t least, std::uint8_t most, Answer& answer) noexcept {
  if (value >= least && value <= most) setting = value;
  append(answer, code, setting);
}

void ComPortServer::set_control(std::uint8_t value, Answer& answer) noexcept {
  std::uint8_t holds = 0;
  // Each of the switches has three numbers: what is it, on, off.
  const auto turn = [&](std::uint8_t first, bool& is_on) {
    if (value != first) is_on = value == first + 1;
    holds = static_cast<std::uint8_t>(is_on ? first + 1 : first + 2);
  };
  const auto choose = [&](std::uint8_t asks, std::uint8_t& setting) {
    if (value != asks) setting = value;
    holds = setting;
  };
  switch (value) {
    case 0:
    case 1:
    case 2:
    case 3:
    case 17:
    case 19:
      choose(0, settings_.flow_control);
      break;
    case 4:
    case 5:
    case 6:
      turn(4, settings_.has_break);
      break;
    case 7:
    case 8:
    case 9:
      turn(7, settings_.has_dtr);
      break;
    case 10:
    case 11:
    case 12:
      turn(10, settings_.has_rts);
      break;
    case 13:
    case 14:
    case 15:
    case 16:
    case 18:
      choose(13, settings_.inbound_flow);
      break;
    default:
      return;  // a number that RFC 2217 does not have
  }
  append(answer, ComPortCode::kControl, holds);
}

namespace {

constexpr unsigned bit_of(ComPortCode code) noexcept { return 1U << static_cast<unsigned>(code); }

constexpr std::uint8_t kNoFlowControl = 1;
constexpr std::uint8_t kDtrOn = 8;
constexpr std::uint8_t kRtsOn = 11;

}  // namespace

ComPortClient::Request ComPortClient::begin() noexcept {
  using enum Agreements::Direction;
  Request request;
  for (const auto option : {Option::kBinary, Option::kSuppressGoAhead}) {
    append(request, agreements_.ask(option, kOurs));
    append(request, agreements_.ask(option, kTheirs));
  }
  append(request, agreements_.ask(Option::kComPort, kOurs));
  return request;
}

ComPortClient::Request ComPortClient::on(Negotiation negotiation) noexcept {
  Request request;
  append(request, agreements_.on(negotiation));
  if (asked_ || !agreements_.has_com_port()) return request;
  asked_ = true;
  using enum ComPortCode;
  append(request, kBaudRate, four_bytes(wanted_.baud_rate), kOfClient);
  append(request, kDataSize, wanted_.data_size, kOfClient);
  append(request, kParity, wanted_.parity, kOfClient);
  append(request, kStopSize, wanted_.stop_size, kOfClient);
  for (const auto value : {kNoFlowControl, kDtrOn, kRtsOn}) {
    append(request, kControl, value, kOfClient);
  }
  for (const auto code : {kBaudRate, kDataSize, kParity, kStopSize, kControl}) {
    missing_ |= bit_of(code);
  }
  return request;
}

void ComPortClient::on(const Subnegotiation& answer) noexcept {
  if (answer.option != Option::kComPort || answer.bytes.empty()) return;
  const auto number_of = std::to_integer<std::uint8_t>(answer.bytes[0]);
  if (number_of < kOfServer) return;
  const auto code = static_cast<ComPortCode>(number_of - kOfServer);
  const auto value = answer.bytes.subspan(1);
  const auto byte = number(value, 1);
  switch (code) {
    case ComPortCode::kBaudRate:
      return expect(code, wanted_.baud_rate, number(value, 4));
    case ComPortCode::kDataSize:
      return expect(code, wanted_.data_size, byte);
    case ComPortCode::kParity:
      return expect(code, wanted_.parity, byte);
    case ComPortCode::kStopSize:
      return expect(code, wanted_.stop_size, byte);
    case ComPortCode::kControl:
      // What a server says of lines that its port does not have is its own affair.
      return expect(code, byte, byte);
    default:
      return;
  }
}

void ComPortClient::expect(ComPortCode code, std::uint32_t wanted, std::uint32_t said) noexcept {
  if ((missing_ & bit_of(code)) == 0) return;
  missing_ &= ~bit_of(code);
  if (wanted != said && !refused_) refused_ = Refused{code, said};
}

}  // namespace armjig::telnet
