// SPDX-License-Identifier: Apache-2.0
#include "emulators/demo/demo.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace armjig::demo::emulation {
namespace {

struct Row {
  State state;
  Operation operation;
  State next;
};
using enum State;
using enum Operation;
constexpr std::array kTransitions{
    Row{kReady, kQuery, kReady},     Row{kReady, kStart, kRunning},
    Row{kReady, kHalt, kHalted},     Row{kRunning, kQuery, kRunning},
    Row{kRunning, kStart, kRunning},  // asking twice is fine
    Row{kRunning, kHalt, kHalted},   Row{kHalted, kQuery, kHalted},
    Row{kHalted, kStart, kRunning},  Row{kHalted, kHalt, kHalted},
};
static_assert(kTransitions.size() == std::size_t{3} * 3, "a row for every state and operation");

}  // namespace

State Machine::act(Operation operation) noexcept {
  const auto row = std::ranges::find_if(kTransitions, [&](const Row& candidate) {
    return candidate.state == state_ && candidate.operation == operation;
  });
  if (row == kTransitions.end()) return kUnknownOperation;
  state_ = row->next;
  return state_;
}

void StreamDevice::receive(Instant time, Bytes bytes) {
  advance_to(time);
  for (const auto byte : bytes) {
    if (const auto operation = splitter_.step(byte)) {
      const auto reply = encode(machine_.act(Operation{std::to_integer<std::uint8_t>(*operation)}));
      due_.push_back({time + kReplyDelay, {reply.begin(), reply.end()}});
    }
  }
}

void StreamDevice::advance_to(Instant time) {
  const auto later =
      std::ranges::find_if(due_, [time](const SentBytes& reply) { return reply.time > time; });
  std::move(due_.begin(), later, std::back_inserter(sent_));
  due_.erase(due_.begin(), later);
}

std::optional<Instant> StreamDevice::next_event() const noexcept {
  return due_.empty() ? std::nullopt : std::optional{due_.front().time};
}

void SessionDevice::connect(Instant time) {
  stream_ = {};
  const auto greeting = encode(kReady);
  sent_.push_back({time, SessionEvent::Kind::kData, {greeting.begin(), greeting.end()}});
}

void SessionDevice::receive(Instant time, Bytes segment) {
  if (std::ranges::find(segment, std::byte{0}) != segment.end()) {
    stream_ = {};
    sent_.push_back({time, SessionEvent::Kind::kReset, {}});
    return;
  }
  stream_.receive(time, segment);
  advance_to(time);
}

void SessionDevice::half_close(Instant time) {
  sent_.push_back({time, SessionEvent::Kind::kEnd, {}});
}
void SessionDevice::close(Instant /*time*/) { stream_ = {}; }
void SessionDevice::reset(Instant /*time*/) { stream_ = {}; }

void SessionDevice::advance_to(Instant time) {
  stream_.advance_to(time);
  for (const auto& reply : stream_.sent()) {
    sent_.push_back({reply.time, SessionEvent::Kind::kData, reply.bytes});
  }
  stream_.clear_sent();
}

bool BusDevice::write(Instant /*time*/, std::byte byte) noexcept {
  const auto state = machine_.act(Operation{std::to_integer<std::uint8_t>(byte)});
  answer_ = static_cast<std::byte>(state);
  return state != kUnknownOperation;
}

std::byte BusDevice::read(Instant /*time*/) noexcept { return answer_; }

}  // namespace armjig::demo::emulation
