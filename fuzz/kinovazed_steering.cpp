// SPDX-License-Identifier: Apache-2.0
// One second of an emulated server alone that steers an initialized arm, with a client that sends a
// line every 100 ms: no line is answered twice, answers are whole lines, times never decrease,
// state and hand are possible ones, and a copy goes on to the same bytes.
//
// Input: an arm, when a copy is made (0: never), then commands, each one byte and its arguments;
// what is missing of the last one is 0, and it is said again until the second is over.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "emulators/kinovazed/server.hpp"
#include "fuzz/answers.hpp"
#include "fuzz/input.hpp"
#include "fuzz/kinovazed_possible.hpp"
#include "fuzz/require.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/kinovazed/line.hpp"

namespace armjig::fuzz::steering {
namespace {

using namespace kinovazed;
using namespace emulation;
using namespace std::chrono_literals;

constexpr int kLines = 10;
constexpr Duration kBetween = 100ms;

Command command_from(Input& input) {
  // Two of three steer.
  constexpr auto kSteering = static_cast<std::uint8_t>(2 * kVerbNames.size());
  const auto choice = input.u8();
  Command command{.verb = Verb::kMoveJoystick};
  if (choice % (3 * kVerbNames.size()) >= kSteering) {
    command.verb = static_cast<Verb>(choice % kVerbNames.size());
  }
  if (command.verb == Verb::kSetJoystickMode) {
    command.mode = static_cast<Mode>(input.u8() % kModeNames.size());
  } else if (command.verb == Verb::kMoveJoystick) {
    command.deflection = {static_cast<std::int8_t>(input.u8()),
                          static_cast<std::int8_t>(input.u8()),
                          static_cast<std::int8_t>(input.u8())};
  } else if (names_objective(command.verb)) {
    command.objective = static_cast<Objective>(input.u8() % kObjectiveNames.size());
  }
  return command;
}

/// A server and its only client.
class Bench {
 public:
  explicit Bench(ArmPort arm) : server_{std::move(arm)} {
    server_.advance_to(now_);
    const auto id = server_.connect(now_);
    require(id.has_value(), "a fresh server listens");
    client_ = *id;
    say({.verb = Verb::kQuitEStop}, 1s);
    say({.verb = Verb::kInitialize}, 7s);
    say({.verb = Verb::kSetJoystickMode, .mode = Mode::kXyz}, 1s);
    require(server_.state() == State::kSteering, "an arm can be led to where it is steered");
    server_.clear_sent();
    server_.clear_log();
  }

  void say(const Command& command, Duration wait) {
    server_.receive(now_, client_, encode(command).bytes());
    now_ += wait;
    server_.advance_to(now_);
  }
  [[nodiscard]] const Server& server() const noexcept { return server_; }

 private:
  Server server_;
  Instant now_ = at(60ms);
  ConnectionId client_{};
};

void check_answers(std::span<const ServerEvent> sent) {
  Answers answers{make_dissector};
  std::ptrdiff_t replies = 0;
  for (const auto& event : sent) {
    answers.hear(event.time, event.connection, event.bytes);
    const std::string_view text{reinterpret_cast<const char*>(event.bytes.data()),
                                event.bytes.size()};
    replies += static_cast<std::ptrdiff_t>(text.starts_with("Accepted\r\n")) +
               static_cast<std::ptrdiff_t>(text.starts_with("Rejected\r\n"));
  }
  require(replies <= kLines, "no line is answered twice");
}

void check_second(Input input) {
  static const std::array kReady{Bench{ArmPort{BenchArm{}}}, Bench{ArmPort{JacoArm{}}}};
  auto bench = kReady[input.u8() % kReady.size()];
  const int copied_at = input.u8();
  std::optional<Bench> copy;
  Command command;
  for (int i = 0; i < kLines; ++i) {
    if (i == 0 || !input.is_empty()) command = command_from(input);
    if (i > 0 && i == copied_at) copy = bench;
    bench.say(command, kBetween);
    if (copy) copy->say(command, kBetween);
    require_possible(bench.server());
  }
  const auto sent = bench.server().sent();
  check_answers(sent);
  const auto is_same = [](const ServerEvent& one, const ServerEvent& other) {
    return one.time == other.time && one.kind == other.kind && one.bytes == other.bytes;
  };
  require(!copy || std::ranges::equal(sent, copy->server().sent(), is_same),
          "a copy goes on to the same bytes");
}

}  // namespace
}  // namespace armjig::fuzz::steering

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::steering::check_second(armjig::fuzz::Input{std::as_bytes(std::span{data, size})});
  return 0;
}
