// SPDX-License-Identifier: Apache-2.0
// Both roles of a recording against each other: what one side plays is what the other one was to
// hear, at its time.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/kinovazed/options.hpp"
#include "emulators/memory/in_memory.hpp"
#include "emulators/replay/device_role.hpp"
#include "emulators/replay/host_role.hpp"
#include "emulators/replay/morap.hpp"
#include "emulators/replay/parol6.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/hex.hpp"
#include "harness/files/user_file.hpp"
#include "harness/link/transaction_bus.hpp"
#include "harness/rig/guarded_ports.hpp"
#include "harness/rig/kinovazed_judge.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

/// Where the recordings of a real device are, and what they are of.
struct Corpus {
  const char* folder;
  LinkKind kind;
  MakeDissector make_dissector;
};

void PrintTo(const Corpus& corpus, std::ostream* out) { *out << corpus.folder; }

constexpr Corpus kParol6{"parol6", LinkKind::kStream, parol6::make_dissector};
constexpr Corpus kKinovazed{"kinovazed", LinkKind::kSession, kinovazed::make_dissector};
constexpr Corpus kMorap{"morap", LinkKind::kBus, morap::make_dissector};

std::string folder_of(const Corpus& corpus) {
  return std::string{source_dir()} + "/captures/" + corpus.folder;
}

std::vector<KeptRecord> records_of(const std::string& path, LinkKind kind) {
  auto file = UserFile::open(path);
  auto reader = CaptureReader::open(*std::move(file), path);
  std::vector<KeptRecord> records;
  EXPECT_TRUE(for_each_record(**reader, [&](const CaptureRecord& record) -> Outcome<void> {
    const auto of = record.link->kind;
    if (of == kind || of == LinkKind::kEvents || of == LinkKind::kCan)
      records.push_back(KeptRecord::from(record));
    return {};
  }));
  EXPECT_FALSE(records.empty());
  return records;
}

/// A line each: when, who, what. What came together on a stream is one.
std::string text_of(const std::vector<KeptRecord>& records) {
  std::string text;
  const KeptRecord* before = nullptr;
  for (const auto& record : records) {
    const bool is_rest = before != nullptr && record.kind == LinkKind::kStream &&
                         before->time == record.time && before->direction == record.direction;
    if (!is_rest) {
      // When something passes on a bus only its host decides.
      const auto time = record.kind == LinkKind::kBus ? Instant{} : record.time;
      text += fmt::format("\n{} {} {} {} ", time.time_since_epoch().count(),
                          to_string(record.direction), record.id, text_in(record, "ack"));
    }
    text += to_hex(record.bytes);
    if (record.kind == LinkKind::kEvents) text += text_in(record, "dir") + text_in(record, "text");
    before = &record;
  }
  return text;
}

void expect_both_hear_what_was_recorded(const Corpus& corpus, const std::string& path) {
  SCOPED_TRACE(path);
  const auto records = records_of(path, corpus.kind);
  auto [device, said] =
      play_device(corpus.kind, records, {.trailing = 10s, .make_dissector = corpus.make_dissector});
  const auto played = std::visit(
      [&](auto& hosted) {
        const auto port = open_in_memory(std::move(hosted));
        return play_host(*port, records, PlayHow{});
      },
      device);
  ASSERT_TRUE(played) << describe(played.error());
  EXPECT_EQ(text_of(played->actual), text_of(played->expected));
  EXPECT_EQ(text_of(said->actual), text_of(said->expected));
  EXPECT_EQ(said->not_awaited, 0U);
  EXPECT_FALSE(said->expected.empty());
}

class BothRoles : public ::testing::TestWithParam<Corpus> {};

TEST_P(BothRoles, HearFromEachOtherWhatWasRecorded) {
  const auto files = find_traces({folder_of(GetParam())});
  ASSERT_TRUE(files);
  EXPECT_GT(files->size(), 50U);
  for (const auto& file : *files) expect_both_hear_what_was_recorded(GetParam(), file);
}

