// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/kinovazed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "emulators/replay/kinovazed_rules.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::kinovazed::replay {
namespace {

using namespace std::chrono_literals;
using Events = std::vector<TraceEvent>;

TEST(KinovaRecordings, AreWhatTheServerDoes) {
  const auto files = find_traces({source_dir() + "/captures/kinovazed"});
  ASSERT_TRUE(files);
  ASSERT_GE(files->size(), 177U);
  for (const auto& file : *files) {
    const auto trace = read_trace(file);
    ASSERT_TRUE(trace);
    const auto difference = verify(*trace, {.run = replay, .compare = session_difference});
    ASSERT_TRUE(difference) << describe(difference.error());
    EXPECT_FALSE(*difference) << describe(**difference, *trace, make_dissector);
  }
}

TraceEvent event(const char* dir, std::string_view text, int ms, std::uint32_t connection = 0) {
  TraceEvent result;
  result.dir = dir;
  result.time = at(std::chrono::milliseconds{ms});
  result.value = ms * 1000;  // since the start, where the last stimulus was
  result.id = connection;
  const auto bytes = std::as_bytes(std::span{text});
  if (result.dir == "from_device") {
    result.bytes.assign(bytes.begin(), bytes.end());
  } else {
    result.name = text;
  }
  return result;
}
TraceEvent message(std::string_view text, int ms, std::uint32_t connection = 0) {
  return event("from_device", std::string{text} + "\r\n", ms, connection);
}

const Events kRecorded{event("connect", "ok", 0),      message("Accepted", 12),
                       message("Heartbeat:5", 900),    message("Initialized", 2020),
                       message("Heartbeat:21", 2900),  event("disconnect", "end", 3000),
                       event("end", "running idle", 0)};

/// One transcript that must pass and one that must fail.
struct RuleCase {
  const char* rule;
  void (*within)(Events& actual);
  void (*beyond)(Events& actual);
};

const RuleCase kRules[]{
    {"a message is late by 20 ms at most", [](Events& e) { e[1] = message("Accepted", 32); },
     [](Events& e) { e[1] = message("Accepted", 33); }},
    {"a motion is late by a hundredth at most",
     [](Events& e) { e[3] = message("Initialized", 2040); },
     [](Events& e) { e[3] = message("Initialized", 2041); }},
    {"a motion is early by 3 in 100 at most",
     [](Events& e) { e[3] = message("Initialized", 1960); },
     [](Events& e) { e[3] = message("Initialized", 1959); }},
    {"bytes are exact", [](Events&) {}, [](Events& e) { e[1] = message("Rejected", 12); }},
    {"the order of messages is exact, but not where beats stand",
     [](Events& e) { std::swap(e[2], e[3]); }, [](Events& e) { e[1].bytes.swap(e[3].bytes); }},
    {"no message is missing, but a last beat may be", [](Events& e) { e.erase(e.begin() + 4); },
     [](Events& e) { e.erase(e.begin() + 3); }},
    {"no message is added, but a last beat may be",
     [](Events& e) { e.push_back(message("Heartbeat:21", 3900)); },
     [](Events& e) { e.push_back(message("Accepted", 2990)); }},
    {"beats are of the state, but close to a message of one of two",
     [](Events& e) { e[4] = message("Heartbeat:5", 2030); },
     [](Events& e) { e[4] = message("Heartbeat:5", 2900); }},
    {"ends are exact", [](Events& e) { e[5] = event("disconnect", "end", 3010); },
     [](Events& e) { e.erase(e.begin() + 5); }},
    {"refusals are exact", [](Events&) {},
     [](Events& e) { e[0] = event("connect", "refused", 0); }},
    {"what is left of the server is exact", [](Events&) {},
     [](Events& e) { e[6].name = "hung idle"; }},
    {"connections do not mix", [](Events&) {}, [](Events& e) { e[1].id = 1; }},
};

TEST(KinovaRules, PassAndFailWhatTheySay) {
  ASSERT_FALSE(session_difference(kRecorded, kRecorded));
  for (const auto& rule : kRules) {
    auto within = kRecorded;
    rule.within(within);
    EXPECT_FALSE(session_difference(kRecorded, within)) << rule.rule;
    auto beyond = kRecorded;
    rule.beyond(beyond);
    EXPECT_TRUE(session_difference(kRecorded, beyond)) << rule.rule;
  }
}

TEST(KinovaRules, LetAnEventOvertakeItsReplyOnlyAtTheSameTime) {
  const Events recorded{message("Accepted", 2), message("Initialized", 45)};
  const Events swapped{message("Initialized", 2), message("Accepted", 2)};
  EXPECT_FALSE(session_difference(recorded, swapped));
  const Events apart{message("Accepted", 2), message("Initialized", 63)};
  EXPECT_TRUE(session_difference(apart, swapped));
  const Events other{message("Accepted", 2), message("Freezed", 2)};
  EXPECT_TRUE(session_difference(other, Events{message("Freezed", 2), message("Accepted", 2)}));
}

std::optional<Problem> refusal(const std::string& text) {
  const auto trace = parse_trace("x.jsonl", text);
  if (!trace) return trace.error();
  const auto replayed = replay(*trace);
  return replayed ? std::nullopt : std::optional{replayed.error()};
}

constexpr auto kHeader =
    R"({"format":"golden-trace/1","device":"kinovazed","server_after":"running","final_state":"idle")";

/// The difference between a recording in lines and the emulator; empty if there is none.
std::string difference_of(const std::string& text) {
  const auto trace = parse_trace("x.jsonl", text);
  if (!trace) return describe(trace.error());
  const auto difference = verify(*trace, {.run = replay, .compare = session_difference});
  if (!difference) return describe(difference.error());
  return *difference ? describe(**difference, *trace, make_dissector) : "";
}

// The port is closed until the arm answers; attempts take 50 ms and are 1 s apart (reference 1.4);
// the first heartbeat comes 1 s after the port opens, and is 3 (transcript S13).
constexpr auto kWithoutArm =
    R"({"format":"golden-trace/1","device":"kinovazed","server_after":"running",)"
    R"("arm":{"missing_at_start":true},)";
constexpr auto kPluggedLate =
    R"("final_state":"poweredOff","listening_since_ms":2152}
{"t_ms":0,"dir":"connect","conn":0,"text":"refused"}
{"t_ms":1500,"dir":"arm","event":"plug","text":"arm is plugged in"}
{"t_ms":2090,"dir":"connect","conn":1,"text":"refused"}
{"t_ms":2160,"dir":"connect","conn":2,"text":"ok"}
{"t_ms":3152,"dir":"from_device","conn":2,"hex":"4865617274626561743a330d0a"}
{"t_ms":3160,"dir":"to_device","conn":2,"hex":"517569744553746f700d0a"}
{"t_ms":3161,"dir":"from_device","conn":2,"hex":"41636365707465640d0a"}
{"t_ms":4152,"dir":"from_device","conn":2,"hex":"4865617274626561743a310d0a"}
{"t_ms":4160,"dir":"disconnect","conn":2,"text":"client-close"}
)";
constexpr auto kNeverPlugged = R"("final_state":null,"listening_since_ms":null}
{"t_ms":0,"dir":"connect","conn":0,"text":"refused"}
{"t_ms":9000,"dir":"connect","conn":1,"text":"refused"}
)";

