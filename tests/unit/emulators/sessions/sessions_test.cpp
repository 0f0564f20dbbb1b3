// SPDX-License-Identifier: Apache-2.0
// Sessions drawn at random are recordings, the same ones everywhere, and no emulator leaps over
// what its plain model would do.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "tests/unit/emulators/sessions/drawn_session.hpp"

namespace armjig::test {
namespace {

class Sessions : public testing::TestWithParam<DrawnDevice> {};

/// FNV-1a.
std::uint64_t hash_of(std::uint64_t hash, std::string_view text) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  return hash;
}

TEST_P(Sessions, AreTheSameTextWithEveryCompiler) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (std::uint64_t seed = 0; seed < 40; ++seed) hash = hash_of(hash, GetParam().draw(seed));
  EXPECT_EQ(hash, GetParam().hash) << std::hex << hash;
}

TEST_P(Sessions, OfAnotherSeedAreOthers) {
  std::set<std::string> texts;
  for (std::uint64_t seed = 0; seed < 40; ++seed) texts.insert(GetParam().draw(seed));
  EXPECT_EQ(texts.size(), 40U);
}

TEST_P(Sessions, AreRecordingsThatVerify) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    EXPECT_EQ(complaint_about_recording(GetParam(), seed), "") << "seed " << seed;
  }
}

TEST_P(Sessions, AreTheSameInThePlainModel) {
  for (std::uint64_t seed = 1000; seed < 1025; ++seed) {
    EXPECT_EQ(complaint_about_plain_model(GetParam(), seed), "") << "seed " << seed;
  }
}

/// Bytes that a fuzzer may give.
std::vector<std::byte> choices(std::uint64_t seed, std::size_t size) {
  sessions::Dice dice{seed};
  return dice.bytes(static_cast<std::int64_t>(size), static_cast<std::int64_t>(size));
}

TEST_P(Sessions, AreWhatFellIfTheDiceAreLoaded) {
  std::set<std::string> texts;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto bytes = choices(seed, 200);
    const auto text = GetParam().draw(Roll{bytes, std::chrono::seconds{5}});
    EXPECT_EQ(text, GetParam().draw(Roll{bytes, std::chrono::seconds{5}}));
    EXPECT_EQ(complaint_about_recording(GetParam(), Roll{bytes, std::chrono::seconds{5}}), "");
    texts.insert(text);
  }
  EXPECT_EQ(texts.size(), 20U);
}

TEST_P(Sessions, GrowWithTheBytesThatSayThem) {
  const auto bytes = choices(1, 400);
  const auto lines_of = [&](std::size_t size) {
    return std::ranges::count(GetParam().draw(Roll{Bytes{bytes}.first(size), Duration::max()}),
                              '\n');
  };
  EXPECT_LT(lines_of(40), lines_of(400));
}

/// In that session a message came in the very moment of the client's next line.
TEST(KinovazedSession, IsRecordedInOrderAlsoWithinAMillisecond) {
  EXPECT_EQ(complaint_about_recording(kDrawnDevices[2], 1'000'430), "");
}

/// A byte of the answers is not what it was: a recording that nobody could tell from its session
/// would pass everything above.
TEST_P(Sessions, AreFoundToDifferInAByte) {
  const auto is_answer = [](const TraceEvent& event) {
    return (event.dir == "from_device" || event.dir == "read") && !event.bytes.empty();
  };
  auto trace = parse_trace("drawn", recording_of(GetParam(), 0).value_or(""));
  for (std::uint64_t seed = 1; trace && std::ranges::none_of(trace->events, is_answer); ++seed) {
    trace = parse_trace("drawn", recording_of(GetParam(), seed).value_or(""));
  }
  ASSERT_TRUE(trace);
  const auto answer = std::ranges::find_if(trace->events, is_answer);
  answer->bytes.back() ^= std::byte{1};
  const auto difference = verify(*trace, recorded_device(*trace)->replay);
  ASSERT_TRUE(difference);
  EXPECT_TRUE(difference->has_value());
}

INSTANTIATE_TEST_SUITE_P(Drawn, Sessions, testing::ValuesIn(kDrawnDevices),
                         [](const auto& tested) { return std::string{tested.param.name}; });

}  // namespace
}  // namespace armjig::test
