// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/firmware_receiver.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig::parol6::emulation {
namespace {

using test::as_vector;
using test::ByteVector;
using test::hex;
using test::joined;
using test::zeros;

/// An accepted frame: where in the stream it ended and what the board would unpack then.
struct Accepted {
  std::size_t end{};
  ByteVector body;

  friend bool operator==(const Accepted&, const Accepted&) = default;
};

void feed(FirmwareReceiver& receiver, Bytes piece, std::size_t place,
          std::vector<Accepted>& accepted) {
  while (!piece.empty()) {
    const auto step = receiver.step(piece);
    ASSERT_GT(step.used, 0U);
    piece = piece.subspan(step.used);
    place += step.used;
    if (step.accepted) {
      accepted.push_back({place, as_vector(receiver.body())});
    } else {
      ASSERT_TRUE(piece.empty()) << "stopped without a reason";
    }
  }
}

std::vector<Accepted> receive(Bytes stream) {
  FirmwareReceiver receiver;
  std::vector<Accepted> accepted;
  feed(receiver, stream, 0, accepted);
  return accepted;
}

std::size_t answers_to(Bytes stream) { return receive(stream).size(); }

CommandFrame unpacked(const Accepted& frame) {
  return decode_command(Bytes{frame.body}.first<kCommandBodySize>());
}

const ByteVector& good() { return vectors::kIdleCommand; }

/// A frame of any length with that end.
ByteVector frame_of(std::size_t length, std::string_view end = "01 02") {
  const auto tail = hex(end);
  auto bytes = hex("FF FF FF");
  bytes.push_back(static_cast<std::byte>(length));
  for (std::size_t i = tail.size(); i < length; ++i) bytes.push_back(std::byte{0x11});
  return joined(std::move(bytes), tail);
}

ByteVector repetition(const ByteVector& bytes, int times) {
  ByteVector all;
  for (int i = 0; i < times; ++i) all = joined(std::move(all), bytes);
  return all;
}

TEST(FirmwareReceiver, AcceptsEveryCommandOfTheReference) {
  for (const auto& command :
       {vectors::kJogCommand, vectors::kFirstCommand, vectors::kIdleCommand,
        vectors::kStandbyCommand, vectors::kPlannedCommand, vectors::kGripperCommand}) {
    const auto accepted = receive(command);
    ASSERT_EQ(accepted.size(), 1U);
    EXPECT_EQ(accepted[0].body, as_vector(Bytes{command}.subspan(4, 50)));
  }
}

// The rows of section 2.2.

TEST(FirmwareReceiver, DoesNotLookAtTheCheckByte) {  // R1
  for (int check = 0; check <= 255; ++check) {
    auto frame = good();
    frame[53] = static_cast<std::byte>(check);
    EXPECT_EQ(answers_to(frame), 1U) << check;
  }
}

TEST(FirmwareReceiver, DropsAFrameWithWrongEndBytesAndTakesTheNext) {  // R2
  for (const auto* end : {"01 03", "00 02", "02 01", "FF FF"}) {
    EXPECT_EQ(answers_to(joined(frame_of(52, end), good())), 1U) << end;
  }
}

TEST(FirmwareReceiver, TakesAFourthStartByteForTheLength) {  // R3
  const auto one_byte_early = joined(hex("FF"), good());
  EXPECT_EQ(answers_to(one_byte_early), 0U);
  EXPECT_EQ(answers_to(joined(one_byte_early, zeros(201), good())), 0U);
  EXPECT_EQ(answers_to(joined(one_byte_early, zeros(202), good())), 1U);
  EXPECT_EQ(answers_to(joined(one_byte_early, zeros(203), good())), 1U);
}

TEST(FirmwareReceiver, LosesFiveFramesToOneStrayStartByte) {
  // The first, three whole ones and 34 bytes of the fifth; the sixth is the first to be answered.
  EXPECT_EQ(answers_to(joined(hex("FF"), repetition(good(), 5))), 0U);
  EXPECT_EQ(answers_to(joined(hex("FF"), repetition(good(), 6))), 1U);
  EXPECT_EQ(answers_to(joined(hex("FF"), repetition(good(), 8))), 3U);
}

TEST(FirmwareReceiver, IsDeafForTwelveFramesAfterLengthZero) {  // R11
  EXPECT_EQ(answers_to(joined(hex("FF FF FF 00"), repetition(good(), 12))), 0U);
}

TEST(FirmwareReceiver, TakesTheLengthFromThe256thByteAfterLengthZero) {
  // The 256th byte says that 2 more follow; they are end bytes, so that is an accepted frame.
  const auto accepted = receive(joined(hex("FF FF FF 00"), zeros(255), hex("02 01 02")));
  ASSERT_EQ(accepted.size(), 1U);
  EXPECT_EQ(accepted[0].end, 4U + 256 + 2);
}

TEST(FirmwareReceiver, LosesAnother256BytesIfThe256thIsZero) {
  const auto deaf = joined(hex("FF FF FF 00"), zeros(256));
  EXPECT_EQ(answers_to(joined(deaf, repetition(good(), 4))), 0U);
  // 256 more, then two bytes of payload that are no end; after that the parser is idle.
  EXPECT_EQ(answers_to(joined(deaf, zeros(255), hex("02 00 00"), good())), 1U);
}

TEST(FirmwareReceiver, KeepsWhatItSwallowedAfterLengthZero) {
  auto swallowed = zeros(255);
  for (std::size_t i = 0; i < swallowed.size(); ++i) swallowed[i] = static_cast<std::byte>(i);
  const auto accepted = receive(joined(hex("FF FF FF 00"), swallowed, hex("02 01 02")));
  ASSERT_EQ(accepted.size(), 1U);
  const auto expected = joined(hex("01 02"), as_vector(Bytes{swallowed}.subspan(2, 48)));
  EXPECT_EQ(accepted[0].body, expected);
}

TEST(FirmwareReceiver, AlwaysDropsLengthOne) {  // R12
  EXPECT_EQ(answers_to(hex("FF FF FF 01 02")), 0U);
  EXPECT_EQ(answers_to(hex("FF FF FF 01 01")), 0U);
  EXPECT_EQ(answers_to(joined(hex("FF FF FF 01 02"), good())), 1U);
  EXPECT_EQ(receive(joined(hex("FF FF FF 01 77"), hex("FF FF FF 02 01 02")))[0].body[0],
            std::byte{0x01});
}

TEST(FirmwareReceiver, AcceptsSixBytesAsACompletePoll) {  // R4
  const auto accepted = receive(hex("FF FF FF 02 01 02"));
  ASSERT_EQ(accepted.size(), 1U);
  EXPECT_EQ(unpacked(accepted[0]).position[0], Steps{66048});
}

TEST(FirmwareReceiver, FillsAShortFrameFromTheOnesBefore) {  // R4
  const auto accepted = receive(joined(vectors::kJogCommand, hex("FF FF FF 02 01 02")));
  ASSERT_EQ(accepted.size(), 2U);
  auto expected = unpacked(accepted[0]);
  expected.position[0] = Steps{0x010200};  // third byte of 10240 = 00 28 00
  EXPECT_EQ(unpacked(accepted[1]), expected);
  EXPECT_EQ(unpacked(accepted[1]).command, Command::kJog);
}

TEST(FirmwareReceiver, ReadsTheEndBytesOfAShortFrameAsData) {  // R5
  const auto accepted = receive(hex("FF FF FF 03 09 01 02"));
  ASSERT_EQ(accepted.size(), 1U);
  EXPECT_EQ(unpacked(accepted[0]).position[0], Steps{590082});
}

TEST(FirmwareReceiver, AcceptsEveryLengthFrom2To255WithItsEndBytes) {
  for (std::size_t length = 2; length <= 255; ++length) {
    EXPECT_EQ(answers_to(frame_of(length)), 1U) << length;
    EXPECT_EQ(answers_to(frame_of(length, "02 02")), 0U) << length;
    EXPECT_EQ(answers_to(joined(frame_of(length, "02 02"), good())), 1U) << length;
  }
}

TEST(FirmwareReceiver, AcceptsAFrameThatIsOneByteShortAndSaysSo) {  // R6
  auto frame = good();
  frame.erase(frame.begin() + 20);
  frame[3] = std::byte{51};
  EXPECT_EQ(answers_to(frame), 1U);
}

TEST(FirmwareReceiver, UsesTheFirstFiftyBytesOfALongFrame) {  // R7
  auto frame = vectors::kJogCommand;
  frame[3] = std::byte{60};
  frame.insert(frame.begin() + 54, 8, std::byte{0x55});
  const auto accepted = receive(frame);
  ASSERT_EQ(accepted.size(), 1U);
  EXPECT_EQ(unpacked(accepted[0]), unpacked(receive(vectors::kJogCommand)[0]));
}

TEST(FirmwareReceiver, PassesOverNoiseBetweenFrames) {  // R8
  EXPECT_EQ(answers_to(joined(hex("01 02 03 00 FF 07 FF FF 09"), good())), 1U);
}

TEST(FirmwareReceiver, TakesWhatATruncatedFrameMissesFromTheNextOne) {  // R9
  const auto truncated = as_vector(Bytes{good()}.first(30));
  EXPECT_EQ(answers_to(joined(truncated, repetition(good(), 1))), 0U);
  EXPECT_EQ(answers_to(joined(truncated, repetition(good(), 2))), 1U);
  EXPECT_EQ(answers_to(joined(truncated, repetition(good(), 3))), 2U);
}

TEST(FirmwareReceiver, IgnoresAFrameWithoutItsFirstByte) {  // R10
  const auto rest = as_vector(Bytes{good()}.subspan(1));
  EXPECT_EQ(answers_to(rest), 0U);
  EXPECT_EQ(answers_to(joined(rest, good())), 1U);
}

TEST(FirmwareReceiver, AcceptsEveryFrameOfABurst) {
  EXPECT_EQ(answers_to(repetition(good(), 20)), 20U);
}

TEST(FirmwareReceiver, WaitsForTheRestAtEveryLength) {
  for (std::size_t size = 0; size < good().size(); ++size) {
    FirmwareReceiver receiver;
    std::vector<Accepted> accepted;
    feed(receiver, Bytes{good()}.first(size), 0, accepted);
    EXPECT_TRUE(accepted.empty()) << size;
    feed(receiver, Bytes{good()}.subspan(size), size, accepted);
    EXPECT_EQ(accepted.size(), 1U) << size;
  }
}

/// Section 2.1, one byte at a time, in the memory layout that section 2.2 gives: the counter lies
/// in front of the store, the length behind it.
class StateTable {
 public:
  /// True if the byte ended an accepted frame.
  bool take(std::uint8_t byte) {
    switch (state_) {
      case State::kIdle:
        state_ = byte == 0xFF ? State::kOne : State::kIdle;
        return false;
      case State::kOne:
        state_ = byte == 0xFF ? State::kTwo : State::kIdle;
        return false;
      case State::kTwo:
        state_ = byte == 0xFF ? State::kThree : State::kIdle;
        return false;
      case State::kThree:
        length() = byte;
        counter() = 0;
        state_ = State::kPayload;
        return false;
      case State::kPayload:
        break;
    }
    const bool is_last = int{counter()} == int{length()} - 1;
    if (!is_last) {
      // n = (n + 1) mod 256; at n = 255 the byte lands in `length`.
      const auto place = counter();
      at(place) = byte;
      counter() = static_cast<std::uint8_t>(place + 1);
      return false;
    }
    at(counter()) = byte;
    const bool accepted = at(length() - 2) == 0x01 && at(length() - 1) == 0x02;
    length() = 0;
    counter() = 0;
    state_ = State::kIdle;
    return accepted;
  }

