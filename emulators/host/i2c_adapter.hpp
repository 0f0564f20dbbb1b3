// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/i2c.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <thread>

#include "emulators/host/paced_clock.hpp"
#include "emulators/i2c/bus.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"
#include "harness/link/emulated_bus_port.hpp"

namespace armjig {

/// Is told of every message that somebody on a bus acknowledged, when it is over: the byte with
/// address and direction, then the data bytes that were acknowledged. Bytes until it returns. It
/// may be called from any thread, one call at a time; times never decrease.
using BusListener = std::function<void(Instant time, Bytes message)>;

/// An emulated bus as the kernel would show it: transactions and SMBus commands in, error numbers
/// out. It lives on the wall clock; a transaction takes as long as its bits do. All functions may
/// be called from any thread; one transaction runs at a time.
class I2cAdapter {
 public:
  /// What it can do, as `I2C_FUNCS` tells it.
  static constexpr unsigned long kFunctions =
      I2C_FUNC_I2C | I2C_FUNC_SMBUS_QUICK | I2C_FUNC_SMBUS_BYTE | I2C_FUNC_SMBUS_BYTE_DATA |
      I2C_FUNC_SMBUS_WORD_DATA | I2C_FUNC_SMBUS_PROC_CALL | I2C_FUNC_SMBUS_WRITE_BLOCK_DATA |
      I2C_FUNC_SMBUS_I2C_BLOCK;
  /// How long a device may hold the clock.
  static constexpr Duration kPatience = std::chrono::seconds{1};

  /// An empty listener hears nothing.
  explicit I2cAdapter(i2c::Bus bus, BusListener listener = {});

  /// 0 or an error number: `ENXIO` for a refused address, `EIO` for a refused byte, `EAGAIN` for
  /// lost arbitration or a line that is held, `ETIMEDOUT`.
  [[nodiscard]] int transfer(std::span<const BusMessage> messages);

  /// An SMBus command made of transactions; `size` is one of `I2C_SMBUS_QUICK` and so on. Also
  /// `EOPNOTSUPP`, `EINVAL` for a wrong length of a block.
  [[nodiscard]] int smbus(BusAddress address, Access access, std::uint8_t command,
                          std::uint32_t size, i2c_smbus_data& data);

 private:
  void keep_up(const std::stop_token& stop);

  std::mutex guard_;
  PacedClock clock_{1.0, PacedClock::Wall::now()};
  EmulatedBusPort<i2c::Bus> port_;
  BusListener listener_;
  std::jthread keeper_;  ///< lets the devices live while nobody talks to them
};

}  // namespace armjig
