// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <set>
#include <string>
#include <utility>

#include "emulators/sessions/sessions.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/emulators/campaign/live_material.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;
using parol6::Command;
using parol6::CommandFrame;

/// One session in four: to read all of them takes seconds without optimisation.
std::string draw_few(const Roll& roll) {
  return roll.seed % 4 == 0 ? parol6::sessions::draw(roll) : std::string{};
}

const Material kBoard{.kind = LinkKind::kStream,
                      .make_dissector = parol6::make_dissector,
                      .draw_session = draw_few,
                      .longest = 20s};

constexpr std::array kCommands{Command::kHome,       Command::kEnable, Command::kDisable,
                               Command::kClearError, Command::kJog,    Command::kGoTo};

std::vector<Script> all_of(const Survey& survey) {
  std::vector<Script> scripts;
  for (std::size_t i = 0; i < survey.size(); ++i) scripts.push_back(survey.at(i));
  return scripts;
}

const std::vector<Script>& surveyed() {
  static const auto kAll = all_of(Survey{kBoard, 1});
  return kAll;
}

std::vector<CommandFrame> frames_of(Bytes bytes) {
  std::vector<CommandFrame> frames;
  for (; bytes.size() >= parol6::kCommandFrameSize;
       bytes = bytes.subspan(parol6::kCommandFrameSize)) {
    frames.push_back(
        parol6::decode_command(parol6::body_of(bytes.first<parol6::kCommandFrameSize>())));
  }
  return frames;
}

std::vector<CommandFrame> whole_frames_in(const Script& script) {
  std::vector<CommandFrame> frames;
  for (const auto& record : script) {
    if (record.bytes.size() != parol6::kCommandFrameSize) continue;
    frames.push_back(frames_of(record.bytes).front());
  }
  return frames;
}

Script frame_after(Duration pause, int timeout) {
  const auto frame = parol6::encode(CommandFrame{.timeout = static_cast<std::uint8_t>(timeout)});
  return {{.time = Instant{pause},
           .kind = LinkKind::kStream,
           .direction = Direction::kToDevice,
           .bytes = {frame.begin(), frame.end()}}};
}

TEST(Survey, BeginsWithWhatWasWrittenForTheDeviceAndTakesLittleTime) {
  auto material = kBoard;
  material.draw_session = nullptr;
  material.written = {frame_after(900ms, 3), frame_after(20ms, 2), frame_after(10ms, 1)};
  const auto scripts = all_of(Survey{material, 1});
  ASSERT_GE(scripts.size(), 2U);
  const auto timeouts_of = [](const Script& script) {
    std::vector<int> timeouts;
    for (const auto& frame : whole_frames_in(script)) timeouts.push_back(frame.timeout);
    return timeouts;
  };
  EXPECT_EQ(timeouts_of(scripts[0]), (std::vector{1, 2})) << "in one case, the shortest first";
  EXPECT_EQ(timeouts_of(scripts[1]), std::vector{3});
}

TEST(Survey, GivesEachFieldOfACommandTheNumbersBesideWhichComputationsTurn) {
  std::array<std::set<std::int32_t>, 6> positions;
  std::set<int> timeouts;
  for (const auto& script : surveyed()) {
    for (const auto& frame : whole_frames_in(script)) {
      if (frame.command != Command::kGoTo) continue;
      for (std::size_t i = 0; i < 6; ++i) positions.at(i).insert(frame.position.at(i).value);
      timeouts.insert(frame.timeout);
    }
  }
  for (const auto& of_joint : positions) {
    for (const auto wanted : {127, 128, -129, 1023, -1024, 0x7F'FFFF, -0x80'0000}) {
      EXPECT_TRUE(of_joint.contains(wanted)) << wanted;
    }
  }
  EXPECT_EQ(timeouts.size(), 256U);
}

