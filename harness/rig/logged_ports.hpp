// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/link/port_around.hpp"
#include "harness/rig/wire_log.hpp"

/// A recording around each kind of port. All require a port.
namespace armjig {

/// A record for each piece as it was written or read.
[[nodiscard]] std::unique_ptr<StreamPort> put_log_on(std::unique_ptr<StreamPort> port,
                                                     std::shared_ptr<WireLog> log);

/// Every segment of every connection, and how each began and ended.
[[nodiscard]] std::unique_ptr<SessionPort> put_log_on(std::unique_ptr<SessionPort> port,
                                                      std::shared_ptr<WireLog> log);
/// The same of every connection to a server.
[[nodiscard]] std::unique_ptr<SessionSource> put_log_on(std::unique_ptr<SessionSource> source,
                                                        std::shared_ptr<WireLog> log);

/// A record `write` or `read` for each part of a transaction, as the recordings of captures/morap
/// have them, with the time at which it began. What an adapter does not tell is not in it: which
/// byte was refused (`ack` ends after the address), and in which part of several (`ack` is empty);
/// `refused` says that something was, `error` that the bus failed.
[[nodiscard]] std::unique_ptr<BusPort> put_log_on(std::unique_ptr<BusPort> port,
                                                  std::shared_ptr<WireLog> log);

}  // namespace armjig