TEST(KinovaReplay, KnowsAnArmThatIsMissingAtTheStart) {
  const std::string header = kWithoutArm;
  EXPECT_EQ(difference_of(header + kPluggedLate), "");
  EXPECT_EQ(difference_of(header + kNeverPlugged), "");
  auto early = header + kPluggedLate;
  early.replace(early.find("2090"), 4, "2155");
  EXPECT_NE(difference_of(early), "") << "it listens by then";
  auto present = header + kNeverPlugged;
  present.replace(present.find("true"), 4, "false");
  EXPECT_NE(difference_of(present), "");
}

TEST(KinovaReplay, TakesEitherOrderOfARepairAndTheNextJob) {
  // The recording has the rarer order: EStop is answered after 23 ms. In the other one it waits for
  // the repair, 50 ms of opening, two looks of 2.4 ms, taking control and a stop of 31.8 ms longer.
  const auto name = source_dir() + "/captures/kinovazed/defect-neighbour-release-on-estop.jsonl";
  auto trace = read_trace(name).value_or(Trace{});
  const auto is_equal = [&] {
    const auto difference = verify(trace, {.run = replay, .compare = session_difference});
    return difference && !*difference;
  };
  EXPECT_TRUE(is_equal());
  const auto reply = std::ranges::find_if(
      trace.events, [](const TraceEvent& one) { return one.time == at(2598ms); });
  ASSERT_NE(reply, trace.events.end());
  reply->time += 87ms;
  EXPECT_TRUE(is_equal());
  reply->time += 100ms;
  EXPECT_FALSE(is_equal());
}

TEST(KinovaReplay, RefusesWhatItCannotMean) {
  const std::string header = kHeader;
  EXPECT_FALSE(refusal(header + "}\n"));
  EXPECT_TRUE(refusal(header + R"(,"arm":3})"));
  EXPECT_TRUE(refusal(header + R"(,"arm":{"unfold_s":-1}})"));
  EXPECT_TRUE(refusal(header + R"(,"listening_since_ms":"now"})"));
  EXPECT_TRUE(refusal(header + R"(,"listening_since_ms":null})"));
  EXPECT_TRUE(refusal(header + R"(,"arm":{"missing_at_start":1}})"));
  EXPECT_TRUE(refusal(header + "}\n" + R"({"t_ms":0,"dir":"to_device","conn":3,"hex":"0a"})"));
  EXPECT_TRUE(refusal(header + "}\n" + R"({"t_ms":0,"dir":"arm","event":"fail","call":"nap"})"));
  EXPECT_TRUE(refusal(header + "}\n" + R"({"t_ms":0,"dir":"dance"})"));
  EXPECT_TRUE(refusal(header + "}\n" + R"({"t_ms":3600001,"dir":"note","text":"x"})"));
}

}  // namespace
}  // namespace armjig::kinovazed::replay
