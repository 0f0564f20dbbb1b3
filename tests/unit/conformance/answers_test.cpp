// SPDX-License-Identifier: Apache-2.0
// Benches judge the bytes that came, not what our decoders and encoders make of them.
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "conformance/kinovazed/server_bench.hpp"
#include "conformance/parol6/board_bench.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/link/memory_stream.hpp"

namespace armjig {
namespace {

/// A bench on a board in memory.
std::unique_ptr<parol6::conformance::BoardBench> board_bench() {
  auto bench = std::make_unique<parol6::conformance::BoardBench>(Rig<StreamPort>{
      std::make_unique<MemoryStream<parol6::emulation::Arm>>(parol6::emulation::Arm{})});
  bench->begin(Profile::kFirmware, 1);
  return bench;
}

TEST(Answers, OfABoardKeepTheBytesThatCame) {
  const auto board = board_bench();
  const auto answer = board->ask(parol6::conformance::idle());
  ASSERT_FALSE(board->is_over());
  // Start bytes and length, then, from docs/spec/parol6.md, check byte and end bytes.
  EXPECT_EQ(answer.raw[0], std::byte{0xFF});
  EXPECT_EQ(answer.raw[3], std::byte{56});
  EXPECT_EQ(answer.raw[57], std::byte{0xD4});
  EXPECT_EQ(answer.raw[58], std::byte{0x01});
  EXPECT_EQ(answer.raw[59], std::byte{0x02});
}

// A decoder that loses something, and an encoder that puts it back, would hide a wrong board.
TEST(Answers, OfABoardAreJudgedByTheirBytesAndNotByWhatWeMadeOfThem) {
  const auto board = board_bench();
  auto answer = board->ask(parol6::conformance::idle());
  answer.raw[57] = std::byte{0xE4};  // another check byte, decoded as the right one
  answer.check = 0xD4;
  board->expect(answer, "check", 0xD4);
  EXPECT_EQ(board->judgement().verdict, Verdict::kFail);
  EXPECT_EQ(board->judgement().actual, "check = 228 = 0xE4");
}

TEST(Answers, OfABoardAreNotJudgedByWrongDecoding) {
  const auto board = board_bench();
  auto answer = board->ask(parol6::conformance::idle());
  answer.speed[0] = StepsPerSecond{7};
  board->expect(answer, "speed.j1", 0);
  EXPECT_EQ(board->judgement().verdict, Verdict::kPass) << board->judgement().actual;
}

TEST(Answers, OfAServerAreTheWordThatCameWithCrLfAndNothingElse) {
  using kinovazed::Event;
  const kinovazed::conformance::Heard heard{.message = Event::kAccepted, .raw = "Accepted \r\n"};
  EXPECT_FALSE(heard.is(Event::kAccepted)) << "with a blank that decoding would have dropped";
  EXPECT_EQ(heard.text(), "Accepted ");
  EXPECT_TRUE((kinovazed::conformance::Heard{.message = Event::kRejected, .raw = "Accepted\r\n"})
                  .is(Event::kAccepted));
  EXPECT_FALSE((kinovazed::conformance::Heard{.message = Event::kAccepted, .raw = "Accepted\n"})
                   .is(Event::kAccepted));
}

}  // namespace
}  // namespace armjig
