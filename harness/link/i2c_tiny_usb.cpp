// SPDX-License-Identifier: Apache-2.0
#include "harness/link/i2c_tiny_usb.hpp"

#include <array>
#include <cstdint>
#include <utility>

#include "harness/link/transaction_bus.hpp"

namespace armjig {
namespace {

// Of the adapter's protocol. A transfer has the address as its index and a read flag as its value.
constexpr std::uint8_t kGetFunctions = 1;
constexpr std::uint8_t kSetDelay = 2;
constexpr std::uint8_t kGetStatus = 3;
constexpr std::uint8_t kTransfer = 4;
constexpr std::uint8_t kBegins = 1;  // with a start condition, repeated within a transaction
constexpr std::uint8_t kEnds = 2;    // with a stop
constexpr std::uint16_t kReadFlag = 1;
constexpr std::byte kAddressAcknowledged{1};
constexpr std::byte kAddressRefused{2};

constexpr std::uint16_t kHalfClockUs = 5;      // 100 kHz at most
constexpr std::byte kPlainTransactions{1};     // in the lowest byte of what it can do
constexpr std::size_t kLongestMessage = 4096;  // libusb on Linux carries no more at once

constexpr UsbId kOfFtdi{0x0403, 0xC631};
constexpr UsbId kOfEzprototypes{0x1C40, 0x0534};

void send_last_message(int descriptor, Bytes message) noexcept {
  const auto address = static_cast<std::uint16_t>(std::to_integer<unsigned>(message[0]) >> 1U);
  send_last_request(descriptor, {kTransfer | kBegins | kEnds, 0, address}, message.subspan(1));
}

class TinyUsb final : public RealBus {
 public:
  explicit TinyUsb(std::unique_ptr<UsbControl> usb) noexcept : usb_{std::move(usb)} {}

  Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    if (!can_do(messages, SIZE_MAX, kLongestMessage)) return fail(ErrorCode::kBadValue);
    for (std::size_t i = 0; i < messages.size(); ++i) {
      auto command = static_cast<std::uint8_t>(kTransfer | kBegins);
      if (i + 1 == messages.size()) command |= kEnds;
      auto done = send(messages[i], command);
      if (!done || *done != Transfer::kDone) return done;
    }
    return Transfer::kDone;
  }

  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    const auto file = usb_->descriptor();
    return file ? std::optional{Lifeline{*file, send_last_message}} : std::nullopt;
  }

 private:
  Result<Transfer> send(const BusMessage& message, std::uint8_t command) {
    const bool is_read = message.access == Access::kRead;
    const UsbRequest request{command, is_read ? kReadFlag : std::uint16_t{0},
                             message.address.value};
    const auto size =
        is_read ? usb_->read(request, message.read) : usb_->write(request, message.write);
    if (!size) return tl::unexpected{size.error()};
    std::array<std::byte, 1> status{};
    const auto answered = usb_->read({kGetStatus}, status);
    if (!answered) return tl::unexpected{answered.error()};
    if (*answered != 1) return fail(ErrorCode::kMalformed);
    if (status[0] == kAddressRefused) return Transfer::kAddressRefused;
    if (status[0] != kAddressAcknowledged) return fail(ErrorCode::kBusy);
    const auto wanted = is_read ? message.read.size() : message.write.size();
    return *size == wanted ? Transfer::kDone : Transfer::kByteRefused;
  }

  std::unique_ptr<UsbControl> usb_;
};

}  // namespace

Outcome<std::unique_ptr<BusPort>> open_i2c_tiny_usb(const std::string& serial_number) {
  const auto where = "i2c-tiny-usb:" + serial_number;
  auto usb =
      open_usb_control({.ids = {kOfFtdi, kOfEzprototypes}, .serial_number = serial_number}, where);
  if (!usb) return tl::unexpected{usb.error()};
  return make_i2c_tiny_usb(*std::move(usb), where);
}

Outcome<std::unique_ptr<BusPort>> make_i2c_tiny_usb(std::unique_ptr<UsbControl> usb,
                                                    const std::string& where) {
  std::array<std::byte, 4> functions{};
  const auto size = usb->read({kGetFunctions}, functions);
  if (!size) return problem(size.error().code, where, "the adapter does not say what it can do");
  if (*size != functions.size() || (functions[0] & kPlainTransactions) == std::byte{}) {
    return problem(ErrorCode::kUnsupported, where, "it does not answer as an I2C adapter does");
  }
  if (const auto set = usb->write({kSetDelay, kHalfClockUs}, {}); !set) {
    return problem(set.error().code, where, "the adapter does not take its clock");
  }
  return std::make_unique<TinyUsb>(std::move(usb));
}

}  // namespace armjig
