// SPDX-License-Identifier: Apache-2.0
// The master's side on a bus that answers whatever it likes, or fails in the middle: what was not
// read is never taken for a value, and programming is done only if it was read back.
//
// Input: operations, each one byte and its arguments, among what the bus says meanwhile.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/input.hpp"
#include "fuzz/require.hpp"
#include "harness/drive/morap/joint.hpp"

namespace armjig::fuzz::bus_drive {
namespace {

using namespace morap;
using drive::BusCode;

constexpr int kMostOperations = 200;

/// Every operation's outcome is a byte of the input. An end of the input is silence.
class HostileBus final : public BusPort {
 public:
  explicit HostileBus(Input& input) : input_{input} {}

  [[nodiscard]] Instant now() const override { return now_; }
  void wait_until(Instant time) override { now_ = std::max(now_, time); }

  Result<Ack> start(BusAddress, Access) override { return answer(); }
  Result<Ack> write(std::byte) override { return answer(); }
  Result<std::byte> read(Ack) override {
    if (const auto answered = answer(); !answered) return tl::unexpected{answered.error()};
    return static_cast<std::byte>(input_.u8());
  }
  Result<void> stop() override { return {}; }

 private:
  Result<Ack> answer() {
    constexpr std::array kErrors{ErrorCode::kBusy, ErrorCode::kTimedOut, ErrorCode::kDisconnected,
                                 ErrorCode::kForbidden};
    now_ += std::chrono::microseconds{90};
    if (input_.is_empty()) return Ack::kNack;
    const auto what = input_.u8();
    if (what >= 0xF8) return fail(kErrors[what % kErrors.size()]);
    return what >= 0xF0 ? Ack::kNack : Ack::kAck;
  }

  Input& input_;
  Instant now_{};
};

template <class Reading>
void check_reading(const Reading& reading) {
  require(!describe(reading.code).empty(), "a code has words");
  if (reading.code == BusCode::kOk) return;
  if constexpr (requires { reading.value.value; }) {
    require(reading.value.value == 0, "a number that was not read is 0");
  } else if constexpr (requires { reading.value.size(); }) {
    require(reading.value.size() == 0, "a set that was not read is empty");
  } else {
    require(static_cast<int>(reading.value) == 255, "a status that was not read is 255");
  }
}

void check_programmed(const drive::ProgramResult& result) {
  require(!describe(result.outcome).empty(), "an outcome has words");
  const bool has_failed = result.outcome == drive::ProgramOutcome::kBusFailed;
  require(has_failed == (result.code != BusCode::kOk), "a code only if the bus failed");
}

ControllerSet set_from(Input& input) {
  ControllerSet set;
  (void)decode_into(set, input.bytes(kLargestSetSize));
  return set;
}

void operate(Input& input, drive::Joint& joint) {
  switch (input.u8() % 12) {
    case 0:
      return check_reading(joint.angle());
    case 1:
      return check_reading(joint.current());
    case 2:
      return check_reading(joint.status());
    case 3:
      return check_reading(joint.programming_status());
    case 4:
      return check_reading(joint.own_address());
    case 5:
      return check_reading(
          joint.controller_set(ControllerKind{static_cast<std::uint8_t>(input.u8() & 1)}));
    case 6:
      return check_programmed(joint.program(set_from(input)));
    case 7:
      return check_programmed(
          joint.tune({.kind = TuneKind{static_cast<std::uint8_t>(input.u8() % 3)},
                      .inertia = static_cast<float>(input.i16()) / 1000,
                      .pole = static_cast<float>(input.i16())}));
    default:
      (void)joint.send({static_cast<CommandId>(input.u8()), static_cast<float>(input.i16())});
  }
}

}  // namespace
}  // namespace armjig::fuzz::bus_drive

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace armjig;
  fuzz::Input input{std::as_bytes(std::span{data, size})};
  fuzz::bus_drive::HostileBus bus{input};
  morap::drive::Master master{bus};
  morap::drive::Joint joint{master, {fuzz::Input{input}.u8()}};
  for (int i = 0; i < fuzz::bus_drive::kMostOperations && !input.is_empty(); ++i) {
    fuzz::bus_drive::operate(input, joint);
  }
  return 0;
}
