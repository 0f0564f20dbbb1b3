// SPDX-License-Identifier: Apache-2.0
#include "harness/compare/recording_diff.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

MakeDissector find_dissector(std::string_view device) {
  if (device.starts_with("parol6")) return parol6::make_dissector;
  if (device.starts_with("morap")) return morap::make_dissector;
  if (device.starts_with("kinovazed")) return kinovazed::make_dissector;
  return nullptr;
}

/// A record that keeps what it refers to, but for its link.
struct Kept {
  CaptureRecord record;
  std::vector<std::byte> bytes;
  std::string details;
};

struct Recording {
  std::unique_ptr<CaptureReader> reader;  ///< which has the links
  std::vector<Kept> records;
};

Recording read(const std::string& name) {
  const auto path = source_dir() + "/captures/" + name;
  Recording recording;
  recording.reader = CaptureReader::open(UserFile::open(path).value(), path).value();
  CaptureRecord record;
  while (recording.reader->next(record).value()) {
    recording.records.push_back(
        {record, {record.bytes.begin(), record.bytes.end()}, std::string{record.details}});
  }
  return recording;
}

RecordedMessages messages_of(const std::vector<Kept>& records) {
  RecordedMessages messages{find_dissector};
  for (const auto& kept : records) {
    auto record = kept.record;
    record.bytes = kept.bytes;
    record.details = kept.details;
    EXPECT_TRUE(messages.add(record));
  }
  messages.finish();
  return messages;
}

std::vector<Change> changes_of(const std::vector<RecordingDifference>& found) {
  std::vector<Change> changes;
  for (const auto& one : found) changes.push_back(one.change);
  return changes;
}

constexpr auto kBoard = "parol6/gripper_can_burst_a.jsonl";
constexpr auto kNodes = "morap/bus-three-nodes.jsonl";
constexpr auto kServer = "kinovazed/session-joystick-modes.jsonl";

class RecordingDiffOf : public ::testing::TestWithParam<const char*> {
 protected:
  Recording recording = read(GetParam());
};

TEST_P(RecordingDiffOf, FindsNothingInTheSameRecording) {
  const auto one = messages_of(recording.records);
  EXPECT_GT(one.count(), 10U);
  EXPECT_THAT(diff(one, messages_of(recording.records), {}), IsEmpty());
}

/// Changes one record; answers false if this one cannot be changed so.
bool change(Kept& kept, unsigned how, std::mt19937& random) {
  switch (how) {
    case 0:  // a byte
      if (kept.bytes.empty()) return false;
      kept.bytes[random() % kept.bytes.size()] ^=
          std::byte{static_cast<std::uint8_t>(1U << (random() % 8))};
      return true;
    case 1:  // a time
      kept.record.time += 1us;
      return true;
    case 2: {  // an acknowledge
      const auto place = kept.details.find(R"("ack":"A)");
      if (place == std::string::npos) return false;
      kept.details[place + 7] = 'N';
      return true;
    }
    default:  // a length
      if (kept.bytes.empty()) return false;
      kept.bytes.pop_back();
      return true;
  }
}

TEST_P(RecordingDiffOf, FindsAThousandRandomChangesAtTheirPlace) {
  std::mt19937 random{7};
  const auto before = messages_of(recording.records);
  for (int tried = 0; tried < 1000;) {
    auto records = recording.records;
    auto& kept = records[random() % records.size()];
    const auto how = static_cast<unsigned>(random() % 4);
    if (!change(kept, how, random)) continue;
    ++tried;
    const auto changed = messages_of(records);
    const auto found = diff(before, changed, {});
    ASSERT_FALSE(found.empty()) << "change " << tried << " of kind " << how;
    // Nothing is said of what was before it, and something of the first message that it is part of.
    const auto place = kept.record.time - (how == 1 ? 1us : 0us);
    ASSERT_GE(found.front().time(), place) << "change " << tried << " of kind " << how;
    Instant end = Instant::max();
    for (const auto& [lane, all] : before.lanes()) {
      for (const auto& one : all) {
        if (one.message.time < place || one.message.direction != kept.record.direction) continue;
        end = std::min(end, one.message.time);
      }
    }
    ASSERT_LE(found.front().time(), end) << "change " << tried << " of kind " << how;
    ASSERT_TRUE(found.front().change != Change::kChanged || !found.front().what.empty());
  }
}

