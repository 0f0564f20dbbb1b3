// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

/// EStop with blanks in front, so many bytes without the LF.
std::string padded(std::size_t size) { return std::string(size - 5, ' ') + "EStop"; }

/// A command that every server understands, and refuses here.
std::string long_move(std::size_t size) {
  constexpr std::string_view kRest = "MoveJoystick::0:0";
  return "MoveJoystick:" + std::string(size - kRest.size(), '0') + ":0:0";
}

std::string junk(std::size_t size) { return std::string(size, 'B'); }

void padded_lines(ServerBench& server) {
  for (const std::size_t size : {100U, 200U, 500U, 1023U, 1100U}) {
    server.about("EStop in " + std::to_string(size) + " bytes");
    server.send(padded(size) + "\n");
    server.expect(Event::kAccepted);
  }
  server.expect_silence();
}

void long_unknown(ServerBench& server) {
  for (const std::size_t size : {200U, 600U, 1100U}) server.ignored(junk(size) + "\r\n");
}

void longest(ServerBench& server) {
  server.send(padded(1151) + "\n");
  server.expect(Event::kAccepted);
  server.accept("EStop");
}

void longest_documented(ServerBench& server) {
  server.send(junk(1024) + "\n");
  server.expect(Event::kRejected);
  server.accept("EStop");
  server.send(junk(1030) + "\n");
  server.expect_end();
}

void endless(ServerBench& server) {
  server.send(junk(600));
  server.expect_quiet(300ms);
  server.send(junk(552));
  server.expect_end();
}

void too_long(ServerBench& server) {
  server.send(padded(1152) + "\n");
  server.expect_end();
}

void behind_endless(ServerBench& server) {
  server.send(junk(1152));
  server.expect_end();
  server.connect();
  server.accept("EStop");
}

void lf_alone(ServerBench& server) {
  server.send("\n");
  server.pause(100ms);
  server.send("EStop\r\n");
  server.expect(Event::kAccepted);
}

void lf_first(ServerBench& server) {
  server.ignored("\nEStop\r\n");
  server.about("LF and XEStop");
  server.send("\nXEStop\r\n");
  server.expect(Event::kAccepted);
  server.about("EStop, two LF, EStop");
  server.send("EStop\n\nEStop\n");
  server.expect(Event::kAccepted);
  server.expect_silence();
}

void lf_harmless(ServerBench& server) {
  server.send("\nEStop\r\n");
  server.expect(Event::kAccepted);
  server.send("EStop\n\nEStop\n");
  server.expect(Event::kAccepted);
  server.expect(Event::kAccepted);
}

void lf_boundary(ServerBench& server) {
  server.send(padded(128) + "\nEStop\r\n");
  server.expect(Event::kAccepted);
  server.expect_silence();
}

void lf_boundary_harmless(ServerBench& server) {
  server.send(long_move(128) + "\nEStop\r\n");
  server.expect(Event::kRejected);
  server.expect(Event::kAccepted);
}

void beside_boundary(ServerBench& server) {
  for (const std::size_t size : {127U, 129U}) {
    server.about("the command behind one of " + std::to_string(size) + " bytes");
    server.send(long_move(size) + "\nEStop\r\n");
    server.expect(Event::kRejected);
    server.expect(Event::kAccepted);
  }
}

void boundary_alone(ServerBench& server) {
  server.send(long_move(128) + "\n");
  server.expect(Event::kRejected);
  server.pause(200ms);
  server.send("EStop\r\n");
  server.expect(Event::kAccepted);
}

/// The next client behind one that left so many bytes.
void leave_behind(ServerBench& server, std::size_t size) {
  server.send(junk(size));
  server.pause(200ms);
  server.leave();
  server.connect();
}

void carry_over(ServerBench& server) {
  leave_behind(server, 128);
  server.about("the first line behind 128 bytes of the client before");
  server.say("EStop");
  server.expect_silence();
  server.accept("EStop");
}

void no_carry_over(ServerBench& server) {
  leave_behind(server, 128);
  server.accept("EStop");
}

void carry_over_short(ServerBench& server) {
  leave_behind(server, 127);
  server.accept("EStop");
}

void carry_over_counts(ServerBench& server) {
  leave_behind(server, 1024);
  server.send(junk(127));
  server.expect_quiet(300ms);
  server.send(junk(1));
  server.expect_end();
}

constexpr Case kCases[] = {
    {.requirement = "kinovazed.line.padded",
     .rule = "EStop behind up to 1095 blanks is answered.",
     .run = on<padded_lines>},
    {.requirement = "kinovazed.line.long-unknown",
     .rule = "Lines of 200, 600 and 1100 bytes get no answer.",
     .run = on<long_unknown>},
    {.requirement = "kinovazed.line.longest",
     .rule = "EStop in 1152 bytes with its LF is answered.",
     .run = on<longest>},
    {.requirement = "kinovazed.line.longest-documented",
     .rule = "1024 bytes are Rejected, and 1030 close.",
     .run = on<longest_documented>},
    {.requirement = "kinovazed.line.endless",
     .rule = "600 bytes without LF wait, 552 more close.",
     .run = on<endless>},
    {.requirement = "kinovazed.line.too-long",
     .rule = "EStop in 1153 bytes with its LF closes.",
     .run = on<too_long>},
    {.requirement = "kinovazed.line.behind-endless",
     .rule = "The client behind one that was closed is answered at once.",
     .run = on<behind_endless>},
    {.requirement = "kinovazed.line.lf-alone",
     .rule = "EStop 100 ms behind an LF is answered.",
     .run = on<lf_alone>},
    {.requirement = "kinovazed.line.lf-first",
     .rule = "Behind an LF EStop is lost and XEStop is EStop.",
     .run = on<lf_first>},
    {.requirement = "kinovazed.line.lf-harmless",
     .rule = "EStop directly behind an LF is answered.",
     .run = on<lf_harmless>},
    {.requirement = "kinovazed.line.lf-boundary",
     .rule = "Behind EStop in 128 bytes and its LF the next one is lost.",
     .run = on<lf_boundary>},
    {.requirement = "kinovazed.line.lf-boundary-harmless",
     .rule = "EStop behind a line of 128 bytes is answered.",
     .run = on<lf_boundary_harmless>},
    {.requirement = "kinovazed.line.beside-boundary",
     .rule = "EStop behind lines of 127 and of 129 bytes is answered.",
     .run = on<beside_boundary>},
    {.requirement = "kinovazed.line.boundary-alone",
     .rule = "EStop 200 ms behind a line of 128 bytes is answered.",
     .run = on<boundary_alone>},
    {.requirement = "kinovazed.line.carry-over",
     .rule = "128 bytes of the client before cost one line.",
     .run = on<carry_over>},
    {.requirement = "kinovazed.line.no-carry-over",
     .rule = "128 bytes of the client before cost nothing.",
     .run = on<no_carry_over>},
    {.requirement = "kinovazed.line.carry-over-short",
     .rule = "127 bytes of the client before cost nothing.",
     .run = on<carry_over_short>},
    {.requirement = "kinovazed.line.carry-over-counts",
     .rule = "Behind 1024 bytes of the client before 128 more close.",
     .run = on<carry_over_counts>},
};

}  // namespace

std::span<const Case> long_line_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
