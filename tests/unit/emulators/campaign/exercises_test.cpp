// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/exercises.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/rig/judge.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/emulators/campaign/live_material.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

/// What a live campaign on a device tries. The device itself is not there.
class Tried {
 public:
  Tried(const std::string& name, const std::string& place)
      : material_{live_material(name, place)},
        repertoire_{material_, 1},
        exercises_{material_, repertoire_} {}

  /// With the kind of message whose name, and that of its code, begin so.
  [[nodiscard]] const Setting& setting(std::string_view words) const {
    for (const auto& kind : repertoire_.kinds()) {
      const auto record = kind.front().exchange.front();
      if (words_of(record, material_.make_dissector).starts_with(words)) return kind.front();
    }
    ADD_FAILURE() << "no session has " << words;
    return repertoire_.kinds().front().front();
  }
  [[nodiscard]] const Exercises& exercises() const { return exercises_; }

 private:
  Material material_;
  Repertoire repertoire_;
  Exercises exercises_;
};

const Tried& board() {
  static const Tried kBoard{"parol6", "pty:/tmp/nowhere"};
  return kBoard;
}
const Tried& server() {
  static const Tried kServer{"kinovazed", "tcp:127.0.0.1:1"};
  return kServer;
}
const Tried& node() {
  static const Tried kNode{"morap", "i2c:/dev/nowhere"};
  return kNode;
}

std::vector<std::byte> code_bytes_of(const KeptRecord& record) {
  constexpr std::size_t kCode = 40;  // of a frame
  std::vector<std::byte> codes;
  for (auto place = kCode; place < record.bytes.size(); place += parol6::kCommandFrameSize) {
    codes.push_back(record.bytes[place]);
  }
  return codes;
}

Lines lines_in(const Script& script) {
  Lines lines;
  for (const auto& record : script) {
    std::string line;
    for (const auto byte : record.bytes) line.push_back(static_cast<char>(byte));
    lines.push_back(std::move(line));
  }
  return lines;
}

bool has(const Lines& lines, std::string_view line) {
  return std::ranges::find(lines, line) != lines.end();
}

TEST(Exercises, GiveEachByteOfAllFieldsEachValueAsFarAsTheGuardLetsThem) {
  std::array<std::set<std::byte>, parol6::kCommandFrameSize> seen;
  for (const auto& record : board().exercises().all_fields(board().setting("command idle"))) {
    for (std::size_t i = 0; i < record.bytes.size(); ++i) seen.at(i).insert(record.bytes[i]);
  }
  constexpr std::size_t kPositionOfJ1 = 4;
  constexpr std::size_t kSpeedOfJ6 = 37;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(seen.at(kPositionOfJ1 + i).size(), 256U) << i;
    EXPECT_EQ(seen.at(kSpeedOfJ6 + i).size(), 256U) << i;
  }
}

TEST(Exercises, MoveWithSmallNumbersWhatMayNotMoveFast) {
  const auto jogs = board().exercises().all_fields(board().setting("command jog"));
  EXPECT_GT(jogs.size(), 400U);
}

TEST(Exercises, SendAllOrdersOfThreeApartAndTogether) {
  const auto& setting = board().setting("command idle");
  std::vector<std::byte> apart;
  for (const auto& record : board().exercises().sequences(setting)) {
    apart.push_back(code_bytes_of(record).front());
  }
  std::vector<std::byte> together;
  for (const auto& record : board().exercises().bursts(setting)) {
    const auto codes = code_bytes_of(record);
    EXPECT_EQ(codes.size(), 5U);
    together.insert(together.end(), codes.begin(), codes.end());
  }
  const std::array codes{parol6::Command::kEnable, parol6::Command::kDisable,
                         parol6::Command::kJog};
  for (const auto one : codes) {
    for (const auto two : codes) {
      for (const auto three : codes) {
        const std::array order{std::byte{static_cast<std::uint8_t>(one)},
                               std::byte{static_cast<std::uint8_t>(two)},
                               std::byte{static_cast<std::uint8_t>(three)}};
        EXPECT_FALSE(std::ranges::search(apart, order).empty());
        EXPECT_FALSE(std::ranges::search(together, order).empty());
      }
    }
  }
}

/// What a board has become, its answers do not tell: a jog does.
TEST(Exercises, JogAfterEachOrderOfThreeForLongerThanAnswersMayBeLate) {
  const std::vector order{parol6::Command::kDisable, parol6::Command::kDisable,
                          parol6::Command::kClearError};
  const auto is_told = [&](const Script& one) {
    std::vector<std::byte> codes;
    for (const auto& record : one) codes.push_back(code_bytes_of(record).front());
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (codes.at(i) != std::byte{static_cast<std::uint8_t>(order[i])}) return false;
    }
    EXPECT_EQ(codes.back(), std::byte{static_cast<std::uint8_t>(parol6::Command::kJog)});
    EXPECT_GT(one.back().time - one.at(order.size()).time, 180ms);
    return true;
  };
  EXPECT_EQ(std::ranges::count_if(board().exercises().told_sequences(), is_told), 1);
}

