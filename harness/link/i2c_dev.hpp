// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig {

/// Opens an I2C bus of Linux, as in `/dev/i2c-1`. It does whole transactions only. Drivers of
/// adapters tell a refused address and a refused byte apart as well as they can: `ENXIO` and
/// `EREMOTEIO` are taken for the address, `EIO` for a byte.
///
/// Problems: `kNotFound` (no such bus), `kNoPermission`, `kUnsupported` (not an I2C bus, or one
/// that cannot do plain transactions), `kDisconnected` (its adapter is gone, or goes).
[[nodiscard]] Outcome<std::unique_ptr<BusPort>> open_i2c_dev(const std::string& path);

}  // namespace armjig
