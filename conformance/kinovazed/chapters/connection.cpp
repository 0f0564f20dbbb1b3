// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

void connect_anew(ServerBench& server) {
  server.leave();
  server.connect();
}

constexpr Clause kConnectionClauses[] = {
    must("kinovazed.connection.silent-start",
         "Nothing is sent because somebody connects: the first message is a heartbeat.",
         "server, recording connection-reconnect-idle"),
    look("A new client hears a beat before anything else.",
         [](ServerBench& server) {
           connect_anew(server);
           server.expect_quiet(300ms);
           server.expect_beat(3);
         }),

    must("kinovazed.connection.beat-goes-on",
         "Connecting does not move the heartbeats: a new client hears the next one when it would "
         "have "
         "come anyway.",
         "server, recording heartbeat-first"),
    look("A client that connects between two beats hears the second one in its time.",
         [](ServerBench& server) {
           const auto before = server.await_beat();
           server.pause(400ms);
           connect_anew(server);
           const auto after = server.await_beat();
           expect_time(server, after.time - before.time, 900ms - server.noise(),
                       1200ms + server.noise());
         }),

    variant("unheard", look("Nor does a second without anybody to hear them.",
                            [](ServerBench& server) {
                              const auto before = server.await_beat();
                              server.pause(400ms);
                              server.leave();
                              server.pause(1s);
                              server.connect();
                              const auto after = server.await_beat();
                              server.about("the second beat, of which nobody heard the first");
                              expect_time(server, after.time - before.time, 1850ms - server.noise(),
                                          2250ms + 2 * server.noise());
                            })),

    must("kinovazed.connection.one",
         "While a client is served another one that connects hears nothing, not even heartbeats.",
         "server, recording connection-second-waits"),
    look("A second client hears nothing for 1.6 s.",
         [](ServerBench& server) {
           server.as(1);
           server.connect();
           server.about("the second client");
           server.expect_no_message(1600ms);
         }),

    must("kinovazed.connection.next",
         "When the client that was served leaves, the one that waits hears the heartbeats.",
         "server, recording connection-second-waits"),
    look("A second client hears a beat once the first one has left.",
         [](ServerBench& server) {
           server.as(1);
           server.connect();
           server.as(0);
           server.leave();
           server.as(1);
           server.expect_beat(3);
         }),

    must("kinovazed.connection.order",
         "Clients that wait are served in the order in which they connected.",
         "server, recording connection-three"),
    look("Of two that wait the first is served first.",
         [](ServerBench& server) {
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
         }),

    must("kinovazed.connection.at-once",
         "Of two clients that connect at once the first is served, and the second when that one "
         "leaves.",
         "server, recording connection-three"),
    look("Both ask; the second is answered after the first.",
         [](ServerBench& server) {
           server.leave();
           server.pause(300ms + 3 * server.noise());
           for (const std::size_t client : {1U, 2U}) {
             server.as(client);
             server.connect();
           }
           server.say("EStop");
           server.expect_no_message(1500ms);
           server.as(1);
           server.say("EStop");
           server.expect(Event::kAccepted);
           server.leave();
           server.as(2);
           server.expect(Event::kAccepted);
         }),

    must("kinovazed.connection.waiting-bytes",
         "What a waiting client has sent is carried out and answered when its turn comes.",
         "server, recording connection-second-waits"),
    look("EStop of a waiting client is answered in its turn.",
         [](ServerBench& server) {
           say_while_waiting(server, "EStop");
           server.about("EStop of a waiting client");
           server.expect_no_message(500ms);
           server.as(0);
           server.leave();
           server.as(1);
           server.expect(Event::kAccepted);
         }),
    variant("pieces",
            look("Two commands of a waiting client, one after the other and cut, are answered.",
                 [](ServerBench& server) {
                   say_while_waiting(server, "EStop");
                   server.pause(50ms);
                   server.send("ESt");
                   server.pause(50ms);
                   server.say("op");
                   server.as(0);
                   server.leave();
                   server.as(1);
                   server.expect(Event::kAccepted);
                   server.expect(Event::kAccepted);
                 })),

    variant("many", look("Forty lines of a waiting client are answered.",
                         [](ServerBench& server) {
                           constexpr int kLines = 40;
                           say_while_waiting(server, "EStop");
                           for (int i = 1; i < kLines; ++i) server.say("EStop");
                           server.as(0);
                           server.leave();
                           server.as(1);
                           for (int i = 0; i < kLines; ++i) server.expect(Event::kAccepted);
                         })),

    must("kinovazed.connection.waiting-closed",
         "What a waiting client has sent is carried out also if it has closed meanwhile.",
         "server; reference 1.7"),
    from(kStopped, Hazard::kState, "QuitEStop of a client that waited and left takes effect.",
         [](ServerBench& server) {
           say_while_waiting(server, "QuitEStop");
           server.leave();
           server.as(0);
           server.pause(100ms);
           connect_anew(server);
           server.about("after QuitEStop of a client that has gone");
           server.expect_beat(1);
         }),

    must("kinovazed.connection.again",
         "When a client has closed its connection a new one is served.",
         "server, recording connection-reconnect-idle"),
    look("Three clients one after the other are served.",
         [](ServerBench& server) {
           for (int i = 0; i < 3; ++i) {
             connect_anew(server);
             server.accept("EStop");
           }
         }),

    must("kinovazed.connection.reset",
         "When a client has reset its connection a new one is served.",
         "server, recording connection-rst"),
    look("After each of three resets the next client is served.",
         [](ServerBench& server) {
           for (int i = 0; i < 3; ++i) {
             server.throw_away();
             server.connect();
             server.accept("EStop");
           }
         }),
    variant("next", look("One that waits when another resets is answered.",
                         [](ServerBench& server) {
                           expect_next_served(server, [](ServerBench& one) { one.throw_away(); });
                         })),

    must("kinovazed.connection.half-close",
         "Complete lines before a half-close are served and answered; then the server closes.",
         "server, recording connection-half-close"),
    look("EStop and a half-close give Accepted and the end.", on<half_close>),
    variant("soon", look("The end comes within half a second.", on<expect_soon_closed>)),
    variant("next", look("One that waits when another half-closes is answered.",
                         [](ServerBench& server) { expect_next_served(server, half_close); })),
    variant("while-waiting",
            look("A client that half-closed while it waited is answered, and then the next one.",
                 [](ServerBench& server) {
                   say_while_waiting(server, "EStop");
                   server.finish_sending();
                   server.as(2);
                   server.connect();
                   server.say("EStop");
                   server.as(0);
                   server.leave();
                   server.as(1);
                   server.expect(Event::kAccepted);
                   server.expect_end();
                   server.as(2);
                   server.expect(Event::kAccepted);
                 })),

    must(
        "kinovazed.connection.half-close-unfinished",
        "A line without LF before a half-close is not served; the server closes without an answer.",
        "server, transcript S3"),
    from(kStopped, Hazard::kState,
         "QuitEStop without LF and a half-close give the end, and the state stays.",
         [](ServerBench& server) {
           server.send("QuitEStop");
           server.finish_sending();
           server.expect_end();
           server.connect();
           server.expect_beat(3);
         }),

    must("kinovazed.connection.unfinished",
         "A line of less than 128 bytes that a client left unfinished leaves no trace.",
         "server, recording framing-partial-dropped"),
    look("Half a word of the client before does not spoil a line.",
         [](ServerBench& server) {
           server.send("QuitES");
           server.pause(50ms);
           connect_anew(server);
           server.say("EStop");
           server.about("the first line of the next client");
           server.expect(Event::kAccepted);
         }),

    must("kinovazed.connection.keeps-state",
         "Losing a client changes no state: the next one finds the joystick mode and may steer.",
         "server, transcript S4"),
    from(kInMode, Hazard::kMove, "A client that connects while the server is steering may move.",
         [](ServerBench& server) {
           connect_anew(server);
           server.expect_beat(69);
           server.accept("MoveJoystick:0:0:0");
         }),
    variant("frozen",
            from(kReady, Hazard::kMove, "One that connects while it is frozen unfreezes it.",
                 [](ServerBench& server) {
                   server.perform("Freeze", Event::kFreezed);
                   connect_anew(server);
                   server.expect_beat(13);
                   server.perform("Unfreeze", Event::kUnfreezed);
                 })),

    must("kinovazed.connection.no-watchdog",
         "Losing a client does not stop an objective; its ObjectiveDone goes to the next client.",
         "server, recording connection-reconnect-mid-objective"),
    from(kReady, Hazard::kMove, "ObjectiveDone comes to the client that connected during the run.",
         [](ServerBench& server) {
           server.accept("RunObjective:SuckDoor");
           server.pause(300ms);
           connect_anew(server);
           server.expect(Event::kObjectiveDone, ServerBench::kMotionTime);
         }),

    must("kinovazed.connection.dropped",
         "Messages that arise while nobody is connected are lost; only the heartbeat shows the "
         "state.",
         "server, transcript S5"),
    from(kReady, Hazard::kMove, "JoystickModeSet is not kept for who connects later.",
         [](ServerBench& server) {
           server.accept("SetJoystickMode:XYZ");
           server.pause(150ms);
           server.leave();
           server.pause(800ms);
           server.connect();
           server.expect_beat(69);
           server.expect_quiet(300ms);
         }),
    variant("heard",
            full(from(kReady, Hazard::kMove, "Nor is an end said again that somebody heard.",
                      [](ServerBench& server) {
                        server.perform("RunObjective:Home", Event::kObjectiveDone);
                        connect_anew(server);
                        server.expect_quiet(300ms);
                      }))),

    must("kinovazed.connection.stays-open", "A client that says nothing stays connected.",
         "server; reference 1.13"),
    full(from(kStopped, Hazard::kObserve, "A client that is silent for 6 s is answered then.",
              [](ServerBench& server) {
                server.expect_quiet(6s);
                server.accept("EStop");
              })),
};

}  // namespace

Chapter connection_chapter() { return chapter("Connections", kConnectionClauses); }

}  // namespace armjig::kinovazed::conformance
