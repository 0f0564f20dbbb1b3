// SPDX-License-Identifier: Apache-2.0
#include "conformance/stream_bench.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace armjig {
namespace {

constexpr std::size_t kRemembered = 4;
/// The guard of an arm that moves wants a sign of life twice a second.
constexpr Duration kLongestWait = std::chrono::milliseconds{200};

}  // namespace

StreamBench::StreamBench(Rig rig, const DissectorEntry& device)
    : rig_{std::move(rig)}, dissector_{device.make()} {}

Instant StreamBench::now() const { return rig_.port().now(); }

void StreamBench::send(Bytes bytes) {
  if (is_deaf()) return;
  const auto written = rig_.port().write(bytes);
  if (!written && written.error().code == ErrorCode::kForbidden) {
    skip(rig_.last_refusal() ? rig_.last_refusal()->reason : "the guard does not allow it");
    return;
  }
  if (!written) error_ = written.error();
  std::vector<Message> messages;
  dissector_->feed(Direction::kToDevice, now(), bytes, messages);
  for (const auto& message : messages) remember(message);
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

void StreamBench::touch(std::string_view input, std::int64_t value) {
  if (is_deaf() || rig_.port().touch(input, value)) return;
  skip(fmt::format("needs a hand at the device, to set {}", input));
}

/// Reads once, and for a moment only.
void StreamBench::read_until(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  const auto size = rig_.port().read(buffer, std::min(deadline, now() + kLongestWait));
  skip_if_stopped();
  if (!size) {
    error_ = size.error();
    return;
  }
  std::vector<Message> messages;
  dissector_->feed(Direction::kFromDevice, now(), std::span{buffer}.first(*size), messages);
  for (auto& message : messages) {
    remember(message);
    arrived_.push_back(std::move(message));
  }
}

/// What a board shows that was stopped in the middle of a case says nothing about it.
void StreamBench::skip_if_stopped() {
  if (!rig_.is_unsupervised() || std::exchange(knows_it_is_stopped_, true)) return;
  skip(rig_.last_refusal()->reason);
}

void StreamBench::remember(const Message& message) {
  exchange_.push_back(message);
  if (exchange_.size() > kRemembered) exchange_.pop_front();
}

std::string StreamBench::last_exchange() const {
  std::string text;
  for (const auto& message : exchange_) {
    text += fmt::format("{:.3f} ms {}", static_cast<double>(microseconds(message.time)) / 1000.0,
                        to_text(message));
  }
  return text;
}

}  // namespace armjig