INSTANTIATE_TEST_SUITE_P(Golden, BothRoles, ::testing::Values(kParol6, kKinovazed, kMorap),
                         ::testing::PrintToStringParamName());

/// Everything that was done beside the link is done to the emulated device, too: CAN frames, hands,
/// power, of the device that is meant.
template <class SetUp>
void expect_answers_as_recorded(const Corpus& corpus, SetUp set_up, const PlayHow& how) {
  const auto files = find_traces({folder_of(corpus)});
  ASSERT_TRUE(files);
  EXPECT_GT(files->size(), 80U);
  for (const auto& file : *files) {
    SCOPED_TRACE(file);
    auto device = read_trace(file).and_then(set_up);
    ASSERT_TRUE(device) << describe(device.error());
    const auto port = open_in_memory(make_hosted(*std::move(device)));
    const auto played = play_host(*port, records_of(file, corpus.kind), how);
    ASSERT_TRUE(played) << describe(played.error());
    EXPECT_EQ(text_of(played->actual), text_of(played->expected));
  }
}

TEST(HostRole, IsAnsweredByAnEmulatedBoardAsRecorded) {
  expect_answers_as_recorded(kParol6, parol6::replay::set_up,
                             {.touches_of = parol6::replay::touches_of, .lead = 1ns});
}

TEST(HostRole, IsAnsweredByEmulatedNodesAsRecorded) {
  expect_answers_as_recorded(kMorap, morap::replay::set_up,
                             {.touches_of = morap::replay::touches_of});
}

KeptRecord written_at(Duration time) {
  return {.time = at(time), .kind = LinkKind::kBus, .id = 0x12, .bytes = from_hex("01").value()};
}

/// By then all of it was written to an empty bus.
Instant end_of_play(const std::vector<KeptRecord>& records, const PlayHow& how, BusPort& port) {
  const auto played = play_host(port, records, how);
  EXPECT_TRUE(played);
  EXPECT_EQ(played->passed.size(), records.size());
  return port.now();
}

TEST(HostRole, WaitsAsLongAsAHandTakes) {
  const auto port = open_in_memory(make_hosted(i2c::Bus{}));
  const std::vector<KeptRecord> records{{.time = at(10ms),
                                         .kind = LinkKind::kEvents,
                                         .details = R"("dir":"input","name":"estop","value":0)"},
                                        written_at(20ms)};
  const PlayHow slow{.by_hand = [&](std::string_view name, std::int64_t value) {
    EXPECT_EQ(name, "estop");
    EXPECT_EQ(value, 0);
    port->wait_until(port->now() + 1s);
    return true;
  }};
  const auto end = end_of_play(records, slow, *port);
  EXPECT_GE(end, at(1020ms));
  EXPECT_LT(end, at(1030ms));
}

TEST(HostRole, ShiftsWhatFollowsALateRecordIfItIsToldTo) {
  // Five at once take time, so the last of them is late.
  std::vector<KeptRecord> records(5, written_at(10ms));
  records.push_back(written_at(20ms));
  const auto end = [&](AfterLate after_late) {
    const auto port = open_in_memory(make_hosted(i2c::Bus{}));
    return end_of_play(records, {.after_late = after_late}, *port);
  };
  const auto own = end(AfterLate::kAsRecorded) - at(20ms);
  EXPECT_LT(own, 1ms);
  EXPECT_GE(end(AfterLate::kShifted) - at(20ms), 5 * own);
}

/// As an operating system gives it, opened a second ago; each transaction comes a little late.
class Adapter final : public TransactionBus {
 public:
  static constexpr auto kLate = 3ms;

  Result<Transfer> transfer(std::span<const BusMessage> /*messages*/) override {
    return Transfer::kDone;
  }
  void wait_until(Instant time) override { now_ = std::max(now_, time + kLate); }
  [[nodiscard]] Instant now() const override { return now_; }

 private:
  Instant now_ = at(1s);
};

