// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum emulation::State;

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

void expect_answers(ServerBench& server) {
  server.expect(Event::kAccepted);
  server.expect(Event::kRejected);
}

void flood(ServerBench& server) {
  constexpr int kPairs = 100;
  server.send(repeated("EStop\r\nUnfold\r\n", kPairs));
  for (int i = 0; i < kPairs; ++i) {
    server.about("pair " + std::to_string(i + 1));
    expect_answers(server);
  }
  server.expect_silence();
}

void slow_reader(ServerBench& server) {
  constexpr int kCommands = 60;
  for (int i = 0; i < kCommands; ++i) server.send("EStop\r\nUnfold\r\n");
  server.as(1);
  server.pause(3s);
  server.as(0);
  for (int i = 0; i < kCommands; ++i) expect_answers(server);
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

void junk(ServerBench& server) {
  for (int i = 0; i < 40; ++i) {
    std::string lines;
    while (lines.size() < 1000) lines += junk_line(server);
    server.send(lines);
  }
  server.about("behind 40 kB of junk");
  server.accept("EStop");
  server.expect_silence();
}

void junk_rejected(ServerBench& server) {
  for (int i = 0; i < 100; ++i) {
    server.send(junk_line(server));
    server.expect(Event::kRejected);
  }
  server.accept("EStop");
}

void clients(ServerBench& server) {
  for (int i = 0; i < 20; ++i) {
    server.leave();
    server.connect();
    server.accept("EStop");
    server.refuse("Unfold");
  }
}

void resets(ServerBench& server) {
  for (int i = 0; i < 10; ++i) {
    server.send("QuitES");
    server.pause(20ms);
    server.throw_away();
    server.connect();
  }
  server.accept("EStop");
}

void half_closes(ServerBench& server) {
  for (int i = 0; i < 10; ++i) {
    half_close(server);
    server.connect();
  }
}

void split_flood(ServerBench& server) {
  const auto all = repeated("EStop\r\nUnfold\r\n", 30);
  for (std::size_t at = 0; at < all.size();) {
    const auto size = 1 + server.random() % 20;
    server.send(std::string_view{all}.substr(at, size));
    server.pause(5ms);
    at += size;
  }
  for (int i = 0; i < 30; ++i) expect_answers(server);
  server.expect_silence();
}

void queue(ServerBench& server) {
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
}

constexpr Case kCases[] = {
    in(kEmergencyStopped, "kinovazed.robust.flood", "Two hundred answers to two hundred commands.",
       on<flood>),
    in(kEmergencyStopped, "kinovazed.robust.slow-reader",
       "120 answers are there after three seconds.", on<slow_reader>),
    in(kEmergencyStopped, "kinovazed.robust.junk", "EStop behind 40 kB of junk is answered.",
       on<junk>),
    in(kEmergencyStopped, "kinovazed.robust.junk-rejected", "A hundred lines are Rejected.",
       on<junk_rejected>),
    in(kEmergencyStopped, "kinovazed.robust.clients", "Twenty clients get two answers each.",
       on<clients>),
    in(kEmergencyStopped, "kinovazed.robust.resets",
       "EStop is answered behind ten resets in the middle of a line.", on<resets>),
    in(kEmergencyStopped, "kinovazed.robust.half-closes", "Ten times Accepted and the end.",
       on<half_closes>),
    in(kEmergencyStopped, "kinovazed.robust.split-flood",
       "Sixty commands in pieces of up to 20 bytes.", on<split_flood>),
    in(kEmergencyStopped, "kinovazed.robust.queue",
       "Four clients wait and leave, and the first one is served.", on<queue>),
};

}  // namespace

std::span<const Case> robust_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
