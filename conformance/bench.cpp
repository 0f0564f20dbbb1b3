// SPDX-License-Identifier: Apache-2.0
#include "conformance/bench.hpp"

#include <fmt/core.h>

#include <array>
#include <utility>
#include <vector>

namespace armjig {
namespace {

constexpr std::size_t kRemembered = 3;

}  // namespace

Bench::Bench(StreamPort& port, const DissectorEntry& device)
    : port_{port}, dissector_{device.make()} {}

void Bench::send(Bytes bytes) {
  if (error_) return;
  const auto written = port_.write(bytes);
  if (!written) error_ = written.error();
  std::vector<Message> messages;
  dissector_->feed(Direction::kToDevice, now(), bytes, messages);
  for (const auto& message : messages) remember(message);
}

std::optional<Message> Bench::receive(Duration within) {
  const auto deadline = now() + within;
  while (arrived_.empty() && !error_ && now() < deadline) read_until(deadline);
  if (arrived_.empty()) return std::nullopt;
  auto message = std::move(arrived_.front());
  arrived_.pop_front();
  return message;
}

void Bench::pause(Duration duration) {
  const auto deadline = now() + duration;
  while (!error_ && now() < deadline) read_until(deadline);
}

void Bench::drain(Duration quiet) {
  pause(quiet);
  while (!error_ && !arrived_.empty()) {
    arrived_.clear();
    pause(quiet);
  }
}

/// Reads once.
void Bench::read_until(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  const auto size = port_.read(buffer, deadline);
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

void Bench::remember(const Message& message) {
  exchange_.push_back(message);
  if (exchange_.size() > kRemembered) exchange_.pop_front();
}

std::string Bench::last_exchange() const {
  std::string text;
  for (const auto& message : exchange_) {
    text += fmt::format("{:.3f} ms {}", static_cast<double>(microseconds(message.time)) / 1000.0,
                        to_text(message));
  }
  return text;
}

}  // namespace armjig
