// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/splitter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig::parol6 {
namespace {

using test::as_vector;
using test::ByteVector;
using test::hex;
using test::joined;

using Frames = std::vector<ByteVector>;

/// A frame or a fault, as a value that can be compared and printed.
struct Found {
  ByteVector frame;  ///< empty for a fault
  Splitter::FaultKind kind{};
  std::uint8_t value{};

  friend bool operator==(const Found&, const Found&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Found& found) {
    if (!found.frame.empty()) return out << "frame " << to_hex_dump(found.frame);
    return out << "fault " << static_cast<int>(found.kind) << " value " << int{found.value};
  }
};

Found frame(ByteVector bytes) { return {.frame = std::move(bytes), .kind = {}, .value = {}}; }
Found fault(Splitter::FaultKind kind, std::uint8_t value) {
  return {.frame = {}, .kind = kind, .value = value};
}

/// Feeds one piece and appends what is found in it.
void feed(Splitter& splitter, Bytes piece, std::vector<Found>& found) {
  while (!piece.empty()) {
    const auto step = splitter.step(piece);
    ASSERT_GT(step.used, 0U);
    ASSERT_LE(step.used, piece.size());
    if (const auto* whole = std::get_if<Splitter::Frame>(&step.found)) {
      found.push_back(frame(as_vector(whole->bytes)));
    } else if (const auto* wrong = std::get_if<Splitter::Fault>(&step.found)) {
      found.push_back(fault(wrong->kind, wrong->value));
    } else {
      ASSERT_EQ(step.used, piece.size()) << "stopped without a reason";
    }
    piece = piece.subspan(step.used);
  }
}

std::vector<Found> split(Splitter splitter, Bytes stream) {
  std::vector<Found> found;
  feed(splitter, stream, found);
  return found;
}

std::vector<Found> split_by_bytes(Splitter splitter, Bytes stream) {
  std::vector<Found> found;
  for (std::size_t i = 0; i < stream.size(); ++i) feed(splitter, stream.subspan(i, 1), found);
  return found;
}

Frames frames_in(const std::vector<Found>& found) {
  Frames frames;
  for (const auto& one : found) {
    if (!one.frame.empty()) frames.push_back(one.frame);
  }
  return frames;
}

const Splitter kCommands{kCommandPayloadSize};
const Splitter kTelemetry{kTelemetryPayloadSize};
using enum Splitter::FaultKind;

TEST(Splitter, FindsEveryCommandOfTheReference) {
  for (const auto& command :
       {vectors::kJogCommand, vectors::kFirstCommand, vectors::kIdleCommand,
        vectors::kStandbyCommand, vectors::kPlannedCommand, vectors::kGripperCommand}) {
    EXPECT_EQ(split(kCommands, command), std::vector{frame(command)});
  }
}

TEST(Splitter, FindsEveryTelemetryFrameOfTheReference) {
  for (const auto& telemetry : {vectors::kRestTelemetry, vectors::kDocumentTelemetry}) {
    EXPECT_EQ(split(kTelemetry, telemetry), std::vector{frame(telemetry)});
  }
}

TEST(Splitter, FindsNothingInNothing) {
  Splitter splitter{kCommandPayloadSize};
  const auto step = splitter.step({});
  EXPECT_EQ(step.used, 0U);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(step.found));
}

TEST(Splitter, FindsFramesBackToBack) {
  const auto stream = joined(vectors::kJogCommand, vectors::kIdleCommand, vectors::kFirstCommand);
  EXPECT_EQ(split(kCommands, stream),
            (std::vector{frame(vectors::kJogCommand), frame(vectors::kIdleCommand),
                         frame(vectors::kFirstCommand)}));
}

TEST(Splitter, WaitsForTheRestAtEveryLength) {
  const auto& whole = vectors::kJogCommand;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Splitter splitter{kCommandPayloadSize};
    std::vector<Found> found;
    feed(splitter, Bytes{whole}.first(size), found);
    EXPECT_TRUE(found.empty()) << size;
    EXPECT_EQ(splitter.held(), size);
    feed(splitter, Bytes{whole}.subspan(size), found);
    EXPECT_EQ(found, std::vector{frame(whole)}) << size;
    EXPECT_EQ(splitter.held(), 0U);
  }
}

