// SPDX-License-Identifier: Apache-2.0
#include "conformance/stream_bench.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace armjig {
namespace {

/// The guard of an arm that moves wants a sign of life twice a second.
constexpr Duration kLongestWait = std::chrono::milliseconds{200};

}  // namespace

StreamBench::StreamBench(Rig<StreamPort> rig, std::unique_ptr<Dissector> dissector)
    : DissectedBench{std::move(rig), std::move(dissector), 4} {}

void StreamBench::send(Bytes bytes) {
  if (is_deaf()) return;
  if (!is_done(port().write(bytes)) && !error()) return;
  (void)dissect(Direction::kToDevice, bytes);
}

std::optional<Message> StreamBench::receive(Duration within) {
  const auto deadline = now() + within;
  while (arrived_.empty() && !is_deaf() && now() < deadline) read_until(deadline);
  if (arrived_.empty() || is_over()) return std::nullopt;
  auto message = std::move(arrived_.front());
  arrived_.pop_front();
  return message;
}

void StreamBench::pause(Duration duration) {
  const auto deadline = now() + duration;
  while (!is_deaf() && now() < deadline) read_until(deadline);
}

void StreamBench::drain(Duration quiet) {
  do {
    arrived_.clear();
    pause(quiet);
  } while (!is_deaf() && !arrived_.empty());
}

/// Reads once, and for a moment only.
void StreamBench::read_until(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  const auto size = port().read(buffer, std::min(deadline, now() + kLongestWait));
  judge_stop();
  if (!size) return lose_link(size.error());
  for (auto& message : dissect(Direction::kFromDevice, std::span{buffer}.first(*size))) {
    arrived_.push_back(std::move(message));
  }
}

}  // namespace armjig
