// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/what_if.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emulators/replay/recorded_talk.hpp"
#include "emulators/replay/trial_witness.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/demo/demo.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using Happens = Perturbation::Kind;
using testing::HasSubstr;

std::vector<std::byte> bytes_of_request(demo::Operation operation) {
  const auto bytes = demo::encode(operation);
  return {bytes.begin(), bytes.end()};
}

KeptRecord said_by_host(Duration time, demo::Operation operation) {
  return {.time = at(time),
          .kind = LinkKind::kStream,
          .direction = Direction::kToDevice,
          .bytes = bytes_of_request(operation)};
}

std::unique_ptr<HostedStream> demo_device() {
  return std::get<cli::OnStream>(test::device("demo").port).emulate({}, "").value();
}

/// Starts, halts, and asks where it got to.
std::vector<KeptRecord> demo_talk() {
  return {said_by_host(10ms, demo::Operation::kStart), said_by_host(20ms, demo::Operation::kQuery),
          said_by_host(30ms, demo::Operation::kHalt),  said_by_host(40ms, demo::Operation::kQuery),
          said_by_host(1s, demo::Operation::kQuery),   said_by_host(2s, demo::Operation::kHalt),
          said_by_host(3s, demo::Operation::kQuery)};
}

/// What the device says when those requests pass a link that does that.
std::vector<std::string> answers_through(std::vector<Perturbation> wanted) {
  Gate gate{demo::make_dissector, std::move(wanted)};
  const auto device = put_behind(gate, demo_device());
  std::vector<std::string> said;
  const auto take = [&] {
    for (const auto& one : device->sent()) {
      said.push_back(std::to_string(microseconds(one.time) / 1000) + " " + to_hex(one.bytes));
    }
    device->clear_sent();
  };
  for (const auto& record : demo_talk()) {
    device->advance_to(record.time);
    take();
    device->receive(record.time, record.bytes);
    take();
  }
  device->advance_to(at(4s));
  take();
  return said;
}

Perturbation of_host(Happens kind, std::string name, std::size_t nth, Duration delay = {}) {
  return {kind, {Direction::kToDevice, std::move(name), nth}, delay};
}

std::string name_of_request(demo::Operation operation) {
  return name_of_piece(demo::make_dissector, Direction::kToDevice, bytes_of_request(operation));
}

TEST(Gate, LosesDoublesDelaysAndSwapsThePieceThatIsNamed) {
  const auto name = name_of_request(demo::Operation::kQuery);
  const auto usual = answers_through({});
  ASSERT_EQ(usual.size(), 7U);
  EXPECT_EQ(answers_through({of_host(Happens::kLost, name, 1)}).size(), 6U);
  EXPECT_EQ(answers_through({of_host(Happens::kTwice, name, 2)}).size(), 8U);
  EXPECT_EQ(answers_through({of_host(Happens::kLost, "another", 1)}), usual);
  const auto late = answers_through({of_host(Happens::kLate, name, 7, 500ms)});
  EXPECT_EQ(late.back(), "3501 " + usual.back().substr(usual.back().find(' ') + 1));
}

TEST(Gate, HoldsBackWhatTheDeviceSays) {
  const auto usual = answers_through({});
  const auto name = name_of_piece(demo::make_dissector, Direction::kFromDevice,
                                  demo::encode(demo::State::kReady));
  const auto lost = answers_through({{Happens::kLost, {Direction::kFromDevice, name, 1}}});
  EXPECT_EQ(lost.size(), 6U);
  EXPECT_EQ(lost.front(), usual[1]);
  const auto swapped = answers_through({{Happens::kSwapped, {Direction::kFromDevice, name, 1}}});
  EXPECT_EQ(swapped[0], usual[1]);
  EXPECT_THAT(swapped[1], HasSubstr(usual[0].substr(usual[0].find(' '))));
}

TEST(Gate, OnABusAnswersForTheDeviceWhatItDoesNotSee) {
  constexpr std::uint8_t kNode = 0x12;
  const auto lost = Perturbation{Happens::kLost, {Direction::kToDevice, "write 12", 2}};
  Gate gate{nullptr, {lost}};
  const auto bus =
      put_behind(gate, std::get<cli::OnBus>(test::device("morap").port).emulate({}, "").value());
  const auto first = bus->start(at(1ms), kNode, /*is_read=*/false);
  EXPECT_EQ(first.outcome, BusReply::Outcome::kAck);
  const auto end = bus->stop(first.end).end;
  const auto second = bus->start(end, kNode, /*is_read=*/false);
  EXPECT_EQ(second.outcome, BusReply::Outcome::kNack);
  EXPECT_GT(second.end, end);
  const auto third = bus->start(bus->stop(second.end).end, kNode, /*is_read=*/false);
  EXPECT_EQ(third.outcome, BusReply::Outcome::kAck);
}

TEST(Apart, TellsSinceWhenAndForHowLongAnotherThingIsSaid) {
  const auto said = [](Duration time, demo::State state) {
    const auto bytes = demo::encode(state);
    return SaidPiece{at(time), 0, {bytes.begin(), bytes.end()}};
  };
  const std::vector without{said(1s, demo::State::kReady), said(2s, demo::State::kHalted),
                            said(3s, demo::State::kHalted), said(4s, demo::State::kReady)};
  const std::vector with{said(1s, demo::State::kReady), said(2s, demo::State::kRunning),
                         said(4s, demo::State::kReady)};
  const auto found = apart(without, with, demo::make_dissector);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->from, at(2s));
  EXPECT_EQ(found->to, at(3s));
  EXPECT_FALSE(found->is_to_the_end);
  EXPECT_THAT(found->fields, testing::Contains(HasSubstr("state: ")));
  EXPECT_FALSE(apart(without, without, demo::make_dissector));
  EXPECT_TRUE(apart(without, {with[0], with[1]}, demo::make_dissector)->is_to_the_end);
}

