// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "harness/wire/telnet/agreements.hpp"

/// The serial port behind a Telnet connection (RFC 2217), from the side that has the port and from
/// the side that uses it.
namespace armjig::telnet {

/// What a client asks for; the answer has the number plus 100.
enum class ComPortCode : std::uint8_t {
  kSignature = 0,
  kBaudRate = 1,
  kDataSize = 2,
  kParity = 3,
  kStopSize = 4,
  kControl = 5,
  kNotifyLineState = 6,
  kNotifyModemState = 7,
  kSuspend = 8,
  kResume = 9,
  kLineStateMask = 10,
  kModemStateMask = 11,
  kPurge = 12,
};

/// What a client has set, in the numbers of RFC 2217.
struct ComPortSettings {
  std::uint32_t baud_rate = 115'200;
  std::uint8_t data_size = 8;
  std::uint8_t parity = 1;  ///< none
  std::uint8_t stop_size = 1;
  std::uint8_t flow_control = 1;   ///< of both directions or of the outbound one: none
  std::uint8_t inbound_flow = 14;  ///< none
  bool has_break = false;
  bool has_dtr = true;
  bool has_rts = true;
  friend bool operator==(const ComPortSettings&, const ComPortSettings&) = default;
};

/// Answers one client as an access server does whose port is always there: every setting that RFC
/// 2217 has is taken and acknowledged, one that it does not have is answered with what holds. Asked
/// for, or as soon as the option is agreed on, it says that carrier, DSR and CTS are on. There is
/// no line behind it, so these never change, and the transmitter is always empty.
class ComPortServer {
 public:
  /// What is to be sent to the client, escaped already.
  using Answer = BoundedBytes<64>;

  /// For a client that has just connected: BINARY and SGA for both directions, and COM-PORT.
  [[nodiscard]] Answer begin() noexcept;
  [[nodiscard]] Answer on(Negotiation negotiation) noexcept;
  [[nodiscard]] Answer on(const Subnegotiation& request) noexcept;

  [[nodiscard]] const ComPortSettings& settings() const noexcept { return settings_; }
  /// The client wants no data until it says otherwise.
  [[nodiscard]] bool is_suspended() const noexcept { return is_suspended_; }

 private:
  void set_control(std::uint8_t value, Answer& answer) noexcept;
  static void settle(ComPortCode code, std::uint8_t value, std::uint8_t& setting,
                     std::uint8_t least, std::uint8_t most, Answer& answer) noexcept;

  Agreements agreements_;
  ComPortSettings settings_;
  std::uint8_t modem_mask_ = 255;  ///< RFC 2217: everything is told unless a client says otherwise
  bool is_suspended_ = false;
};

/// Asks a server for a port that is set in a certain way, without flow control and with DTR and RTS
/// on, and waits for its word on each of these.
class ComPortClient {
 public:
  using Request = BoundedBytes<64>;

  explicit ComPortClient(const ComPortSettings& wanted) noexcept : wanted_{wanted} {}

  /// BINARY and SGA for both directions, and COM-PORT.
  [[nodiscard]] Request begin() noexcept;
  [[nodiscard]] Request on(Negotiation negotiation) noexcept;
  void on(const Subnegotiation& answer) noexcept;

  /// Everything was acknowledged.
  [[nodiscard]] bool is_ready() const noexcept { return asked_ && missing_ == 0 && !refused_; }
  /// The server has no such option.
  [[nodiscard]] bool is_no_port() const noexcept { return agreements_.is_com_port_refused(); }
  /// The first setting that it answered with another value, and that value.
  struct Refused {
    ComPortCode code{};
    std::uint32_t value{};
  };
  [[nodiscard]] const std::optional<Refused>& refused() const noexcept { return refused_; }

 private:
  void expect(ComPortCode code, std::uint32_t wanted, std::uint32_t said) noexcept;

  ComPortSettings wanted_;
  Agreements agreements_;
  bool asked_ = false;
  unsigned missing_ = 0;  ///< answers, a bit for each code
  std::optional<Refused> refused_;
};

}  // namespace armjig::telnet