  [[nodiscard]] ByteVector body() const {
    ByteVector body;
    for (std::size_t i = 0; i < 50; ++i) body.push_back(std::byte{memory_[1 + i]});
    return body;
  }

 private:
  enum class State : std::uint8_t { kIdle, kOne, kTwo, kThree, kPayload };

  std::uint8_t& counter() { return memory_[0]; }
  std::uint8_t& length() { return memory_[256]; }
  std::uint8_t& at(int place) { return memory_[static_cast<std::size_t>(place + 1)]; }

  State state_ = State::kIdle;
  std::array<std::uint8_t, 257> memory_{};
};

std::vector<Accepted> receive_by_table(const ByteVector& stream) {
  StateTable table;
  std::vector<Accepted> accepted;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (table.take(std::to_integer<std::uint8_t>(stream[i]))) {
      accepted.push_back({i + 1, table.body()});
    }
  }
  return accepted;
}

/// Pieces that begin, end, prolong and spoil frames, of all lengths.
ByteVector confusing_stream(test::Dice& dice) {
  ByteVector stream;
  const auto pieces = dice.between(1, 30);
  for (std::int64_t piece = 0; piece < pieces; ++piece) {
    switch (dice.between(0, 6)) {
      case 0:
        stream = joined(std::move(stream), good());
        break;
      case 1:
        stream =
            joined(std::move(stream), frame_of(static_cast<std::size_t>(dice.between(2, 255))));
        break;
      case 2:
        stream = joined(std::move(stream),
                        ByteVector(static_cast<std::size_t>(dice.between(1, 5)), kStartByte));
        break;
      case 3:
        stream = joined(std::move(stream), hex("FF FF FF"), ByteVector{dice.byte()});
        break;
      case 4:
        stream = joined(std::move(stream), hex("01 02"));
        break;
      case 5:
        stream = joined(std::move(stream), hex("FF FF FF 00"));
        break;
      default:
        for (auto size = dice.between(1, 300); size > 0; --size) {
          stream.push_back(dice.one_in(8) ? kStartByte : dice.byte());
        }
        break;
    }
  }
  return stream;
}

TEST(FirmwareReceiver, DoesWhatTheStateTableDoes) {
  test::Dice dice{21};
  std::size_t frames = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto stream = confusing_stream(dice);
    const auto accepted = receive(stream);
    ASSERT_EQ(accepted, receive_by_table(stream)) << to_hex_dump(stream);
    frames += accepted.size();
  }
  EXPECT_GT(frames, 1000U) << "the streams have too few frames to show anything";
}

TEST(FirmwareReceiver, AcceptsTheSameHoweverTheStreamIsCut) {
  test::Dice dice{22};
  for (int round = 0; round < 1000; ++round) {
    const auto stream = confusing_stream(dice);
    FirmwareReceiver receiver;
    std::vector<Accepted> accepted;
    const auto longest = dice.one_in(2) ? 1 : dice.between(2, 100);
    for (std::size_t place = 0; place < stream.size();) {
      const auto size = std::min<std::size_t>(static_cast<std::size_t>(dice.between(1, longest)),
                                              stream.size() - place);
      feed(receiver, Bytes{stream}.subspan(place, size), place, accepted);
      place += size;
    }
    ASSERT_EQ(accepted, receive(stream)) << to_hex_dump(stream);
  }
}

}  // namespace
}  // namespace armjig::parol6::emulation
