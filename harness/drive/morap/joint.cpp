// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/morap/joint.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/wire/morap/figures.hpp"

namespace armjig::morap::drive {

bool is_safe(const ControllerSet& set) noexcept {
  const auto is_sound = [](const Coefficients& filter) {
    const auto count = std::size_t{filter.count};
    return count >= 1 && count <= kMostCoefficients &&
           std::all_of(filter.values.begin(), filter.values.begin() + count,
                       [](float value) { return std::isfinite(value); });
  };
  return is_sound(set.d) && is_sound(set.c) && is_sound(set.f) && std::isfinite(set.integral) &&
         set.rate_hz >= 1 && set.rate_hz <= kHighestRateHz;
}

std::string_view describe(ProgramOutcome outcome) noexcept {
  switch (outcome) {
    case ProgramOutcome::kDone:
      return "programmed and read back";
    case ProgramOutcome::kBusFailed:
      return "the bus failed";
    case ProgramOutcome::kUnsafe:
      return "the node must not run such a set: counts are 1 to 4, the rate is 1 to 1500 Hz, "
             "coefficients are finite";
    case ProgramOutcome::kNotReset:
      return "the programming status does not go back to nothing";
    case ProgramOutcome::kRefused:
      return "the node refuses the parameters";
    case ProgramOutcome::kNotActive:
      return "accepted, but the node shows other parameters";
  }
  return {};
}

std::optional<TuneKind> tune_kind(std::string_view name) noexcept {
  if (name == "pd") return TuneKind::kPdPosition;
  if (name == "pid") return TuneKind::kPidPosition;
  if (name == "pi") return TuneKind::kPiSpeed;
  return std::nullopt;
}

std::string refusal_of(const TuneRequest& request) {
  if (!(request.inertia > 0.0F && request.inertia <= kLargestInertia)) {
    return "the inertia has to be above 0 and at most 10 kg m^2";
  }
  if (!(request.pole < 0.0F && request.pole >= kFastestPole)) {
    return "the pole has to be below 0 and at least -200 1/s";
  }
  return {};
}

BusCode Joint::send(const Command& command) { return master_->transmit(address_, encode(command)); }

BusCode Joint::read(CommandId selector, std::span<std::byte> out) {
  const auto code = send({selector});
  return code == BusCode::kOk ? master_->receive(address_, out) : code;
}

Reading<SetBytes> Joint::controller_set(ControllerKind kind) {
  std::array<std::byte, kLargestSetSize> bytes{};
  Reading<SetBytes> reading{read(selector_of(kind), bytes), {}};
  if (reading.code != BusCode::kOk) return reading;
  ControllerSet set;
  if (decode_into(set, bytes)) return reading;  // no set at all; or a tick fell between two bytes
  const auto size = wire_size(set);
  std::ranges::copy(Bytes{bytes}.first(size), reading.value.extend(size).begin());
  return reading;
}

ProgramResult Joint::program(const ControllerSet& set) {
  if (!is_safe(set)) return {ProgramOutcome::kUnsafe};
  auto result = program_verified({CommandId::kProgram, set}, set.kind);
  if (result.outcome != ProgramOutcome::kDone) return result;
  const auto sent = encode(set);
  const auto active = encode(result.active);
  if (!std::ranges::equal(sent.view(), active.view())) result.outcome = ProgramOutcome::kNotActive;
  return result;
}

ProgramResult Joint::tune(const TuneRequest& request) {
  return program_verified({CommandId::kTune, request}, kind_of(request.kind));
}

/// The status is sticky: it has to be "nothing" before, so that "success" means this message.
ProgramResult Joint::program_verified(const Command& command, ControllerKind kind) {
  const auto failed = [](BusCode code) { return ProgramResult{ProgramOutcome::kBusFailed, code}; };
  if (const auto code = load_default_controllers(); code != BusCode::kOk) return failed(code);
  master_->wait(kProgrammingPause);
  const auto before = programming_status();
  if (before.code != BusCode::kOk) return failed(before.code);
  if (before.value != ProgrammingStatus::kNothing) return {ProgramOutcome::kNotReset};
  if (const auto code = send(command); code != BusCode::kOk) return failed(code);
  const auto after = programming_status();
  if (after.code != BusCode::kOk) return failed(after.code);
  if (after.value != ProgrammingStatus::kSuccess) return {ProgramOutcome::kRefused};
  master_->wait(kProgrammingPause);
  const auto shown = controller_set(kind);
  if (shown.code != BusCode::kOk) return failed(shown.code);
  ProgramResult result{ProgramOutcome::kDone, BusCode::kOk, {}};
  if (decode_into(result.active, shown.value)) return {ProgramOutcome::kNotActive};
  return result;
}

}  // namespace armjig::morap::drive