TEST(Exercises, HoldEachModeOfTheGripperWithOtherNumbersEachTime) {
  constexpr std::size_t kMode = 51;
  constexpr std::size_t kSpeed = 47;
  std::size_t on_end = 0;
  std::byte last{};
  const auto script = board().exercises().held_codes(board().setting("command idle"));
  for (std::size_t i = 1; i < script.size(); ++i) {
    const auto& bytes = script[i].bytes;
    const bool is_clear = bytes.at(kMode) == std::byte{parol6::gripper_mode::kClearError} &&
                          script[i - 1].bytes.at(kMode) == bytes.at(kMode);
    if (is_clear && bytes.at(kSpeed) != last) ++on_end;
    last = bytes.at(kSpeed);
  }
  EXPECT_GE(on_end, 6U);
}

TEST(Exercises, SayEachNameThatALineMayHaveSomeTimesOnEnd) {
  const auto lines = lines_in(server().exercises().held_codes(server().setting("SetJoystickMode")));
  for (const auto* const mode : {"NoMode", "XYZ"}) {
    const auto line = fmt::format("SetJoystickMode:{}\r\n", mode);
    EXPECT_FALSE(std::ranges::search_n(lines, 4, line).empty()) << line;
  }
}

TEST(Exercises, SpoilALastByteWhereItIsAChecksumOrEndsAFrame) {
  EXPECT_FALSE(node().exercises().spoiled_copies(node().setting("program")).empty());
  EXPECT_TRUE(node().exercises().spoiled_copies(node().setting("speed")).empty());
  EXPECT_FALSE(board().exercises().spoiled_copies(board().setting("command idle")).empty());
  EXPECT_TRUE(server().exercises().spoiled_copies(server().setting("EStop")).empty());
}

TEST(Exercises, GiveEachLengthAndAsManyBytes) {
  constexpr std::size_t kLength = 3;
  std::array<std::size_t, 256> after{};  // each of them, but for those next to the true one
  std::size_t number = 0;
  for (const auto& record : board().exercises().false_lengths(board().setting("command idle"))) {
    const auto length = std::to_integer<std::size_t>(record.bytes.at(kLength));
    if (length != parol6::kCommandPayloadSize) {
      number = length;
    } else {
      after.at(number) += record.bytes.size();
    }
  }
  for (const std::size_t length : {0U, 1U, 50U, 54U, 180U, 255U}) {
    EXPECT_GE(after.at(length), length) << length;
  }
}

TEST(Exercises, WriteEachCodeToANodeAndReadAfterIt) {
  std::array<bool, 256> is_read{};
  const auto script = node().exercises().all_codes(node().setting("disable"));
  for (std::size_t i = 1; i < script.size(); ++i) {
    const auto& sent = script[i - 1];
    const bool is_code = sent.direction == Direction::kToDevice && sent.bytes.size() == 1;
    if (!is_code || script[i].direction != Direction::kFromDevice) continue;
    is_read.at(std::to_integer<std::size_t>(sent.bytes.front())) = true;
  }
  EXPECT_TRUE(std::ranges::all_of(is_read, std::identity{}));
}

TEST(Exercises, WriteTwoCodesThatAskAsOneMessage) {
  std::set<std::pair<std::byte, std::byte>> pairs;
  for (const auto& record : node().exercises().two_codes(node().setting("disable"))) {
    if (record.direction == Direction::kFromDevice) continue;
    ASSERT_EQ(record.bytes.size(), 2U);
    pairs.emplace(record.bytes[0], record.bytes[1]);
  }
  std::set<std::byte> codes;
  for (const auto& [one, other] : pairs) codes.insert({one, other});
  EXPECT_GT(codes.size(), 5U);
  EXPECT_EQ(pairs.size(), codes.size() * codes.size());
}

TEST(Exercises, WriteBlanksWherePiecesBeginAndEnd) {
  const auto lines = lines_in(server().exercises().blanks(server().setting("EStop")));
  EXPECT_TRUE(has(lines, "EStop\t\r\n"));
  EXPECT_TRUE(has(lines, " EStop\r\n"));
  EXPECT_TRUE(std::ranges::any_of(
      lines, [](const auto& line) { return line.starts_with("RunObjective\t:"); }));
}

