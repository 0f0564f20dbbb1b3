// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

void connect_anew(ServerBench& server) {
  server.leave();
  server.connect();
}

void silent_start(ServerBench& server) {
  connect_anew(server);
  server.expect_quiet(300ms);
  server.expect_beat(3);
}

void beat_goes_on(ServerBench& server) {
  const auto before = server.await_beat();
  server.pause(400ms);
  connect_anew(server);
  const auto after = server.await_beat();
  expect_time(server, after.time - before.time, 900ms, 1200ms);
}

void one(ServerBench& server) {
  server.as(1);
  server.connect();
  server.about("the second client");
  server.expect_no_message(1600ms);
}

void next(ServerBench& server) {
  server.as(1);
  server.connect();
  server.as(0);
  server.leave();
  server.as(1);
  server.expect_beat(3);
}

void order(ServerBench& server) {
  for (const std::size_t client : {1U, 2U}) {
    server.as(client);
    server.connect();
    server.pause(50ms);
  }
  server.as(0);
  server.leave();
  server.as(2);
  server.about("the third client while the second is served");
  server.expect_no_message(1300ms);
  server.as(1);
  server.expect_beat(3);
  server.leave();
  server.as(2);
  server.expect_beat(3);
}

void waiting_bytes(ServerBench& server) {
  server.as(1);
  server.connect();
  server.say("EStop");
  server.about("EStop of a waiting client");
  server.expect_no_message(500ms);
  server.as(0);
  server.leave();
  server.as(1);
  server.expect(Event::kAccepted);
}

void waiting_closed(ServerBench& server) {
  server.as(1);
  server.connect();
  server.say("QuitEStop");
  server.leave();
  server.as(0);
  server.pause(100ms);
  connect_anew(server);
  server.about("behind QuitEStop of a client that has gone");
  server.expect_beat(1);
}

void again(ServerBench& server) {
  for (int i = 0; i < 3; ++i) {
    connect_anew(server);
    server.accept("EStop");
  }
}

void reset(ServerBench& server) {
  for (int i = 0; i < 3; ++i) {
    server.throw_away();
    server.connect();
    server.accept("EStop");
  }
}

void half_close_unfinished(ServerBench& server) {
  server.send("QuitEStop");
  server.finish_sending();
  server.expect_end();
  server.connect();
  server.expect_beat(3);
}

void unfinished(ServerBench& server) {
  server.send("QuitES");
  server.pause(50ms);
  connect_anew(server);
  server.say("EStop");
  server.about("the first line of the next client");
  server.expect(Event::kAccepted);
}

void keeps_state(ServerBench& server) {
  connect_anew(server);
  server.expect_beat(69);
  server.accept("MoveJoystick:0:0:0");
}

void no_watchdog(ServerBench& server) {
  server.accept("RunObjective:SuckDoor");
  server.pause(300ms);
  connect_anew(server);
  server.expect(Event::kObjectiveDone, ServerBench::kMotionTime);
}

void dropped(ServerBench& server) {
  server.accept("SetJoystickMode:XYZ");
  server.pause(150ms);
  server.leave();
  server.pause(800ms);
  server.connect();
  server.expect_beat(69);
  server.expect_quiet(300ms);
}

void stays_open(ServerBench& server) {
  server.expect_quiet(6s);
  server.accept("EStop");
}

constexpr Case kCases[] = {
    {.requirement = "kinovazed.connection.silent-start",
     .rule = "A new client hears a beat before anything else.",
     .run = on<silent_start>},
    {.requirement = "kinovazed.connection.beat-goes-on",
     .rule = "A client that connects between two beats hears the second one in its time.",
     .run = on<beat_goes_on>},
    {.requirement = "kinovazed.connection.one",
     .rule = "A second client hears nothing for 1.6 s.",
     .run = on<one>},
    {.requirement = "kinovazed.connection.next",
     .rule = "A second client hears a beat once the first one has left.",
     .run = on<next>},
    {.requirement = "kinovazed.connection.order",
     .rule = "Of two that wait the first is served first.",
     .run = on<order>},
    {.requirement = "kinovazed.connection.waiting-bytes",
     .rule = "EStop of a waiting client is answered in its turn.",
     .run = on<waiting_bytes>},
    from(kStopped, Hazard::kState, "kinovazed.connection.waiting-closed",
         "QuitEStop of a client that waited and left takes effect.", on<waiting_closed>),
    {.requirement = "kinovazed.connection.again",
     .rule = "Three clients one after the other are served.",
     .run = on<again>},
    {.requirement = "kinovazed.connection.reset",
     .rule = "Behind each of three resets the next client is served.",
     .run = on<reset>},
    {.requirement = "kinovazed.connection.half-close",
     .rule = "EStop and a half-close give Accepted and the end.",
     .run = on<half_close>},
    from(kStopped, Hazard::kState, "kinovazed.connection.half-close-unfinished",
         "QuitEStop without LF and a half-close give the end, and the state stays.",
         on<half_close_unfinished>),
    {.requirement = "kinovazed.connection.unfinished",
     .rule = "Half a word of the client before does not spoil a line.",
     .run = on<unfinished>},
    from(kSteering, Hazard::kMove, "kinovazed.connection.keeps-state",
         "A client that connects while the server is steering may move.", on<keeps_state>),
    from(kReady, Hazard::kMove, "kinovazed.connection.no-watchdog",
         "ObjectiveDone comes to the client that connected during the run.", on<no_watchdog>),
    from(kReady, Hazard::kMove, "kinovazed.connection.dropped",
         "JoystickModeSet is not kept for who connects later.", on<dropped>),
    full(from(kStopped, Hazard::kObserve, "kinovazed.connection.stays-open",
              "A client that is silent for 6 s is answered then.", on<stays_open>)),
};

}  // namespace

std::span<const Case> connection_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
