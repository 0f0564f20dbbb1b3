// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/trace.hpp"

#include "harness/wire/parol6/dissector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/unit/support/bytes.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig {
namespace {

using test::hex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using namespace std::chrono_literals;

const std::string kHeader = R"({"format":"golden-trace/1","device":"parol6"})";

/// A trace with the header and these lines.
Outcome<Trace> parse(const std::string& lines) {
  return parse_trace("x.jsonl", kHeader + "\n" + lines);
}

/// Where and why a text is refused.
std::string refusal(const Outcome<Trace>& trace) {
  if (trace) return "accepted";
  EXPECT_EQ(trace.error().code, ErrorCode::kMalformed);
  return trace.error().where + " " + trace.error().hint;
}

TEST(Trace, ReadsHeaderAndEvents) {
  const auto trace = parse(R"({"t_us":5,"dir":"to_device","hex":"ff01"}
{"t_us":5,"dir":"from_device","hex":"02"}
{"t_us":1000000,"dir":"input","name":"estop","value":0}
{"t_us":1000001,"dir":"can_to_device","id":120,"hex":""}
)");
  ASSERT_TRUE(trace) << describe(trace.error());
  EXPECT_EQ(trace->path, "x.jsonl");
  EXPECT_EQ(trace->device, "parol6");
  EXPECT_EQ(trace->header, kHeader);
  ASSERT_EQ(trace->events.size(), 4U);
  EXPECT_EQ(trace->events[0].line, 2U);
  EXPECT_EQ(trace->events[0].time, at(5us));
  EXPECT_EQ(trace->events[0].dir, "to_device");
  EXPECT_EQ(trace->events[0].bytes, hex("FF 01"));
  EXPECT_EQ(trace->events[1].dir, "from_device");
  EXPECT_EQ(trace->events[2].name, "estop");
  EXPECT_EQ(trace->events[2].value, 0);
  EXPECT_EQ(trace->events[2].time, at(1s));
  EXPECT_EQ(trace->events[3].line, 5U);
  EXPECT_EQ(trace->events[3].id, 120U);
  EXPECT_TRUE(trace->events[3].bytes.empty());
}

TEST(Trace, KnowsWhatWasAcknowledgedOnABus) {  // captures/morap has such lines
  const auto trace = parse(R"({"t_us":0,"op":"write","addr":18,"hex":"0102","ack":"AAA"}
{"t_us":300,"op":"read","addr":18,"n":2,"hex":"aabb","ack":"A"}
{"t_us":600,"op":"write","addr":72,"hex":"090a","ack":"ANA"}
{"t_us":900,"op":"write","addr":19,"hex":"01","ack":"N"}
{"t_us":900,"op":"read","addr":19,"n":1,"hex":"","ack":"N"}
{"t_us":900,"op":"advance","to_us":1000}
)");
  ASSERT_TRUE(trace) << describe(trace.error());
  std::vector<std::vector<std::byte>> messages;
  for (const auto& event : trace->events) messages.push_back(bus_message_of(event));
  const auto none = hex("");
  EXPECT_THAT(messages,
              ElementsAre(hex("24 01 02"), hex("25 AA BB"), hex("90 0A"), none, none, none));
  EXPECT_EQ(refusal(parse(R"({"t_us":0,"op":"write","addr":128,"hex":"","ack":"A"})")),
            R"(x.jsonl:2 "addr" is not a whole number in range)");
}

/// Captures have them: ticks of a node are no whole microseconds apart.
TEST(Trace, HasTheNanosecondsOfCaptures) {
  const auto trace = parse(R"({"t_us":5,"ns":315,"dir":"to_device","hex":""}
{"t_us":6,"ns":1000,"dir":"to_device","hex":""}
{"t_us":7,"ns":"1","dir":"to_device","hex":""})");
  ASSERT_TRUE(trace);
  EXPECT_EQ(trace->events[0].time, Instant{5315ns});
  EXPECT_EQ(trace->events[1].time, Instant{6us}) << "no such number";
  EXPECT_EQ(trace->events[2].time, Instant{7us}) << "no such number";
}

TEST(Trace, ReadsTimesInMilliseconds) {  // captures/kinovazed has them
  const auto trace = parse(R"({"t_ms":12,"dir":"to_device","hex":""})");
  ASSERT_TRUE(trace);
  EXPECT_EQ(trace->events.at(0).time, at(12ms));
}

TEST(Trace, ReadsCarriageReturnsAndEmptyLines) {
  const auto trace = parse_trace(
      "x", kHeader + "\r\n\r\n" + R"({"t_us":5,"dir":"to_device","hex":"ff"})" + "\r\n\n");
  ASSERT_TRUE(trace) << describe(trace.error());
  ASSERT_EQ(trace->events.size(), 1U);
  EXPECT_EQ(trace->events[0].line, 3U);
  EXPECT_EQ(trace->header, kHeader);
}

TEST(Trace, ReadsALastLineWithoutItsEnd) {
  EXPECT_EQ(parse(R"({"t_us":5,"dir":"to_device","hex":"ff"})")->events.size(), 1U);
}

TEST(Trace, PassesOverKeysThatItDoesNotKnow) {
  EXPECT_TRUE(parse(R"({"t_us":5,"dir":"to_device","hex":"ff","colour":[1,{"a":null}]})"));
}

TEST(Trace, MayHaveNoEvents) {
  EXPECT_TRUE(parse("")->events.empty());
  EXPECT_TRUE(parse_trace("x", kHeader)->events.empty());
}

TEST(Trace, RefusesWhatHasNoHeader) {
  const std::string expected = R"(x:1 the first line is not a "golden-trace/1" header)";
  EXPECT_EQ(refusal(parse_trace("x", "")), expected);
  EXPECT_EQ(refusal(parse_trace("x", "\n" + kHeader)), expected);
  EXPECT_EQ(refusal(parse_trace("x", "{")), expected);
  EXPECT_EQ(refusal(parse_trace("x", "[]")), expected);
  EXPECT_EQ(refusal(parse_trace("x", "\xFF\xFE")), expected);
  EXPECT_EQ(refusal(parse_trace("x", R"({"format":"golden-trace/2","device":"parol6"})")),
            expected);
  EXPECT_EQ(refusal(parse_trace("x", R"({"format":7,"device":"parol6"})")), expected);
}

TEST(Trace, RefusesAHeaderWithoutDevice) {
  EXPECT_EQ(refusal(parse_trace("x", R"({"format":"golden-trace/1"})")),
            R"(x:1 "device" is missing)");
  EXPECT_EQ(refusal(parse_trace("x", R"({"format":"golden-trace/1","device":6})")),
            R"(x:1 "device" is missing)");
}

TEST(Trace, RefusesWhatIsNestedTooDeep) {
  const auto deep = std::string(200'000, '[') + std::string(200'000, ']');
  const auto with = [&deep](const std::string& line) {
    return line.substr(0, line.size() - 1) + ",\"x\":" + deep + "}";
  };
  EXPECT_EQ(refusal(parse_trace("x", with(kHeader))), "x:1 it is nested more than 64 levels deep");
  EXPECT_EQ(refusal(parse(with(R"({"t_us":5,"dir":"to_device","hex":"ff"})"))),
            "x.jsonl:2 it is nested more than 64 levels deep");
}

TEST(Trace, NamesTheLineThatIsNoObject) {
  const std::string good = R"({"t_us":5,"dir":"to_device","hex":"ff"})"
                           "\n";
  EXPECT_EQ(refusal(parse(good + "nonsense")), "x.jsonl:3 the line is not a JSON object");
  EXPECT_EQ(refusal(parse(good + "[1]\n")), "x.jsonl:3 the line is not a JSON object");
  EXPECT_EQ(refusal(parse(good + good + R"({"t_us":5,)")),
            "x.jsonl:4 the line is not a JSON object");
}

TEST(Trace, NamesTheLineWhereTimeRunsBackwards) {
  EXPECT_EQ(refusal(parse(R"({"t_us":5,"dir":"to_device","hex":"ff"}
{"t_us":5,"dir":"to_device","hex":"ff"}
{"t_us":4,"dir":"to_device","hex":"ff"})")),
            "x.jsonl:4 the time runs backwards");
}

TEST(Trace, NamesTheKeyThatIsMissing) {
  EXPECT_EQ(refusal(parse(R"({"dir":"to_device","hex":"ff"})")), R"(x.jsonl:2 "t_us" is missing)");
  EXPECT_EQ(refusal(parse(R"({"t_us":5,"hex":"ff"})")), R"(x.jsonl:2 "dir" is missing)");
}

TEST(Trace, NamesTheKeyOfTheWrongType) {
  const auto refused = [](const std::string& line) { return refusal(parse(line)); };
  const std::string number = " is not a whole number in range";
  EXPECT_EQ(refused(R"({"t_us":"5","dir":"d"})"), R"(x.jsonl:2 "t_us")" + number);
  EXPECT_EQ(refused(R"({"t_us":5.5,"dir":"d"})"), R"(x.jsonl:2 "t_us")" + number);
  EXPECT_EQ(refused(R"({"t_us":-1,"dir":"d"})"), R"(x.jsonl:2 "t_us")" + number);
  EXPECT_EQ(refused(R"({"t_us":18446744073709551615,"dir":"d"})"), R"(x.jsonl:2 "t_us")" + number);
  EXPECT_EQ(refused(R"({"t_ms":9000000000000001,"dir":"d"})"), R"(x.jsonl:2 "t_ms")" + number);
  EXPECT_EQ(refused(R"({"t_us":5,"dir":"d","id":-1})"), R"(x.jsonl:2 "id")" + number);
  EXPECT_EQ(refused(R"({"t_us":5,"dir":7})"), R"(x.jsonl:2 "dir" is not a string)");
  EXPECT_EQ(refused(R"({"t_us":5,"dir":"d","hex":255})"), R"(x.jsonl:2 "hex" is not a string)");
  EXPECT_EQ(refused(R"({"t_us":5,"dir":"d","name":[]})"), R"(x.jsonl:2 "name" is not a string)");
}

TEST(Trace, NamesTheHexThatIsNone) {
  EXPECT_EQ(refusal(parse(R"({"t_us":5,"dir":"d","hex":"fff"})")),
            R"(x.jsonl:2 "hex" a hexadecimal digit is missing its partner)");
  EXPECT_EQ(refusal(parse(R"({"t_us":5,"dir":"d","hex":"fg"})")),
            R"(x.jsonl:2 "hex" not a hexadecimal digit)");
}

/// A folder of its own that goes away again.
class TraceFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path{testing::TempDir()} / "armjig_trace_test" / test->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    const auto path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream{path, std::ios::binary} << text;
    return path.string();
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(TraceFiles, AreReadWithTheirPath) {
  const auto path = write("a.jsonl", kHeader + "\n");
  const auto trace = read_trace(path);
  ASSERT_TRUE(trace) << describe(trace.error());
  EXPECT_EQ(trace->path, path);
}

TEST_F(TraceFiles, AreMissedWithTheirPath) {
  const auto trace = read_trace(path("none.jsonl"));
  ASSERT_FALSE(trace);
  EXPECT_EQ(trace.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(trace.error().where, path("none.jsonl"));
}

TEST_F(TraceFiles, AreNotFolders) {
  const auto trace = read_trace(path(""));
  ASSERT_FALSE(trace);
  EXPECT_EQ(trace.error().code, ErrorCode::kCannotRead);
}

TEST_F(TraceFiles, AreFoundInAllFoldersBelowInOrder) {
  const auto b = write("b.jsonl", "");
  const auto a = write("deep/er/a.jsonl", "");
  write("README.md", "");
  write("matrix.json", "");
  write("a.jsonl.bak", "");
  const auto files = find_traces({path("")});
  ASSERT_TRUE(files);
  EXPECT_THAT(*files, ElementsAre(b, a));
}

TEST_F(TraceFiles, AreTakenAsNamedWhateverTheirName) {
  const auto odd = write("odd.txt", "");
  const auto a = write("in/a.jsonl", "");
  EXPECT_THAT(*find_traces({odd, path("in"), odd}), ElementsAre(odd, a, odd));
}

TEST_F(TraceFiles, AreMissedWhenAPathIsNotThere) {
  const auto files = find_traces({path("none")});
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(files.error().where, path("none"));
}

TraceEvent event(std::size_t line, Duration time, test::ByteVector bytes) {
  TraceEvent event;
  event.line = line;
  event.time = at(time);
  event.dir = "from_device";
  event.bytes = std::move(bytes);
  return event;
}

TEST(FirstDifference, IsNoneBetweenEqualEvents) {
  const std::vector events{event(2, 1us, hex("01")), event(4, 2us, hex("02"))};
  EXPECT_FALSE(first_difference(events, events));
  EXPECT_FALSE(first_difference({}, {}));
}

TEST(FirstDifference, DoesNotLookAtLineNumbers) {
  EXPECT_FALSE(first_difference({event(2, 1us, hex("01"))}, {event(0, 1us, hex("01"))}));
}

TEST(FirstDifference, IsTheFirstPairThatDiffers) {
  const std::vector expected{event(2, 1us, hex("01")), event(4, 2us, hex("02")),
                             event(6, 3us, hex("03"))};
  auto actual = expected;
  actual[1].bytes = hex("07");
  actual[2].bytes = hex("08");
  const auto difference = first_difference(expected, actual);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->expected->line, 4U);
  EXPECT_EQ(difference->actual->bytes, hex("07"));
}

TEST(FirstDifference, SeesTimeDirectionAndIdentifier) {
  const auto expected = event(2, 1us, hex("01"));
  auto later = expected;
  later.time = at(2us);
  auto other_way = expected;
  other_way.dir = "can_from_device";
  auto other_id = expected;
  other_id.id = 1;
  EXPECT_TRUE(first_difference({expected}, {later}));
  EXPECT_TRUE(first_difference({expected}, {other_way}));
  EXPECT_TRUE(first_difference({expected}, {other_id}));
}

TEST(FirstDifference, SeesWhatIsMissingAndWhatIsExtra) {
  const std::vector one{event(2, 1us, hex("01"))};
  const auto missing = first_difference(one, {});
  ASSERT_TRUE(missing);
  EXPECT_TRUE(missing->expected);
  EXPECT_FALSE(missing->actual);
  const auto extra = first_difference({}, one);
  ASSERT_TRUE(extra);
  EXPECT_FALSE(extra->expected);
  EXPECT_TRUE(extra->actual);
}

Trace trace_of(std::string device) {
  Trace trace;
  trace.path = "home.jsonl";
  trace.device = std::move(device);
  return trace;
}

TEST(DescribedDifference, NamesLineTimeBytesAndTheDecodedField) {
  namespace vectors = parol6::vectors;
  auto other = vectors::kRestTelemetry;
  other[6] = std::byte{0x03};
  const auto text = describe({event(17, 5ms, vectors::kRestTelemetry), event(0, 5ms, other)},
                             trace_of("parol6"), parol6::make_dissector);
  EXPECT_THAT(text, StartsWith("  home.jsonl:17: differs at 5000 us\n"));
  EXPECT_THAT(text, HasSubstr("expected       5000 us from_device FF FF FF 38 00 28 02"));
  EXPECT_THAT(text, HasSubstr("actual         5000 us from_device FF FF FF 38 00 28 03"));
  EXPECT_THAT(text, HasSubstr("  position.j1: expected 10242 steps, got 10243 steps\n"));
}

TEST(DescribedDifference, NamesTheTimeThatDiffers) {
  const auto text = describe({event(17, 5ms, hex("01")), event(0, 5020us, hex("01"))},
                             trace_of("parol6"), parol6::make_dissector);
  EXPECT_THAT(text, HasSubstr("  time: expected 5000 us, got 5020 us\n"));
}

TEST(DescribedDifference, SaysThatNothingCame) {
  EXPECT_THAT(describe({event(17, 5ms, hex("01")), std::nullopt}, trace_of("parol6"),
                       parol6::make_dissector),
              HasSubstr("actual   nothing\n"));
  const auto extra = describe({std::nullopt, event(0, 5ms, hex("01"))}, trace_of("parol6"),
                              parol6::make_dissector);
  EXPECT_THAT(extra, StartsWith("  home.jsonl: behind the last recorded event\n"));
  EXPECT_THAT(extra, HasSubstr("expected nothing\n"));
}

TEST(DescribedDifference, ShowsTheIdentifierOfACanFrame) {
  auto can = event(17, 5ms, hex("78 1E"));
  can.dir = "can_from_device";
  can.id = 0x7A;
  EXPECT_THAT(describe({can, std::nullopt}, trace_of("parol6"), parol6::make_dissector),
              HasSubstr("5000 us can_from_device id 07A 78 1E\n"));
}

TEST(DescribedDifference, ShowsBytesOfADeviceThatNobodyCanDissect) {
  EXPECT_THAT(
      describe({event(17, 5ms, hex("01")), event(0, 5ms, hex("02"))}, trace_of("toaster"), nullptr),
      HasSubstr("actual         5000 us from_device 02\n"));
}

}  // namespace
}  // namespace armjig