TEST(Exercises, CutTwoLinesAtEachPlace) {
  const auto lines = lines_in(server().exercises().cut_across(server().setting("EStop")));
  for (const Lines& cut : {Lines{"EStop\r", "\nEStop\r\n"}, Lines{"EStop\r\nE", "Stop\r\n"}}) {
    EXPECT_FALSE(std::ranges::search(lines, cut).empty());
  }
  const Lines pieces{"ESt", "op\r", "\nES", "top", "\r\n"};
  EXPECT_FALSE(std::ranges::search(lines, pieces).empty());
}

TEST(Exercises, ComeAgainAfterALineThatIsFarTooLong) {
  const auto script = server().exercises().padded(server().setting("EStop"));
  const auto is_long = [](const KeptRecord& one) { return one.bytes.size() > 2000; };
  const auto longest = std::ranges::find_if(script, is_long);
  ASSERT_GT(script.end() - longest, 3);
  EXPECT_EQ(lines_in({longest[3]}), Lines{"EStop\r\n"});
  EXPECT_EQ(longest[3].id, longest->id + 1) << "a new client";
}

TEST(Exercises, WriteLinesThatAreTooLongAndNearlyRight) {
  const auto& setting = server().setting("EStop");
  const auto padded = lines_in(server().exercises().padded(setting));
  EXPECT_TRUE(has(padded, "EStop" + std::string(35, ' ') + "\r\n"));
  EXPECT_TRUE(has(padded, "EStop" + std::string(251, ' ') + "\r\n"));
  const auto misspelt = lines_in(server().exercises().misspelt(setting));
  for (const auto* const line :
       {"EStoX\r\n", "EstOp\r\n", "ESto\r\n", "Retrac\r\n", "sunObjective:"}) {
    const auto is_it = [&](const std::string& one) { return one.starts_with(line); };
    const bool is_one_letter_wrong = std::string_view{line} != "EstOp\r\n" && *line != 's';
    EXPECT_EQ(std::ranges::any_of(misspelt, is_it), is_one_letter_wrong) << line;
  }
  EXPECT_TRUE(has(lines_in(server().exercises().odd_ends(setting)), "EStop: \r\n"));
  std::string ends;
  for (int i = 0; i < 12; ++i) ends += "\r\n";
  EXPECT_TRUE(has(lines_in(server().exercises().after_runs(setting)), ends));
}

TEST(Exercises, WriteOddNumbersSoFarApartThatEachAnswerIsKnown) {
  const auto script = server().exercises().odd_numbers(server().setting("MoveJoystick"));
  const auto lines = lines_in(script);
  for (const auto* const odd : {"08", "-0", "000000000000000000000001", " "}) {
    EXPECT_TRUE(std::ranges::any_of(lines, [&](const std::string& line) {
      return line.starts_with(std::string{"MoveJoystick:"} + odd + ":");
    })) << odd;
  }
  for (std::size_t i = 1; i < script.size(); ++i) {
    EXPECT_GT(script[i].time - script[i - 1].time, 100ms);  // what live rules let pass
  }
}

TEST(Exercises, WriteLinesOfAllFormsInOnePiece) {
  const auto lines = lines_in(server().exercises().in_one_segment(server().setting("EStop")));
  for (const auto* const piece :
       {"EStop\r\nEStop\nEStop\r\nEStop\r\n", "EStop\nEStop\r\nEStop\r\nEStop\r\n",
        "estop\r\nESTOP\r\nEStop\r\nEStop\r\n", "\r\nEStop \r\nEStop\r\nEStop\r\n"}) {
    EXPECT_TRUE(has(lines, piece)) << piece;
  }
}

TEST(Exercises, LeaveInTheMiddleOfALine) {
  const auto lines = lines_in(server().exercises().half_lines(server().setting("EStop")));
  const Lines expected{"EStop", "", "", "EStop\r\n"};
  EXPECT_FALSE(std::ranges::search(lines, expected).empty());
}

TEST(Exercises, ReadAgainWhatWasChosenOnce) {
  const auto& setting = node().setting("select read_position_set");
  const auto script = node().exercises().reads_again(setting);
  ASSERT_GT(script.size(), 8U);
  for (std::size_t i = 1; i <= 8; ++i) {
    EXPECT_EQ(script[i].direction, Direction::kFromDevice) << i;
  }
}

TEST(Exercises, AskForWhatAMessageChanges) {
  const auto& telling = node().setting("speed").telling;
  ASSERT_FALSE(telling.empty());
  EXPECT_EQ(telling.front().bytes.front(), std::byte{0x82});
}

TEST(Exercises, HaveMessagesOfEachSizeThatSessionsHave) {
  std::set<std::size_t> sizes;
  for (const auto& one : node().setting("program").variants) {
    sizes.insert(one.front().bytes.size());
  }
  EXPECT_GT(sizes.size(), 8U);
}

}  // namespace
}  // namespace armjig::campaign