TEST(Splitter, FindsTheFrameBehindATruncatedOneOfEveryLength) {
  const auto& whole = vectors::kJogCommand;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto stream = joined(as_vector(Bytes{whole}.first(size)), vectors::kIdleCommand);
    const auto frames = frames_in(split(kCommands, stream));
    ASSERT_EQ(frames.size(), 1U) << size;
    EXPECT_EQ(frames[0], vectors::kIdleCommand) << size;
  }
}

TEST(Splitter, FindsTheFrameBehindARunOfStartBytesOfAnyLength) {
  for (std::size_t size = 1; size <= 200; ++size) {
    const auto stream = joined(ByteVector(size, kStartByte), vectors::kIdleCommand);
    EXPECT_EQ(split(kCommands, stream), std::vector{frame(vectors::kIdleCommand)}) << size;
    EXPECT_EQ(split_by_bytes(kCommands, stream), std::vector{frame(vectors::kIdleCommand)}) << size;
  }
}

TEST(Splitter, FindsTheFrameBehindFalseStarts) {
  for (const auto* start : {"FF", "FF FF", "FF FF FF", "FF FF FF 34", "FF FF FF 33", "FF FF FF 00",
                            "FF FF FF 34 FF FF FF 34", "FF FF 34", "FF FF FF 34 01 02",
                            "01 02 03 00 FF 07 FF FF 09"}) {  // the last one: R8
    const auto stream = joined(hex(start), vectors::kIdleCommand);
    const auto frames = frames_in(split(kCommands, stream));
    EXPECT_EQ(frames, Frames{vectors::kIdleCommand}) << start;
  }
}

TEST(Splitter, FindsTheFrameInsideACandidateThatWasNone) {
  // The first header promises 52 bytes of payload, in which a good frame begins.
  const auto stream = joined(hex("FF FF FF 34 11 22 33"), vectors::kIdleCommand);
  EXPECT_EQ(split(kCommands, stream),
            (std::vector{fault(kWrongEnd, 0x00), frame(vectors::kIdleCommand)}));
}

TEST(Splitter, NamesTheWrongLength) {
  EXPECT_EQ(split(kCommands, hex("FF FF FF 38")), std::vector{fault(kWrongLength, 0x38)});
  EXPECT_EQ(split(kTelemetry, hex("FF FF FF 34")), std::vector{fault(kWrongLength, 0x34)});
}

TEST(Splitter, NamesTheFirstWrongEndByte) {
  auto command = vectors::kIdleCommand;
  command[55] = std::byte{0x03};  // R2
  EXPECT_EQ(split(kCommands, command), std::vector{fault(kWrongEnd, 0x03)});
  command[54] = std::byte{0x07};
  EXPECT_EQ(split(kCommands, command), std::vector{fault(kWrongEnd, 0x07)});
}

TEST(Splitter, JudgesTheCheckByteAsTold) {
  const auto with_check = [](std::uint8_t check) {
    auto command = vectors::kIdleCommand;
    command[53] = std::byte{check};
    return command;
  };
  const auto is_taken = [&](CheckPolicy policy, std::uint8_t check) {
    const auto found = split(Splitter{kCommandPayloadSize, policy}, with_check(check));
    const auto expected = found.size() == 1 && found[0].frame.empty() ? fault(kWrongCheck, check)
                                                                      : frame(with_check(check));
    EXPECT_EQ(found, std::vector{expected});
    return !found[0].frame.empty();
  };
  for (int check = 0; check <= 255; ++check) {
    const auto value = static_cast<std::uint8_t>(check);
    EXPECT_TRUE(is_taken(CheckPolicy::kIgnore, value)) << check;
    EXPECT_EQ(is_taken(CheckPolicy::kBoardOnly, value), value == 0xD4) << check;
    EXPECT_EQ(is_taken(CheckPolicy::kBoardOrHost, value), value == 0xD4 || value == 0xE4) << check;
  }
}

