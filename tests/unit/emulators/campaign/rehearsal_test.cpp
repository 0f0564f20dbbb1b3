// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/rehearsal.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;
using parol6::Command;
using parol6::CommandFrame;
using parol6::TelemetryFrame;

Script one(Command command) {
  const auto bytes = encode(CommandFrame{.command = command});
  return {{.kind = LinkKind::kStream,
           .direction = Direction::kToDevice,
           .bytes = {bytes.begin(), bytes.end()}}};
}

Command command_of(const KeptRecord& record) { return static_cast<Command>(record.bytes.at(40)); }

/// A board that answers each frame with a position, which `place` tells after each.
using Place = std::function<std::int32_t(const KeptRecord& record)>;
Material board(std::function<Place()> make_place) {
  Material material{.kind = LinkKind::kStream, .make_dissector = parol6::make_dissector};
  material.rehearse = [make_place = std::move(make_place)](const Script& script) {
    std::vector<KeptRecord> said;
    const auto place = make_place();
    for (const auto& record : script) {
      const auto bytes = encode(TelemetryFrame{.position = {Steps{place(record)}}});
      said.push_back({.time = record.time,
                      .kind = LinkKind::kStream,
                      .direction = Direction::kFromDevice,
                      .bytes = {bytes.begin(), bytes.end()}});
    }
    return said;
  };
  return material;
}

/// It moves by a step each millisecond since it was last told to jog.
Place jogging() {
  return [since = Instant::max()](const KeptRecord& record) mutable {
    const auto command = command_of(record);
    if (command == Command::kJog && since == Instant::max()) since = record.time;
    if (command == Command::kDisable) since = Instant::max();
    if (since == Instant::max()) return 0;
    return static_cast<std::int32_t>((record.time - since) / 1ms);
  };
}

TEST(Rehearsal, TellsWhatGoesOnFromWhatIsOverOrNeverWas) {
  const auto moving = board(jogging);
  const Rehearsal rehearsal{moving};
  EXPECT_TRUE(rehearsal.goes_on_after(one(Command::kJog), one(Command::kIdle)));
  EXPECT_FALSE(rehearsal.goes_on_after(one(Command::kEnable), one(Command::kIdle)));

  const auto jumping = board([] {
    return [jumps = 0](const KeptRecord& /*record*/) mutable { return jumps++ < 2 ? 0 : 1000; };
  });
  EXPECT_FALSE(Rehearsal{jumping}.goes_on_after(one(Command::kJog), one(Command::kIdle)));
}

TEST(Rehearsal, SeesNoMotionThatRulesLetPass) {
  auto moving = board(jogging);
  moving.rules.fields.push_back({.name = "position.j1", .tolerance = 1000});
  EXPECT_FALSE(Rehearsal{moving}.goes_on_after(one(Command::kJog), one(Command::kIdle)));
}

TEST(Rehearsal, SeesNoMotionThatMayNotBe) {
  auto moving = board(jogging);
  moving.permit = [](Script& script) {
    std::erase_if(script,
                  [](const KeptRecord& record) { return command_of(record) == Command::kJog; });
  };
  EXPECT_FALSE(Rehearsal{moving}.goes_on_after(one(Command::kJog), one(Command::kIdle)));
}

TEST(Rehearsal, CountsOnlyWhatShowsWhateverCameBefore) {
  // It jogs unless it was disabled before, and is asked where it is.
  const auto obeying = board([] {
    return [is_enabled = true, place = 0](const KeptRecord& record) mutable {
      const auto command = command_of(record);
      if (command == Command::kDisable) is_enabled = false;
      if (command == Command::kEnable) is_enabled = true;
      if (command == Command::kJog && is_enabled) ++place;
      return place;
    };
  });
  Rehearsal rehearsal{obeying};
  const auto effect_after = [&](const Script& before) {
    return difference_of(rehearsal.said_after(before, {}, one(Command::kIdle)),
                         rehearsal.said_after(before, one(Command::kJog), one(Command::kIdle)));
  };
  EXPECT_GT(effect_after({}), 0U);
  rehearsal.begin_after({one(Command::kEnable), one(Command::kDisable)});
  EXPECT_EQ(effect_after({}), 0U);
  EXPECT_GT(effect_after(one(Command::kEnable)), 0U);
}

TEST(Rehearsal, SaysNothingWhereNobodyKnows) {
  const Material unknown{.kind = LinkKind::kStream, .make_dissector = parol6::make_dissector};
  const Rehearsal rehearsal{unknown};
  EXPECT_FALSE(rehearsal.is_possible());
  EXPECT_EQ(rehearsal.said_after({}, one(Command::kJog), one(Command::kIdle)), Rehearsal::Said{""});
  EXPECT_EQ(rehearsal.last_said(one(Command::kJog)), "");
}

}  // namespace
}  // namespace armjig::campaign