TEST_P(RecordingDiffOf, TellsALostAndAnAddedRecord) {
  const auto before = messages_of(recording.records);
  auto records = recording.records;
  const auto place = static_cast<std::ptrdiff_t>(records.size() / 2);
  const auto time = records[records.size() / 2].record.time;
  records.erase(records.begin() + place);
  const auto after = messages_of(records);
  const auto lost = diff(before, after, {});
  ASSERT_THAT(lost, Not(IsEmpty()));
  EXPECT_THAT(changes_of(lost), Each(Change::kMissing));
  EXPECT_EQ(lost.front().time(), time);
  EXPECT_THAT(changes_of(diff(after, before, {})), Each(Change::kExtra));
}

INSTANTIATE_TEST_SUITE_P(Devices, RecordingDiffOf, ::testing::Values(kBoard, kNodes, kServer));

const CaptureLink kArm{"arm", "nobody", LinkKind::kSession};

/// A record for each letter, a millisecond apart, of a device that nobody knows.
std::vector<Kept> letters(std::string_view text) {
  std::vector<Kept> records;
  for (const char letter : text) {
    auto& kept = records.emplace_back();
    kept.record.time = at(1ms * records.size());
    kept.record.link = &kArm;
    kept.bytes = {static_cast<std::byte>(letter)};
  }
  return records;
}

TEST(RecordingDiff, RecognisesWhatMoved) {
  const auto before = messages_of(letters("abcdefgh"));
  const auto after = messages_of(letters("acdefgbh"));
  ComparisonRules rules;
  rules.time_tolerance = 1s;
  const auto found = diff(before, after, rules);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found.front().change, Change::kMoved);
  EXPECT_EQ(found.front().before->message.time, at(2ms));
  EXPECT_EQ(found.front().after->message.time, at(7ms));
  rules.is_order_free = true;
  EXPECT_THAT(diff(before, after, rules), IsEmpty());
}

TEST(RecordingDiff, SaysWhichOfManyEqualMessagesIsMissing) {
  auto records = letters("aaaaaaaa");
  const auto before = messages_of(records);
  records.erase(records.begin() + 3);
  const auto after = messages_of(records);
  const auto found = diff(before, after, {});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found.front().change, Change::kMissing);
  EXPECT_EQ(found.front().time(), at(4ms));
}

TEST(RecordingDiff, ComparesTimesWithinTheirTolerance) {
  auto records = letters("abc");
  const auto before = messages_of(records);
  records[1].record.time += 200us;
  const auto after = messages_of(records);
  ComparisonRules rules;
  rules.time_tolerance = 199us;
  const auto found = diff(before, after, rules);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found.front().what, Contains("time: 2000 us, 2200 us"));
  rules.time_tolerance = 200us;
  EXPECT_THAT(diff(before, after, rules), IsEmpty());
}

TEST(RecordingDiff, ComparesWhenThePartsOfAMessageCame) {
  const CaptureLink server{"kinovazed", "kinovazed", LinkKind::kSession};
  const auto talk = [&server](Duration first, const char* words) {
    const std::string_view beginning{words};
    const std::string_view rest{"0:0:0\r\n"};
    RecordedMessages messages{find_dissector};
    EXPECT_TRUE(messages.add({at(first), &server, {}, 0, std::as_bytes(std::span{beginning}), {}}));
    EXPECT_TRUE(messages.add({at(1s), &server, {}, 0, std::as_bytes(std::span{rest}), {}}));
    messages.finish();
    return messages;
  };
  const auto before = talk(100ms, "MoveJoystick:1");
  EXPECT_THAT(diff(before, talk(100ms, "MoveJoystick:1"), {}), IsEmpty());
  const auto after = talk(101ms, "MoveJoystick:1");
  const auto found = diff(before, after, {});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found.front().what, ::testing::ElementsAre("time: 100000 us, 101000 us"));
  ComparisonRules rules;
  rules.time_tolerance = 1ms;
  EXPECT_THAT(diff(before, after, rules), IsEmpty());
}

