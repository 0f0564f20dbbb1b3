// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/shrink.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "harness/wire/demo/demo.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

KeptRecord byte_at(Duration time, unsigned value) {
  return {.time = Instant{time},
          .kind = LinkKind::kStream,
          .direction = Direction::kToDevice,
          .bytes = {static_cast<std::byte>(value)}};
}

Script bytes_up_to(unsigned count) {
  Script script;
  for (unsigned i = 0; i < count; ++i) script.push_back(byte_at(i * 10ms, i));
  return script;
}

bool has(const Script& script, unsigned value) {
  return std::ranges::any_of(script, [value](const KeptRecord& one) {
    return std::ranges::count(one.bytes, static_cast<std::byte>(value)) > 0;
  });
}

const auto kAlways = [] { return true; };

TEST(Shrink, LeavesWhatMatters) {
  const auto shorter = shrink(
      bytes_up_to(100), {}, demo::make_dissector,
      [](const Script& one) { return has(one, 17) && has(one, 83); }, kAlways);
  ASSERT_EQ(shorter.size(), 2U);
  EXPECT_TRUE(has(shorter, 17));
  EXPECT_TRUE(has(shorter, 83));
}

TEST(Shrink, ShortensPausesThatDoNotMatter) {
  const auto shorter = shrink(
      bytes_up_to(3), {}, demo::make_dissector, [](const Script& one) { return one.size() == 3; },
      kAlways);
  EXPECT_EQ(length_of(shorter), 2ms);
}

TEST(Shrink, ShortensMessages) {
  Script script{byte_at({}, 1)};
  script.front().bytes.assign(40, std::byte{7});
  const auto shorter = shrink(
      script, {}, demo::make_dissector, [](const Script& one) { return has(one, 7); }, kAlways);
  ASSERT_EQ(shorter.size(), 1U);
  EXPECT_EQ(shorter.front().bytes.size(), 1U);
}

std::size_t bytes_in(const Script& script) {
  std::size_t count = 0;
  for (const auto& record : script) count += record.bytes.size();
  return count;
}

