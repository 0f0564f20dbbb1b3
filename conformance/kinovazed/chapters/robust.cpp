// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum State;

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

void expect_answers(ServerBench& server) {
  server.expect(Event::kAccepted);
  server.expect(Event::kRejected);
}

/// A line of any bytes but LF that cannot be a command.
std::string junk_line(ServerBench& server) {
  std::string line{"?"};
  const auto size = 1 + server.random() % 100;
  while (line.size() < size) {
    const auto byte = static_cast<char>(server.random() & 0xFFU);
    if (byte != '\n') line += byte;
  }
  return line + "\r\n";
}

constexpr Clause kRobustClauses[] = {
    must("kinovazed.robust.flood",
         "Two hundred commands in one go are answered one by one, none lost.",
         "server; reference 2.6"),
    in(kEmergencyStopped, "Two hundred answers to two hundred commands.",
       [](ServerBench& server) {
         constexpr int kPairs = 100;
         server.send(repeated("EStop\r\nUnfold\r\n", kPairs));
         for (int i = 0; i < kPairs; ++i) {
           server.about("pair " + std::to_string(i + 1));
           expect_answers(server);
         }
         server.expect_silence();
       }),

    must("kinovazed.robust.slow-reader", "A client that reads late gets every answer, in order.",
         "server; reference 4.5"),
    in(kEmergencyStopped, "120 answers are there after three seconds.",
       [](ServerBench& server) {
         constexpr int kCommands = 60;
         for (int i = 0; i < kCommands; ++i) server.send("EStop\r\nUnfold\r\n");
         server.as(1);
         server.pause(3s);
         server.as(0);
         for (int i = 0; i < kCommands; ++i) expect_answers(server);
       }),

    must("kinovazed.robust.junk",
         "Lines of junk of any bytes are passed over, however many, and the next command is "
         "served.",
         "server; reference 3", Profiles::kFirmware, "kinovazed.robust.junk-rejected"),
    in(kEmergencyStopped, "EStop after 40 kB of junk is answered.",
       [](ServerBench& server) {
         for (int i = 0; i < 40; ++i) {
           std::string lines;
           while (lines.size() < 1000) lines += junk_line(server);
           server.send(lines);
         }
         server.about("after 40 kB of junk");
         server.accept("EStop");
         server.expect_silence();
       }),

    should("kinovazed.robust.junk-rejected",
           "Lines of junk are Rejected one by one, and the next command is served.",
           "document is silent; our reading", Profiles::kDocumented, "kinovazed.robust.junk"),
    in(kEmergencyStopped, "A hundred lines are Rejected.",
       [](ServerBench& server) {
         for (int i = 0; i < 100; ++i) {
           server.send(junk_line(server));
           server.expect(Event::kRejected);
         }
         server.accept("EStop");
       }),

    must("kinovazed.robust.clients",
         "Twenty clients one after the other are served like the first.", "server; reference 1.6"),
    in(kEmergencyStopped, "Twenty clients get two answers each.",
       [](ServerBench& server) {
         for (int i = 0; i < 20; ++i) {
           server.leave();
           server.connect();
           server.accept("EStop");
           server.refuse("Unfold");
         }
       }),

    must("kinovazed.robust.resets",
         "Clients that reset their connections, one after the other, do no harm.",
         "server; reference 1.9"),
    in(kEmergencyStopped, "EStop is answered after ten resets in the middle of a line.",
       [](ServerBench& server) {
         for (int i = 0; i < 10; ++i) {
           server.send("QuitES");
           server.pause(20ms + 2 * server.noise());  // who waits for its turn yet does harm
           server.throw_away();
           server.connect();
         }
         server.accept("EStop");
       }),

    must("kinovazed.robust.half-closes",
         "Clients that half-close after a command, one after the other, are all answered.",
         "server; reference 1.11"),
    in(kEmergencyStopped, "Ten times Accepted and the end.",
       [](ServerBench& server) {
         for (int i = 0; i < 10; ++i) {
           half_close(server);
           server.connect();
         }
       }),

    must("kinovazed.robust.split-flood",
         "A stream of commands cut anywhere is answered command by command.",
         "server; reference 2.5"),
    in(kEmergencyStopped, "Sixty commands in pieces of up to 20 bytes.",
       [](ServerBench& server) {
         const auto all = repeated("EStop\r\nUnfold\r\n", 30);
         for (std::size_t at = 0; at < all.size();) {
           const auto size = 1 + server.random() % 20;
           server.send(std::string_view{all}.substr(at, size));
           server.pause(5ms);
           at += size;
         }
         for (int i = 0; i < 30; ++i) expect_answers(server);
         server.expect_silence();
       }),

    must("kinovazed.robust.queue",
         "Clients that come and go while another one is served do not disturb it.",
         "server; reference 1.6"),
    in(kEmergencyStopped, "Four clients wait and leave, and the first one is served.",
       [](ServerBench& server) {
         for (std::size_t client = 1; client <= 4; ++client) {
           server.as(client);
           server.connect();
           server.say("EStop");
           server.pause(10ms);
           server.leave();
           server.as(0);
           server.accept("EStop");
         }
         server.expect_beat(3);
       }),
};

}  // namespace

Chapter robust_chapter() { return chapter("Robustness", kRobustClauses); }

}  // namespace armjig::kinovazed::conformance