TEST(RecordingDiff, GoesOnBehindMoreThanItLooksAheadFor) {
  const std::string many(2000, 'x');
  const std::string others(2000, 'y');
  const auto before = messages_of(letters("abc" + many + "def"));
  const auto after = messages_of(letters("abc" + others + "def"));
  ComparisonRules rules;
  rules.time_tolerance = 1s;
  const auto found = diff(before, after, rules);
  ASSERT_THAT(found, SizeIs(2000));
  EXPECT_THAT(changes_of(found), Each(Change::kChanged));
}

TEST(ComparisonRules, AllowAndIgnoreFields) {
  const auto recording = read(kBoard);
  const auto before = messages_of(recording.records);
  auto records = recording.records;
  const auto answer = std::ranges::find_if(records, [](const Kept& kept) {
    return kept.record.direction == Direction::kFromDevice && kept.bytes.size() > 40;
  });
  ASSERT_NE(answer, records.end());
  answer->bytes[6] ^= std::byte{1};  // the last byte of position.j1
  const auto after = messages_of(records);
  const auto found = diff(before, after, {});
  ASSERT_THAT(found, SizeIs(1));
  ASSERT_THAT(found.front().what, SizeIs(1));
  EXPECT_THAT(found.front().what.front(), HasSubstr("position.j1: "));
  const auto by = [&](std::string_view text) {
    return diff(before, after, ComparisonRules::parse(text, "r.toml").value());
  };
  EXPECT_THAT(by("[[field]]\nname = 'position.j1'\ntolerance = 1\n"), IsEmpty());
  EXPECT_THAT(by("[[field]]\nname = 'position.j1'\ntolerance = 0.5\n"), SizeIs(1));
  EXPECT_THAT(by("[[field]]\nname = 'position.j1'\nignore = true\n"), IsEmpty());
  EXPECT_THAT(by("[[field]]\nname = 'position.j2'\nignore = true\n"), SizeIs(1));
  EXPECT_THAT(by("[[field]]\nmessage = 'x'\nname = 'position.j1'\nignore = true\n"), SizeIs(1));
  EXPECT_THAT(by("[[message]]\nname = '" + std::string{found.front().before->message.name} +
                 "'\nignore = true\n"),
              IsEmpty());
}

TEST(ComparisonRules, NameFileAndLineOfMistakes) {
  const auto complaint = [](std::string_view text) {
    const auto rules = ComparisonRules::parse(text, "r.toml");
    return rules ? std::string{} : describe(rules.error());
  };
  EXPECT_EQ(complaint(""), "");
  EXPECT_EQ(complaint("time_ms = 2\norder = 'free'\n"), "");
  EXPECT_THAT(complaint("\ntime_ms = -1\n"), HasSubstr("r.toml:2"));
  EXPECT_THAT(complaint("\norder = 'any'\n"), HasSubstr("write 'kept' or 'free'"));
  EXPECT_THAT(complaint("[[field]]\nignore = true\n"), HasSubstr("r.toml:1"));
  EXPECT_THAT(complaint("[[field]]\nname = 'x'\n"), HasSubstr("either tolerance"));
  EXPECT_THAT(complaint("[[field]]\nname = 'x'\nignore = true\ntolerance = 1\n"),
              HasSubstr("either tolerance"));
  EXPECT_THAT(complaint("[[message]]\nname = 'x'\n"), HasSubstr("ignore = true"));
  EXPECT_THAT(complaint("[[message]]\nname = 'x'\nignore = true\nx = 1\n"), HasSubstr("r.toml:4"));
}

}  // namespace
}  // namespace armjig