class HaltJudge final : public TrialJudge {
 public:
  void to_device(Instant, Bytes) override {}
  void from_device(Instant time, Bytes bytes) override {
    if (time < at(500ms) || time > at(2s)) return;
    const auto running = demo::encode(demo::State::kRunning);
    if (std::equal(bytes.begin(), bytes.end(), running.begin(), running.end())) {
      broken_.push_back({time, "demo.runs-on", "it runs on"});
    }
  }
  void on_connection(const ConnectionEvent&) override {}
  void on_bus(const BusPart&) override {}
  std::vector<Breakage> finish() override { return std::move(broken_); }

 private:
  std::vector<Breakage> broken_;
};

RecordedTalk begin_talk(std::vector<KeptRecord> records) {
  return RecordedTalk::begin(RecordedHost{demo_device(), nullptr}, std::move(records),
                             demo::make_dissector, [] { return std::make_unique<HaltJudge>(); })
      .value();
}

Trial trial_of(const RecordedTalk& talk) {
  return [&talk](const std::vector<Perturbation>& wanted) -> Outcome<TrialResult> {
    return talk(wanted);
  };
}

std::vector<Breakage> witnessed(std::initializer_list<ConnectionEvent::Kind> events) {
  TrialWitness witness{demo::make_dissector, nullptr};
  auto now = at(0s);
  for (const auto kind : events) {
    witness.on_connection({now, 1, kind, {}});
    now += 1ms;
  }
  return witness.finish();
}

TEST(TrialWitness, TakesTheEndOfAConnectionForBrokenUnlessItsClientEndedItFirst) {
  using Kind = ConnectionEvent::Kind;
  EXPECT_THAT(witnessed({Kind::kBegun, Kind::kDropped}),
              testing::ElementsAre(testing::Field(&Breakage::rule, "device")));
  for (const auto end : {Kind::kHalfClosed, Kind::kClosed, Kind::kReset}) {
    EXPECT_THAT(witnessed({Kind::kBegun, end, Kind::kDropped}), testing::IsEmpty());
    EXPECT_THAT(witnessed({Kind::kBegun, end, Kind::kDropped, Kind::kBegun, Kind::kDropped}),
                testing::SizeIs(1));
  }
}

TEST(WhatIf, FindsTheOneLostMessageAfterWhichItRunsOn) {
  const auto recorded = begin_talk(demo_talk());
  EXPECT_EQ(recorded.copies(), demo_talk().size());
  const auto answer = what_if(trial_of(recorded), {});
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->undisturbed.broken.empty());
  ASSERT_TRUE(answer->found);
  ASSERT_EQ(answer->found->perturbations.size(), 1U);
  // The halt is the third thing that the host says.
  EXPECT_EQ(answer->found->perturbations.front(),
            of_host(Happens::kLost, answer->undisturbed.passed[2].name.name,
                    answer->undisturbed.passed[2].name.nth));
  EXPECT_EQ(answer->found->broken.rule, "demo.runs-on");
  EXPECT_THAT(describe(*answer->found), HasSubstr("of the host at 0.030 s"));
  const auto apart = recorded.apart_after(answer->found->perturbations);
  ASSERT_TRUE(apart);
  EXPECT_EQ(microseconds(apart->from) / 1000, 31);
  EXPECT_EQ(microseconds(apart->to) / 1000, 1001) << "then it is halted in any case";
}

TEST(WhatIf, NeedsTwoWhereTheHostSaysItTwice) {
  auto records = demo_talk();
  records.insert(records.begin() + 3, said_by_host(35ms, demo::Operation::kHalt));
  const auto recorded = begin_talk(records);
  const auto one = what_if(trial_of(recorded), {.delay = 1ms, .most = 1});
  EXPECT_FALSE(one->found);
  EXPECT_EQ(one->tried, records.size() * 4);
  EXPECT_TRUE(one->is_complete);
  const auto two = what_if(trial_of(recorded), {.delay = 1ms});
  ASSERT_TRUE(two->found);
  EXPECT_EQ(two->found->perturbations.size(), 2U);
  EXPECT_EQ(two->found->times.size(), 2U);
  EXPECT_EQ(two->found->times.front(), at(30ms));
}

TEST(WhatIf, LeavesOutRulesThatAreIgnoredOrBrokenAnyway) {
  const auto recorded = begin_talk(demo_talk());
  EXPECT_FALSE(what_if(trial_of(recorded), {.most = 1, .ignored = {"demo.runs-on"}})->found);
  const auto never_halted = begin_talk(
      {said_by_host(10ms, demo::Operation::kStart), said_by_host(1s, demo::Operation::kQuery)});
  EXPECT_FALSE(what_if(trial_of(never_halted), {.most = 1})->found);
}

TEST(WhatIf, TakesADeviceThatGoesAnotherWayForBroken) {
  const auto recorded = begin_talk(demo_talk());
  const auto trial = [&](const std::vector<Perturbation>& wanted) -> Outcome<TrialResult> {
    return recorded(wanted, 100ms);
  };
  const auto answer = what_if(trial, {.ignored = {"demo.runs-on"}});
  ASSERT_TRUE(answer->found);
  EXPECT_EQ(answer->found->broken.rule, "apart");
}

TEST(WhatIf, StopsWhenItMustAndSaysSo) {
  const auto recorded = begin_talk(demo_talk());
  const auto answer = what_if(trial_of(recorded), {.must_stop = [] { return true; }});
  EXPECT_FALSE(answer->found);
  EXPECT_FALSE(answer->is_complete);
  EXPECT_EQ(answer->tried, 0U);
}

}  // namespace
}  // namespace armjig
