// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "harness/link/port_around.hpp"

namespace armjig {

/// Whether work on a port is to end. Asked often, so it is quick.
using MustStop = std::function<bool()>;

/// The port with an end: as long as somebody wants one, every call that sends or waits fails with
/// `kForbidden`, and those that wait end soon. The link is not lost: what has to be put in order
/// can be afterwards. Requires a port.
[[nodiscard]] std::unique_ptr<StreamPort> make_stoppable(std::unique_ptr<StreamPort> port,
                                                         MustStop must_stop);
[[nodiscard]] std::unique_ptr<SessionSource> make_stoppable(std::unique_ptr<SessionSource> source,
                                                            const MustStop& must_stop);
[[nodiscard]] std::unique_ptr<BusPort> make_stoppable(std::unique_ptr<BusPort> port,
                                                      MustStop must_stop);

}  // namespace armjig