TEST(HostRole, SaysOfEachPartOfATransactionWhenItPassed) {
  Adapter bus;
  std::vector<KeptRecord> records{written_at(10ms), written_at(20ms), written_at(23ms),
                                  written_at(26ms)};
  for (const auto place : {1U, 2U}) records[place].details = R"("stop":false)";
  const auto played = play_host(bus, records, {});
  ASSERT_TRUE(played);
  std::vector<std::chrono::milliseconds> late;
  for (std::size_t i = 0; i < records.size(); ++i) {
    late.push_back(
        duration_cast<std::chrono::milliseconds>(played->actual.at(i).time - records[i].time));
  }
  // The first one was due when the bus was opened.
  EXPECT_EQ(late, (std::vector{0ms, Adapter::kLate, Adapter::kLate, Adapter::kLate}));
}

TEST(HostRole, LeavesAConnectionThatANewOneReplacesAsItsGuardIsTold) {
  const auto said = [](Duration time, const std::string& text) {
    const auto bytes = std::as_bytes(std::span{text});
    return KeptRecord{.time = at(time),
                      .kind = LinkKind::kSession,
                      .direction = Direction::kToDevice,
                      .id = 1,
                      .bytes = {bytes.begin(), bytes.end()}};
  };
  const KeptRecord again{.time = at(100ms),
                         .kind = LinkKind::kEvents,
                         .details = R"("dir":"connect","conn":1,"text":"ok")"};
  const std::vector<KeptRecord> records{said(10ms, "Retract\r\n"), again,
                                        said(150ms, "GetAbsolutePosition\r\n")};
  const auto state = std::make_shared<GuardState>();
  state->when_left = WhenLeft::kSayNothing;
  GuardedSource server{open_in_memory(make_hosted(*kinovazed::emulation::make({}, "test"))),
                       kinovazed::rig::make_judge, Permissions::all(), state};
  const auto played = play_host(server, records, {});
  ASSERT_TRUE(played);
  ASSERT_EQ(played->passed.size(), records.size());
  EXPECT_LT(played->passed.back(), at(160ms)) << "time in which a moving arm is stopped";
}

TEST(DeviceRole, WaitsForTheHostAndThenTakesTheTimeThatItTook) {
  const auto records = records_of(folder_of(kParol6) + "/jog_stops_a.jsonl", LinkKind::kStream);
  auto [device, said] =
      play_device(LinkKind::kStream, records, {.make_dissector = parol6::make_dissector});
  auto& stream = *std::get<std::unique_ptr<HostedStream>>(device);
  stream.advance_to(at(0s));
  stream.advance_to(at(10min));
  EXPECT_TRUE(stream.sent().empty()) << "its first word is waited for";
  EXPECT_FALSE(stream.is_gone());

  // Its first frame, ten minutes late and in two pieces.
  const auto& first = records.front();
  ASSERT_EQ(first.direction, Direction::kToDevice);
  const auto bytes = Bytes{first.bytes};
  stream.receive(at(10min), bytes.first(3));
  EXPECT_TRUE(stream.sent().empty());
  stream.receive(at(10min), bytes.subspan(3));
  const auto delay = records[1].time - first.time;
  ASSERT_EQ(records[1].direction, Direction::kFromDevice);
  stream.advance_to(at(10min) + delay - 1ns);
  EXPECT_TRUE(stream.sent().empty());
  stream.advance_to(at(10min) + delay);
  ASSERT_EQ(stream.sent().size(), 1U);
  EXPECT_EQ(stream.sent().front().bytes, records[1].bytes);
  EXPECT_EQ(stream.sent().front().time, at(10min) + delay);

  // A host that says nothing more is not waited for for ever.
  stream.clear_sent();
  stream.advance_to(at(60min));
  EXPECT_GT(said->not_awaited, 0U);
  EXPECT_GT(stream.sent().size(), 10U);
  stream.clear_sent();
  EXPECT_TRUE(stream.is_gone());
}

}  // namespace
}  // namespace armjig
