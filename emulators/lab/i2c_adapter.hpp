// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/i2c.h>

#include <cstdint>
#include <span>

#include "emulators/host/host.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig {

/// An emulated bus as the kernel would show it: transactions and SMBus commands in, error numbers
/// out. It lives on the wall clock (`Host`); a transaction takes as long as its bits do. All
/// functions may be called from any thread; one transaction runs at a time.
class I2cAdapter {
 public:
  /// What it can do, as `I2C_FUNCS` tells it.
  static constexpr unsigned long kFunctions =
      I2C_FUNC_I2C | I2C_FUNC_SMBUS_QUICK | I2C_FUNC_SMBUS_BYTE | I2C_FUNC_SMBUS_BYTE_DATA |
      I2C_FUNC_SMBUS_WORD_DATA | I2C_FUNC_SMBUS_PROC_CALL | I2C_FUNC_SMBUS_WRITE_BLOCK_DATA |
      I2C_FUNC_SMBUS_I2C_BLOCK;

  /// `host` has a bus, runs, and must outlive this.
  explicit I2cAdapter(Host& host) noexcept : host_{host} {}

  /// 0 or an error number: `ENXIO` for a refused address, `EIO` for a refused byte, `EAGAIN` for
  /// lost arbitration or a line that is held, `ETIMEDOUT`, `ENODEV` if the host has ended.
  [[nodiscard]] int transfer(std::span<const BusMessage> messages);

  /// An SMBus command made of transactions; `size` is one of `I2C_SMBUS_QUICK` and so on. Also
  /// `EOPNOTSUPP`, `EINVAL` for a wrong length of a block.
  [[nodiscard]] int smbus(BusAddress address, Access access, std::uint8_t command,
                          std::uint32_t size, i2c_smbus_data& data);

 private:
  Host& host_;
};

}  // namespace armjig
