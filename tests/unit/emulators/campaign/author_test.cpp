// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/author.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <set>

#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;
using parol6::CommandFrame;

const Script kGoTo = [] {
  CommandFrame frame;
  frame.command = parol6::Command::kGoTo;
  const auto bytes = encode(frame);
  return Script{{.time = {},
                 .kind = LinkKind::kStream,
                 .direction = Direction::kToDevice,
                 .bytes = {bytes.begin(), bytes.end()}}};
}();

const Material kMaterial{.kind = LinkKind::kStream,
                         .make_dissector = parol6::make_dissector,
                         .harmless = kGoTo,
                         .longest = 60s};

/// The whole frames of a script; what is none is left out.
std::vector<CommandFrame> frames_in(const Script& script) {
  std::vector<CommandFrame> frames;
  for (const auto& record : script) {
    if (record.bytes.size() != parol6::kCommandFrameSize) continue;
    const auto bytes = Bytes{record.bytes}.first<parol6::kCommandFrameSize>();
    frames.push_back(parol6::decode_command(parol6::body_of(bytes)));
  }
  return frames;
}

template <class Holds>
bool is_drawn(std::uint64_t seeds, Holds holds) {
  const Author author{kMaterial};
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    if (holds(author.draw(seed, {kGoTo}))) return true;
  }
  return false;
}

TEST(Author, GivesAFieldAllNumbersBesideWhichComputationsTurn) {
  EXPECT_TRUE(is_drawn(1000, [](const Script& script) {
    std::set<std::int32_t> positions;
    for (const auto& frame : frames_in(script)) positions.insert(frame.position[5].value);
    return std::ranges::all_of(std::array{127, 128, 129, -128, 1023, 1024, 0x7F'FFFF, -0x80'0000},
                               [&](std::int32_t wanted) { return positions.contains(wanted); });
  }));
}

TEST(Author, GivesFieldsOfOneKindTheSameNumber) {
  EXPECT_TRUE(is_drawn(1000, [](const Script& script) {
    return std::ranges::any_of(frames_in(script), [](const CommandFrame& frame) {
      return frame.position[0].value == 4096 && frame.position[5].value == 4096 &&
             frame.speed[0].value == 0;
    });
  }));
}

TEST(Author, RepeatsAMessageMoreThanAThousandTimesInTheTimeOfMostCases) {
  EXPECT_TRUE(is_drawn(1000, [](const Script& script) {
    return script.size() > 1024 && length_of(script) < 60s / 8;
  }));
}

TEST(Author, EndsOneScriptInThreeWithTheEpilogue) {
  constexpr std::array<std::string_view, 2> kMessages{"Home", "Where"};
  auto material = kMaterial;
  material.epilogue = {kMessages, 2s};
  const Author author{material};
  int ended = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const auto script = author.draw(seed, {kGoTo});
    if (script.size() < 3 || as_text(script.back().bytes) != "Where") continue;
    ++ended;
    const auto& home = script[script.size() - 2];
    EXPECT_EQ(as_text(home.bytes), "Home");
    EXPECT_EQ(script.back().time - home.time, 2s);
    EXPECT_EQ(home.time - script[script.size() - 3].time, 2s);
  }
  EXPECT_GT(ended, 70);
  EXPECT_LT(ended, 130);
}

}  // namespace
}  // namespace armjig::campaign
