// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/sending.hpp"

#include <array>

namespace armjig {
namespace {

using namespace std::chrono_literals;

/// Takes what comes, until an answer is among it if one is waited for, or until `end`.
Result<void> listen(Path& path, Probe& probe, Instant end, bool is_waiting,
                    const std::function<bool()>& must_end) {
  std::array<std::byte, 4096> buffer;
  while (path.now() < end && !must_end()) {
    const auto arrival = path.receive(buffer, std::min(end, path.now() + kLookAbout));
    if (!arrival) return tl::unexpected{arrival.error()};
    if (arrival->size == 0) continue;
    const auto bytes = Bytes{buffer}.first(arrival->size);
    const auto answers = probe.receive(arrival->time, bytes);
    path.overhear(bytes);
    if (is_waiting && answers > 0) return {};
  }
  if (is_waiting) probe.lost();
  return {};
}

/// Of the last message of a request.
Result<std::optional<Duration>> time_request(Path& path, Probe& probe) {
  const auto messages = probe.request();
  for (const auto message : messages) {
    if (auto announced = path.announce(message); !announced) {
      return tl::unexpected{announced.error()};
    }
  }
  probe.leaves(path.now());
  Result<std::optional<Duration>> taken;
  for (const auto message : messages) {
    if (taken) taken = path.time_send(message);
  }
  return taken;
}

}  // namespace

Result<LatencyHistogram> time_sending(Path& path, Probe& probe, const SendingPlan& plan,
                                      const std::function<bool()>& must_end) {
  LatencyHistogram taken;
  auto due = path.now();
  for (std::uint64_t i = 0; i < plan.count && !must_end(); ++i) {
    if (auto heard = listen(path, probe, due, false, must_end); !heard) {
      return tl::unexpected{heard.error()};
    }
    const auto one = time_request(path, probe);
    if (!one) return tl::unexpected{one.error()};
    if (*one) taken.record(**one);
    if (auto heard = listen(path, probe, path.now() + plan.patience, true, must_end); !heard) {
      return tl::unexpected{heard.error()};
    }
    if (!*one) break;  // nor will it be told of the next
    due = std::max(due + plan.period, path.now());
  }
  return taken;
}

}  // namespace armjig
