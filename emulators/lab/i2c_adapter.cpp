// SPDX-License-Identifier: Apache-2.0
#include "emulators/lab/i2c_adapter.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <utility>

namespace armjig {
namespace {

/// What leaves behind the address and what comes, for one SMBus command.
class SmbusFrame {
 public:
  explicit SmbusFrame(std::uint8_t command) { push(command); }

  void push(std::uint8_t byte) { out_[out_size_++] = static_cast<std::byte>(byte); }
  void push_word(std::uint16_t word) {
    push(static_cast<std::uint8_t>(word));
    push(static_cast<std::uint8_t>(word >> 8));
  }
  void drop_command() { out_size_ = 0; }
  void expect(std::size_t size) { in_size_ = size; }

  [[nodiscard]] int run(I2cAdapter& adapter, BusAddress address) {
    const auto write = write_to(address, Bytes{out_}.first(out_size_));
    const auto read = read_from(address, std::span{in_}.first(in_size_));
    if (in_size_ == 0) return adapter.transfer({&write, 1});
    if (out_size_ == 0) return adapter.transfer({&read, 1});
    return adapter.transfer(std::array{write, read});
  }

  [[nodiscard]] std::uint8_t byte(std::size_t i) const {
    return std::to_integer<std::uint8_t>(in_[i]);
  }
  [[nodiscard]] std::uint16_t word() const {
    return static_cast<std::uint16_t>(byte(0) | byte(1) << 8);
  }

 private:
  std::array<std::byte, 2 + I2C_SMBUS_BLOCK_MAX> out_{};
  std::size_t out_size_ = 0;
  std::array<std::byte, I2C_SMBUS_BLOCK_MAX> in_{};
  std::size_t in_size_ = 0;
};

/// The frame of a command; an error number if there is none.
int fill(SmbusFrame& frame, bool is_read, std::uint32_t size, const i2c_smbus_data& data) {
  switch (size) {
    case I2C_SMBUS_BYTE:
      if (is_read) frame.drop_command();
      if (is_read) frame.expect(1);
      return 0;
    case I2C_SMBUS_BYTE_DATA:
      is_read ? frame.expect(1) : frame.push(data.byte);
      return 0;
    case I2C_SMBUS_WORD_DATA:
      is_read ? frame.expect(2) : frame.push_word(data.word);
      return 0;
    case I2C_SMBUS_PROC_CALL:
      frame.push_word(data.word);
      frame.expect(2);
      return 0;
    case I2C_SMBUS_I2C_BLOCK_BROKEN:
    case I2C_SMBUS_I2C_BLOCK_DATA:
    case I2C_SMBUS_BLOCK_DATA:
      break;
    default:
      return EOPNOTSUPP;
  }
  if (is_read && size == I2C_SMBUS_BLOCK_DATA) return EOPNOTSUPP;
  const bool is_fixed = size == I2C_SMBUS_I2C_BLOCK_BROKEN && is_read;
  const std::size_t length = is_fixed ? I2C_SMBUS_BLOCK_MAX : data.block[0];
  if (length < 1 || length > I2C_SMBUS_BLOCK_MAX) return EINVAL;
  if (is_read) {
    frame.expect(length);
    return 0;
  }
  if (size == I2C_SMBUS_BLOCK_DATA) frame.push(data.block[0]);
  for (std::size_t i = 1; i <= length; ++i) frame.push(data.block[i]);
  return 0;
}

/// What was read, into the caller's data.
void take_answer(const SmbusFrame& frame, std::uint32_t size, i2c_smbus_data& data) {
  switch (size) {
    case I2C_SMBUS_BYTE:
    case I2C_SMBUS_BYTE_DATA:
      data.byte = frame.byte(0);
      return;
    case I2C_SMBUS_WORD_DATA:
    case I2C_SMBUS_PROC_CALL:
      data.word = frame.word();
      return;
    default:
      if (size == I2C_SMBUS_I2C_BLOCK_BROKEN) data.block[0] = I2C_SMBUS_BLOCK_MAX;
      for (std::size_t i = 0; i < data.block[0]; ++i) data.block[i + 1] = frame.byte(i);
  }
}

int error_of(const Result<Transfer>& result) {
  if (!result) return result.error().code == ErrorCode::kTimedOut ? ETIMEDOUT : EAGAIN;
  switch (*result) {
    case Transfer::kDone:
      return 0;
    case Transfer::kAddressRefused:
      return ENXIO;
    case Transfer::kByteRefused:
      break;
  }
  return EIO;
}

}  // namespace

int I2cAdapter::transfer(std::span<const BusMessage> messages) {
  int error = ENODEV;
  host_.with_bus([&](BusPort& bus) { error = error_of(bus.transfer(messages)); });
  return error;
}

int I2cAdapter::smbus(BusAddress address, Access access, std::uint8_t command, std::uint32_t size,
                      i2c_smbus_data& data) {
  const bool is_read = access == Access::kRead;
  if (size == I2C_SMBUS_QUICK) {
    const BusMessage message{.address = address, .access = access};
    return transfer({&message, 1});
  }
  SmbusFrame frame{command};
  if (const int error = fill(frame, is_read, size, data); error != 0) return error;
  if (const int error = frame.run(*this, address); error != 0) return error;
  if (is_read || size == I2C_SMBUS_PROC_CALL) take_answer(frame, size, data);
  return 0;
}

}  // namespace armjig
