// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "emulators/parol6/firmware_receiver.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/splitter.hpp"
#include "tests/unit/support/allocations.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig::parol6 {
namespace {

using test::ByteVector;

/// A megabyte of frames, damaged frames and noise.
ByteVector traffic() {
  test::Dice dice{41};
  ByteVector stream;
  while (stream.size() < 1'000'000) {
    auto frame = vectors::kJogCommand;
    if (dice.one_in(3)) frame[static_cast<std::size_t>(dice.between(0, 55))] = dice.byte();
    if (dice.one_in(10)) frame.resize(static_cast<std::size_t>(dice.between(1, 55)));
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  return stream;
}

TEST(Heap, CountsAllocationsOfThisProgram) {
  const auto before = test::allocations();
  const ByteVector bytes(100);
  // Somebody must look at it, or Clang leaves the allocation out.
  const std::byte* volatile seen = bytes.data();
  EXPECT_NE(seen, nullptr);
  EXPECT_EQ(test::allocations(), before + 1);
}

TEST(Heap, IsNotTouchedByDecodingAndEncoding) {
  const auto frame = Bytes{vectors::kJogCommand}.first<kCommandFrameSize>();
  const auto answer = Bytes{vectors::kRestTelemetry}.first<kTelemetryFrameSize>();
  const auto before = test::allocations();
  int sum = 0;
  for (int i = 0; i < 1000; ++i) {
    sum += std::to_integer<int>(encode(decode_command(body_of(frame)))[55]);
    sum += std::to_integer<int>(encode(decode_telemetry(body_of(answer)))[59]);
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(sum, 4000);
}

TEST(Heap, IsNotTouchedBySplitting) {
  const auto stream = traffic();
  Splitter splitter{kCommandPayloadSize};
  std::size_t frames = 0;
  const auto before = test::allocations();
  for (auto rest = Bytes{stream}; !rest.empty();) {
    const auto step = splitter.step(rest.first(std::min<std::size_t>(rest.size(), 100)));
    rest = rest.subspan(step.used);
    if (std::holds_alternative<Splitter::Frame>(step.found)) ++frames;
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(frames, 10'000U);
}

TEST(Heap, IsNotTouchedByTheFirmwareReceiver) {
  const auto stream = traffic();
  emulation::FirmwareReceiver receiver;
  std::size_t frames = 0;
  const auto before = test::allocations();
  for (auto rest = Bytes{stream}; !rest.empty();) {
    const auto step = receiver.step(rest);
    rest = rest.subspan(step.used);
    if (step.accepted) ++frames;
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(frames, 1'000U);
}

}  // namespace
}  // namespace armjig::parol6
