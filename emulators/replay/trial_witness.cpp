// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/trial_witness.hpp"

#include <algorithm>

namespace armjig {

TrialWitness::TrialWitness(MakeDissector make_dissector, TrialJudge* judge)
    : make_dissector_{make_dissector}, judge_{judge} {}

void TrialWitness::to_device(Instant time, Bytes bytes) {
  look_at(time, 0, Direction::kToDevice, bytes);
  if (judge_ != nullptr) judge_->to_device(time, bytes);
}

void TrialWitness::from_device(Instant time, Bytes bytes) {
  look_at(time, 0, Direction::kFromDevice, bytes);
  if (judge_ != nullptr) judge_->from_device(time, bytes);
}

void TrialWitness::on_connection(const ConnectionEvent& event) {
  using What = ConnectionEvent::Kind;
  if (event.kind == What::kToServer) {
    look_at(event.time, event.connection, Direction::kToDevice, event.bytes);
  } else if (event.kind == What::kFromServer) {
    look_at(event.time, event.connection, Direction::kFromDevice, event.bytes);
  } else if (event.kind != What::kDropped) {
    note_who_stays(event);
  } else if (!left_.contains(event.connection)) {
    broken_.push_back({event.time, "device", "it ends the connection"});
  }
  if (judge_ != nullptr) judge_->on_connection(event);
}

void TrialWitness::on_bus(const BusPart& part) {
  const auto direction = part.is_read ? Direction::kFromDevice : Direction::kToDevice;
  if (const auto message = acknowledged(part); !message.empty()) {
    look_at(part.end, part.address, direction, message);
  }
  if (judge_ != nullptr) judge_->on_bus(part);
}

void TrialWitness::on_input(Instant time, std::string_view name, std::int64_t value) {
  if (judge_ != nullptr) judge_->on_input(time, name, value);
}

void TrialWitness::wait_until(Instant time) {
  if (judge_ != nullptr) judge_->wait_until(time);
}

void TrialWitness::overlook(Instant from, Instant to) {
  if (judge_ != nullptr) judge_->overlook(from, to);
}

// A server answers the end of its client with its own, sooner or later.
void TrialWitness::note_who_stays(const ConnectionEvent& event) {
  if (event.kind == ConnectionEvent::Kind::kBegun) {
    left_.erase(event.connection);
  } else {
    left_.insert(event.connection);
  }
}

void TrialWitness::look_at(Instant time, std::uint32_t lane, Direction direction, Bytes bytes) {
  if (direction == Direction::kFromDevice) {
    said_.push_back({time, lane, {bytes.begin(), bytes.end()}});
  }
  auto& dissector = dissectors_[lane];
  if (!dissector) dissector = make_dissector_();
  messages_.clear();
  dissector->feed(direction, time, bytes, messages_);
  for (const auto& message : messages_) {
    if (message.direction == Direction::kToDevice || message.fault.empty()) continue;
    broken_.push_back({time, "device", "its bytes are no message: " + message.fault});
  }
}

std::vector<Breakage> TrialWitness::finish() {
  auto broken = std::exchange(broken_, {});
  if (judge_ != nullptr) {
    for (auto& one : judge_->finish()) broken.push_back(std::move(one));
  }
  std::ranges::stable_sort(broken, {}, &Breakage::time);
  return broken;
}

}  // namespace armjig