TEST(Splitter, LosesNoGoodFrameBehindAnyGarbage) {
  // The good frame has no 01 02 inside: else no receiver could tell it from a false one's end.
  test::for_all([](const std::vector<std::uint8_t>& numbers) {
    ByteVector garbage;
    for (const auto number : numbers) garbage.push_back(std::byte{number});
    const auto frames = frames_in(split(kCommands, joined(garbage, vectors::kIdleCommand)));
    RC_ASSERT(!frames.empty());
    RC_ASSERT(frames.back() == vectors::kIdleCommand);
  });
}

// Short frames of few different bytes: nearly everything in such a stream looks like a start, a
// length or an end.
constexpr std::size_t kShortPayload = 5;

rc::Gen<ByteVector> confusing_stream() {
  return rc::gen::container<ByteVector>(rc::gen::map(
      rc::gen::weightedElement<int>(
          {{6, 0xFF}, {3, int{kShortPayload}}, {3, 0x01}, {3, 0x02}, {1, 0xD4}, {1, 0xE4}}),
      [](int number) { return static_cast<std::byte>(number); }));
}

/// The same search without any memory of what was seen: tries each place in turn.
Frames frames_found_by_trying(const ByteVector& stream, CheckPolicy policy) {
  constexpr std::size_t kFrame = kHeaderSize + kShortPayload;
  Frames frames;
  for (std::size_t place = 0; place + kFrame <= stream.size();) {
    const auto candidate = Bytes{stream}.subspan(place, kFrame);
    const auto check = std::to_integer<int>(candidate[kFrame - 3]);
    const bool is_frame = std::ranges::equal(candidate.first(4), hex("FF FF FF 05")) &&
                          std::ranges::equal(candidate.last(2), hex("01 02")) &&
                          (policy == CheckPolicy::kIgnore || check == 0xD4 ||
                           (policy == CheckPolicy::kBoardOrHost && check == 0xE4));
    if (is_frame) frames.push_back(as_vector(candidate));
    place += is_frame ? kFrame : 1;
  }
  return frames;
}

TEST(Splitter, FindsWhatTryingEachPlaceFinds) {
  for (const auto policy :
       {CheckPolicy::kIgnore, CheckPolicy::kBoardOnly, CheckPolicy::kBoardOrHost}) {
    test::for_all(
        [policy] {
          const auto stream = *confusing_stream();
          const auto frames = frames_in(split(Splitter{kShortPayload, policy}, stream));
          RC_ASSERT(frames == frames_found_by_trying(stream, policy));
        },
        2000);
  }
}

TEST(Splitter, FindsTheSameHoweverTheStreamIsCut) {
  test::for_all(
      [] {
        const auto stream = *confusing_stream();
        const Splitter splitter{kShortPayload, CheckPolicy::kBoardOnly};
        const auto whole = split(splitter, stream);
        RC_ASSERT(split_by_bytes(splitter, stream) == whole);

        auto in_pieces = splitter;
        std::vector<Found> found;
        auto rest = Bytes{stream};
        while (!rest.empty()) {
          const auto size = *rc::gen::inRange<std::size_t>(1, rest.size() + 1);
          feed(in_pieces, rest.first(size), found);
          rest = rest.subspan(size);
        }
        RC_ASSERT(found == whole);
      },
      2000);
}

TEST(Splitter, HoldsTheSameHoweverTheStreamIsCut) {
  test::for_all(
      [] {
        const auto stream = *confusing_stream();
        Splitter whole{kShortPayload};
        Splitter by_bytes{kShortPayload};
        std::vector<Found> ignored;
        feed(whole, stream, ignored);
        for (std::size_t i = 0; i < stream.size(); ++i) {
          feed(by_bytes, Bytes{stream}.subspan(i, 1), ignored);
        }
        RC_ASSERT(by_bytes.held() == whole.held());
        RC_ASSERT(whole.held() < kHeaderSize + kShortPayload);
      },
      2000);
}

TEST(Splitter, FindsFramesInTheMidstOfAMegabyteOfNoise) {
  test::Dice dice{1};
  ByteVector noise(1 << 20);
  for (auto& byte : noise) byte = static_cast<std::byte>(dice.between(0, 254));
  const auto stream = joined(noise, vectors::kIdleCommand, noise, vectors::kJogCommand);
  EXPECT_EQ(frames_in(split(kCommands, stream)),
            (Frames{vectors::kIdleCommand, vectors::kJogCommand}));
}

}  // namespace
}  // namespace armjig::parol6
