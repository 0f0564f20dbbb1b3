// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/pen.hpp"

#include <cstdlib>

namespace armjig::morap::emulation {
namespace {

/// Bytes that a command uses up; the board waits for ever for the rest to vanish.
std::size_t used_by(Bytes data) noexcept {
  const bool is_position = data[0] == static_cast<std::byte>(pen::CommandId::kSetPosition);
  return is_position ? 2 : 1;
}

}  // namespace

void Pen::start(Instant time, bool is_read) {
  advance_to(time);
  received_ = {};
  is_written_ = !is_read;
}

bool Pen::write(Instant time, std::byte byte) {
  advance_to(time);
  if (setup_.library == PenLibrary::kPerByte) {
    obey(Bytes{&byte, 1});
  } else if (received_.size() < received_.capacity()) {
    received_.push_back(byte);
  }
  return true;
}

std::byte Pen::read(Instant /*time*/) noexcept { return std::byte{0}; }

void Pen::stop(Instant time) {
  advance_to(time);
  if (is_written_ && received_.size() > 0) obey(received_);
  if (is_written_ && setup_.retracts_when_poked) degrees_ = pen::kRetractedDegrees;
  is_written_ = false;
}

void Pen::advance_to(Instant time) noexcept {
  if (time < next_poll_) return;
  next_poll_ += ((time - next_poll_) / setup_.poll_period + 1) * setup_.poll_period;
  if (hangs_) return;
  if (deploys_) {
    degrees_ = pen::kDeployedDegrees;
  } else if (retracts_) {
    degrees_ = pen::kRetractedDegrees;
  }
}

void Pen::restart(Instant time) noexcept {
  *this = Pen{setup_};
  next_poll_ = time + setup_.poll_period;
}

void Pen::press(Instant time, bool deploys, bool retracts) noexcept {
  advance_to(time);
  deploys_ = deploys;
  retracts_ = retracts;
}

bool Pen::set_input(Instant time, std::string_view name, std::int64_t value) {
  if (name == "deploy") {
    press(time, value != 0, retracts_);
  } else if (name == "retract") {
    press(time, deploys_, value != 0);
  } else if (name == "pen-power") {
    restart(time);
  } else {
    return false;
  }
  return true;
}

std::optional<std::int64_t> Pen::observe(Instant time, std::string_view name) noexcept {
  advance_to(time);
  if (name == "servo") return degrees_;
  if (name == "lamp1") return lamp1_ ? 1 : 0;
  if (name == "lamp2") return lamp2() ? 1 : 0;
  return std::nullopt;
}

bool Pen::lamp2() const noexcept {
  return std::abs(pen::kDeployedDegrees - degrees_) < std::abs(pen::kRetractedDegrees - degrees_);
}

void Pen::obey(Bytes data) {
  if (hangs_) return;
  degrees_ = setup_.degrees(data);
  lamp1_ = setup_.has_lamp1 && !lamp1_;
  console_ += std::to_string(degrees_) + "\r\n";
  hangs_ = setup_.hangs_on_surplus && data.size() > used_by(data);
}

}  // namespace armjig::morap::emulation
