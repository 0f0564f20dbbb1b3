// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/replay.hpp"

namespace armjig {

Outcome<std::optional<TraceDifference>> verify(const Trace& trace, const Replay& replay) {
  return replay.run(trace).map([&replay](const Replayed& replayed) {
    return replay.compare(replayed.recorded, replayed.actual);
  });
}

}  // namespace armjig