TEST(Survey, GivesEachCommandAfterEachOtherApartAndInOnePiece) {
  using Pairs = std::set<std::pair<Command, Command>>;
  Pairs apart;
  Pairs in_one_piece;
  for (const auto& script : surveyed()) {
    const auto frames = whole_frames_in(script);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      apart.emplace(frames[i - 1].command, frames[i].command);
    }
    for (const auto& record : script) {
      if (record.bytes.size() != 2 * parol6::kCommandFrameSize) continue;
      const auto both = frames_of(record.bytes);
      in_one_piece.emplace(both.front().command, both.back().command);
    }
  }
  for (const auto one : kCommands) {
    for (const auto other : kCommands) {
      EXPECT_TRUE(apart.contains({one, other})) << int(one) << ' ' << int(other);
      EXPECT_TRUE(in_one_piece.contains({one, other})) << int(one) << ' ' << int(other);
    }
  }
}

TEST(Survey, RepeatsEachCommandOftenerThanACounterOfTenBitsCounts) {
  for (const auto wanted : kCommands) {
    const auto is_repeated = [wanted](const Script& script) {
      return std::ranges::count(whole_frames_in(script), wanted, &CommandFrame::command) > 1024;
    };
    EXPECT_TRUE(std::ranges::any_of(surveyed(), is_repeated)) << int(wanted);
  }
}

TEST(Survey, CutsWhatIsSentToEachSize) {
  std::set<std::size_t> sizes;
  for (const auto& script : surveyed()) {
    for (const auto& record : script) sizes.insert(record.bytes.size());
  }
  for (std::size_t size = 1; size <= 140; ++size) EXPECT_TRUE(sizes.contains(size)) << size;
}

TEST(Survey, IsTheSameForTheSameSeed) {
  EXPECT_EQ(all_of(Survey{kBoard, 1}), surveyed());
  EXPECT_NE(all_of(Survey{kBoard, 2}), surveyed());
}

TEST(Survey, TakesNoLongerThanMayBeAndDoesNothingThatIsForbidden) {
  auto material = kBoard;
  material.longest = 2s;
  material.permit = [](Script& script) {
    std::erase_if(script, [](const KeptRecord& record) {
      return std::ranges::count(frames_of(record.bytes), Command::kJog, &CommandFrame::command) > 0;
    });
  };
  for (const auto& script : all_of(Survey{material, 1})) {
    EXPECT_LE(length_of(script), 2s);
    for (const auto& frame : whole_frames_in(script)) EXPECT_NE(frame.command, Command::kJog);
  }
}

/// A device of which `tell` says, of all that it got, what shows.
Material with_rehearsal(std::byte (*tell)(const std::vector<CommandFrame>& frames)) {
  auto material = kBoard;
  material.rehearse = [tell](const Script& script) {
    return std::vector<KeptRecord>{
        {.time = Instant::max(), .bytes = {tell(whole_frames_in(script))}}};
  };
  return material;
}

TEST(Survey, LooksAtAMessageWhereItDoesMost) {
  // A jog shows right after a command to go home only.
  const auto material = with_rehearsal([](const std::vector<CommandFrame>& frames) {
    std::uint8_t shown = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      if (frames[i].command == Command::kJog && frames[i - 1].command == Command::kHome) ++shown;
    }
    return std::byte{shown};
  });
  for (const auto& script : all_of(Survey{material, 1})) {
    const auto frames = whole_frames_in(script);
    const auto jogs = std::ranges::search_n(frames, 20, Command::kJog, {}, &CommandFrame::command);
    if (jogs.empty()) continue;
    ASSERT_NE(jogs.begin(), frames.begin());
    EXPECT_EQ(std::prev(jogs.begin())->command, Command::kHome);
    break;
  }
}