TEST(Shrink, PutsTogetherWhatOnlyCountsBytes) {
  Script script;
  for (unsigned i = 0; i < 300; ++i) {
    script.push_back(byte_at(i * 10ms, i));
    script.back().bytes.assign(40, static_cast<std::byte>(i));
  }
  const auto shorter = shrink(
      script, {}, demo::make_dissector, [](const Script& one) { return bytes_in(one) >= 10'000; },
      kAlways);
  EXPECT_LE(shorter.size(), 3U);
}

/// Live an attempt takes seconds.
TEST(Shrink, JoinsThePiecesOfAllMessagesAtOnce) {
  constexpr std::size_t kMessages = 300;
  Script script;
  const auto whole = demo::encode(demo::Operation::kQuery);
  for (std::size_t i = 0; i < kMessages; ++i) {
    const auto time = i * 10ms;
    script.push_back(byte_at(time, 0));
    script.back().bytes.assign(whole.begin(), whole.begin() + 2);
    script.push_back(byte_at(time + 1ms, 0));
    script.back().bytes.assign(whole.begin() + 2, whole.end());
  }
  const auto all = bytes_in(script);
  int attempts = 0;
  const auto shorter = shrink(
      script, {}, demo::make_dissector,
      [&](const Script& one) {
        ++attempts;
        return bytes_in(one) == all;
      },
      [&] { return attempts < 40; });
  EXPECT_LE(shorter.size(), kMessages);
}

TEST(Shrink, LeavesOutAllThatAreAlikeAtOnce) {
  Script script;
  for (unsigned i = 0; i < 1'000; ++i) script.push_back(byte_at(i * 1ms, i % 2));
  int attempts = 0;
  const auto shorter = shrink(
      script, {}, demo::make_dissector,
      [&](const Script& one) {
        ++attempts;
        return std::ranges::count_if(one, [](const KeptRecord& record) {
                 return record.bytes.front() == std::byte{1};
               }) == 500;
      },
      kAlways);
  EXPECT_EQ(shorter.size(), 500U);
  EXPECT_LT(attempts, 3'000);
}

std::vector<std::vector<std::byte>> bytes_of_last(const Script& script, std::size_t count) {
  std::vector<std::vector<std::byte>> last;
  for (auto i = script.size() - std::min(script.size(), count); i < script.size(); ++i) {
    last.push_back(script[i].bytes);
  }
  return last;
}

Duration length_between_last(const Script& script) {
  return script.back().time - script[script.size() - 2].time;
}

/// Live each try takes as long as the script, and there is time for few.
TEST(Shrink, CutsTheBeginningOfALongOneEarly) {
  constexpr unsigned kKinds = 23;
  constexpr std::size_t kMatter = 14;  // more than is tried after plain ones
  Script script;
  for (unsigned i = 0; i < 1'000; ++i) script.push_back(byte_at(i * 10ms, i % kKinds));
  const auto end = bytes_of_last(script, kMatter);
  Duration tried{};
  const auto shorter = shrink(
      script, {byte_at({}, 200)}, demo::make_dissector,
      [&](const Script& one) {
        tried += length_of(one);
        return bytes_of_last(one, kMatter) == end && length_between_last(one) >= 10ms;
      },
      [&] { return tried < 12 * length_of(script); });
  EXPECT_EQ(shorter.size(), kMatter);
}

/// Live each try takes as long as the script.
TEST(Shrink, LooksForNothingAlikeWhereAllDiffer) {
  int attempts = 0;
  const auto shorter = shrink(
      bytes_up_to(200), {}, demo::make_dissector,
      [&](const Script& one) {
        ++attempts;
        return has(one, 40) && has(one, 150);
      },
      kAlways);
  EXPECT_EQ(shorter.size(), 2U);
  EXPECT_LT(attempts, 100);
}

TEST(Shrink, LeavesOutPairsWhereverTheyBegin) {
  constexpr unsigned kFirst = 100;
  constexpr unsigned kLast = 101;
  constexpr unsigned kPairs = 20;
  Script script{byte_at({}, kFirst)};
  for (unsigned i = 0; i < 2 * kPairs; ++i) script.push_back(byte_at((i + 1) * 10ms, i / 2));
  script.push_back(byte_at(1s, kLast));
  const auto has_whole_pairs = [](const Script& one) {
    for (unsigned i = 0; i < kPairs; ++i) {
      const auto count = std::ranges::count(one, byte_at({}, i).bytes, &KeptRecord::bytes);
      if (count == 1) return false;
    }
    return has(one, kFirst) && has(one, kLast);
  };
  const auto shorter = shrink(script, {}, demo::make_dissector, has_whole_pairs, kAlways);
  EXPECT_EQ(shorter.size(), 2U);
}

TEST(Shrink, LooksAtWhatItReturnsLast) {
  Script script;
  for (unsigned i = 0; i < 5; ++i) script.push_back(byte_at(i * 10ms, 7));
  Script last;
  const auto takes_long = [&](const Script& one) {
    const bool shows = length_of(one) >= 40ms && one.size() >= 5;
    if (shows) last = one;  // such as many more that come sooner, which are given up again
    return shows;
  };
  const auto shorter = shrink(script, {}, demo::make_dissector, takes_long, kAlways);
  EXPECT_EQ(shorter.size(), 5U);
  EXPECT_EQ(last, shorter);
}

TEST(Shrink, EndsWhenItMayNotGoOn) {
  int attempts = 0;
  const auto script = bytes_up_to(50);
  const auto shorter = shrink(
      script, {}, demo::make_dissector,
      [&](const Script&) {
        ++attempts;
        return false;
      },
      [&] { return attempts < 5; });
  EXPECT_EQ(shorter, script);
  EXPECT_EQ(attempts, 5);
}

}  // namespace
}  // namespace armjig::campaign
