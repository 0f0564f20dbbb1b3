// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/ways.hpp"

#include "conformance/kinovazed/wording.hpp"

namespace armjig::kinovazed::conformance {

void switch_off(ServerBench& server) {
  server.accept("EStop");
  server.accept("QuitEStop");
}

void initialize_afresh(ServerBench& server) {
  switch_off(server);
  server.perform("Initialize", Event::kInitialized);
}

void start_again(ServerBench& server) {
  server.expect_true(server.answers(), "an answer to EStop", "silence");
  server.accept("QuitEStop");
  server.perform("Initialize", Event::kInitialized);
}

void initialize_at_home(ServerBench& server) {
  server.perform("RunObjective:Home", Event::kObjectiveDone);
  server.wait_until_before_beat(kBeforeBeat);
  server.accept("Initialize");
  server.expect_beat(5);
}

Duration time_of(ServerBench& server, std::string_view objective) {
  const auto said = server.now();
  const auto done = server.perform("RunObjective:" + std::string{objective}, Event::kObjectiveDone,
                                   2 * ServerBench::kMotionTime);
  return done.time - said;
}

void half_close(ServerBench& server) {
  server.say("EStop");
  server.finish_sending();
  server.expect(Event::kAccepted);
  server.expect_close();
}

void expect_soon_closed(ServerBench& server) {
  (void)server.await_beat();
  const auto begin = server.now();
  server.finish_sending();
  server.expect_close();
  server.about("from a half-close right after a beat to the end");
  expect_time(server, server.now() - begin, {}, kSoon + server.noise());
}

void say_while_waiting(ServerBench& server, std::string_view text) {
  server.as(1);
  server.connect();
  server.say(text);
}

void expect_next_served(ServerBench& server, void (*end)(ServerBench& server)) {
  say_while_waiting(server, "EStop");
  server.as(0);
  (void)server.await_beat();
  server.as(1);
  const auto begin = server.now();  // by the clock of the connection that waits
  server.as(0);
  end(server);
  server.as(1);
  server.about("the client that waited, from the end of the first on");
  const auto answer = server.expect(Event::kAccepted);
  expect_time(server, answer.time - begin, {}, kSoon + 2 * server.noise());
  server.accept("EStop");
}

void expect_hung(ServerBench& server) {
  server.expect_no_message(std::chrono::milliseconds{2500});
  server.expect_true(!server.answers(), "no answer ever again", "an answer");
}

void enter(ServerBench& server, State state) {
  switch (state) {
    case State::kInitializing:
      switch_off(server);
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept("Initialize");
    case State::kRetracting:
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept("Retract");
    case State::kUnfolding:
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept("Unfold");
    case State::kSettingMode:
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept("SetJoystickMode:XYZ");
    case State::kRunningSequence:
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept(kFarObjective);
    case State::kFrozen:
      server.perform("Freeze", Event::kFreezed);
      return;
    default:
      return;
  }
}

}  // namespace armjig::kinovazed::conformance