TEST(Survey, TriesWhatMattersBeforeWhatDoesNot) {
  const auto material = with_rehearsal([](const std::vector<CommandFrame>& frames) {
    std::uint8_t shown = 0;
    for (const auto& frame : frames) {
      if (frame.command == Command::kGoTo) {
        shown = static_cast<std::uint8_t>(frame.position[4].value & 0xFF);
      }
    }
    return std::byte{shown};
  });
  const auto scripts = all_of(Survey{material, 1});
  const auto goals_in = [](const Script& script, std::size_t joint) {
    std::set<std::int32_t> goals;
    for (const auto& frame : whole_frames_in(script)) {
      if (frame.command == Command::kGoTo) goals.insert(frame.position.at(joint).value);
    }
    return goals.size();
  };
  const auto first_with = [&](std::size_t joint) {
    return std::ranges::find_if(scripts, [&](const Script& script) {
      return goals_in(script, joint) > 20 && goals_in(script, 1) < 20;  // not all joints at once
    });
  };
  EXPECT_LT(first_with(4) - scripts.begin(), first_with(0) - scripts.begin());
}

TEST(Survey, LeadsAServerThroughItsStatesBeforeItTriesWhatTellsLittle) {
  const auto material = live_material("kinovazed", "tcp:127.0.0.1:1");
  const Survey survey{material, 1};
  std::size_t first_tour = 0;
  while (length_of(survey.at(first_tour)) <= material.longest + 2s) ++first_tour;
  Duration before{};
  for (std::size_t i = 0; i < first_tour; ++i) before += length_of(survey.at(i));
  EXPECT_LT(before, 100s);
}

TEST(Survey, TriesEachLengthOfASetOfParametersInTheTimeOfShorterMessages) {
  const auto material = live_material("morap", "i2c:/dev/nowhere");
  const Survey survey{material, 1};
  const auto sizes_in = [&](std::size_t number) {
    std::set<std::size_t> sizes;
    for (const auto& record : survey.at(number)) sizes.insert(record.bytes.size());
    return sizes.size();
  };
  Duration before{};
  std::size_t number = 0;
  for (; number < survey.size() && sizes_in(number) <= 30; ++number) {
    before += length_of(survey.at(number));
  }
  EXPECT_LT(number, survey.size());
  EXPECT_LT(before, 200s);
}

/// Commands that come again and again for longer than rules let answers be late, and what came
/// before them.
std::set<std::pair<Command, Command>> watched_in(const std::vector<Script>& scripts) {
  std::set<std::pair<Command, Command>> watched;
  for (const auto& script : scripts) {
    for (auto begin = script.begin(); begin != script.end();) {
      const auto end = std::ranges::find_if(
          begin, script.end(), [&](const auto& record) { return record.bytes != begin->bytes; });
      const bool is_whole = begin->bytes.size() == parol6::kCommandFrameSize;
      if (begin != script.begin() && is_whole && std::prev(end)->time - begin->time > 150ms) {
        const auto before = frames_of(std::prev(begin)->bytes);
        if (!before.empty()) {
          watched.emplace(before.back().command, frames_of(begin->bytes).front().command);
        }
      }
      begin = end;
    }
  }
  return watched;
}

TEST(Survey, WatchesEachCommandAfterEachOther) {
  const auto watched = watched_in(surveyed());
  for (const auto one : kCommands) {
    for (const auto other : kCommands) {
      const bool is_same = one == other;
      EXPECT_TRUE(is_same || watched.contains({one, other})) << int(one) << ' ' << int(other);
    }
  }
}

TEST(Survey, WatchesNothingOfWhichAnswersTellTooLittle) {
  auto material = kBoard;
  material.strays = [](Bytes message) {
    const auto frames = frames_of(message);
    return !frames.empty() && frames.front().command == Command::kHome;
  };
  const auto watched = watched_in(all_of(Survey{material, 1}));
  EXPECT_TRUE(watched.contains({Command::kEnable, Command::kJog}));
  EXPECT_FALSE(watched.contains({Command::kHome, Command::kEnable}));
  EXPECT_FALSE(watched.contains({Command::kEnable, Command::kHome}));
}

TEST(Survey, IsEmptyOfADeviceThatHasNoSessions) {
  auto material = kBoard;
  material.draw_session = nullptr;
  EXPECT_EQ(Survey(material, 1).size(), 0U);
}

}  // namespace
}  // namespace armjig::campaign
