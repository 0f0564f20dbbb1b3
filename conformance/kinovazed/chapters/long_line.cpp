// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr auto kChoice = "document is silent; our choice";

/// EStop with blanks in front, so many bytes without the LF.
std::string padded(std::size_t size) { return std::string(size - 5, ' ') + "EStop"; }

/// A command that every server understands, and refuses here.
std::string long_move(std::size_t size) {
  constexpr std::string_view kRest = "MoveJoystick::0:0";
  return "MoveJoystick:" + std::string(size - kRest.size(), '0') + ":0:0";
}

std::string junk(std::size_t size) { return std::string(size, 'B'); }

/// The next client behind one that left so many bytes.
void leave_behind(ServerBench& server, std::size_t size) {
  server.send(junk(size));
  server.pause(200ms);
  server.leave();
  server.connect();
}

constexpr Clause kLongLineClauses[] = {
    must("kinovazed.line.padded",
         "A line that is longer than one read of 128 bytes is served as a whole.",
         "server, recording framing-long-padded-1023", Profiles::kFirmware),
    look("EStop after up to 1095 blanks is answered.",
         [](ServerBench& server) {
           for (const std::size_t size : {100U, 200U, 500U, 1023U, 1100U}) {
             server.about("EStop in " + std::to_string(size) + " bytes");
             server.send(padded(size) + "\n");
             server.expect(Event::kAccepted);
           }
           server.expect_silence();
         }),

    must("kinovazed.line.long-unknown",
         "A long line that is no command is passed over, and the next command served.",
         "server, recording framing-long-junk-200", Profiles::kFirmware),
    look("Lines of 200, 600 and 1100 bytes get no answer.",
         [](ServerBench& server) {
           for (const std::size_t size : {200U, 600U, 1100U}) server.ignored(junk(size) + "\r\n");
         }),

    must("kinovazed.line.longest", "Lines of up to 1152 bytes with their LF are served.",
         "server, transcript T76", Profiles::kFirmware),
    look("EStop in 1152 bytes with its LF is answered.",
         [](ServerBench& server) {
           server.send(padded(1151) + "\n");
           server.expect(Event::kAccepted);
           server.accept("EStop");
         }),

    should("kinovazed.line.longest-documented",
           "A line of 1024 bytes leaves the connection open, and a longer one closes it.", kChoice,
           Profiles::kDocumented, "kinovazed.line.longest"),
    look("1024 bytes are Rejected, and 1030 close.",
         [](ServerBench& server) {
           server.send(junk(1024) + "\n");
           server.expect(Event::kRejected);
           server.accept("EStop");
           server.send(junk(1030) + "\n");
           server.expect_end();
         }),

    must("kinovazed.line.endless", "The 1152nd byte without an LF closes the connection.",
         "server, transcript T77"),
    look("600 bytes without LF wait, 552 more close.",
         [](ServerBench& server) {
           server.send(junk(600));
           server.expect_quiet(300ms);
           server.send(junk(552));
           server.expect_end();
         }),

    must("kinovazed.line.too-long",
         "A line of more than 1152 bytes closes the connection, also if its LF comes with it.",
         "server, recording framing-long-padded-1152"),
    look("EStop in 1153 bytes with its LF closes.",
         [](ServerBench& server) {
           server.send(padded(1152) + "\n");
           server.expect_end();
         }),
    variant("next", look("One that waits when another's line is too long is answered.",
                         [](ServerBench& server) {
                           expect_next_served(server, [](ServerBench& one) {
                             one.send(junk(1152));
                             one.expect_end();
                           });
                         })),

    must("kinovazed.line.behind-endless",
         "After a line that was too long the next client is served from its first line on.",
         "server, recording framing-endless-line"),
    look("The client after one that was closed is answered at once.",
         [](ServerBench& server) {
           server.send(junk(1152));
           server.expect_end();
           server.connect();
           server.accept("EStop");
         }),

    must("kinovazed.line.lf-alone",
         "An LF in a segment of its own is passed over, and the command after it served.",
         "server, recording framing-empty-lf-alone"),
    look("EStop 100 ms after an LF is answered.",
         [](ServerBench& server) {
           server.send("\n");
           server.pause(100ms);
           server.send("EStop\r\n");
           server.expect(Event::kAccepted);
         }),

    must("kinovazed.line.lf-first",
         "An LF that comes first in a read takes the byte after it along, if that was read with "
         "it.",
         "server, transcripts T71, T72 and T74", Profiles::kFirmware, "kinovazed.line.lf-harmless"),
    look("After an LF EStop is lost and XEStop is EStop.",
         [](ServerBench& server) {
           server.ignored("\nEStop\r\n");
           server.about("LF and XEStop");
           server.send("\nXEStop\r\n");
           server.expect(Event::kAccepted);
           server.about("EStop, two LF, EStop");
           server.send("EStop\n\nEStop\n");
           server.expect(Event::kAccepted);
           server.expect_silence();
         }),

    should("kinovazed.line.lf-harmless", "An LF in front of a command costs nothing.", kChoice,
           Profiles::kDocumented, "kinovazed.line.lf-first"),
    look("EStop directly after an LF is answered.",
         [](ServerBench& server) {
           server.send("\nEStop\r\n");
           server.expect(Event::kAccepted);
           server.send("EStop\n\nEStop\n");
           server.expect(Event::kAccepted);
           server.expect(Event::kAccepted);
         }),

    must("kinovazed.line.lf-boundary",
         "The LF after a line of 128 bytes takes the byte after it along, if that was read with "
         "it.",
         "server; reference 2.12", Profiles::kFirmware, "kinovazed.line.lf-boundary-harmless"),
    look("After EStop in 128 bytes and its LF the next one is lost.",
         [](ServerBench& server) {
           server.send(padded(128) + "\nEStop\r\n");
           server.expect(Event::kAccepted);
           server.expect_silence();
         }),

    should("kinovazed.line.lf-boundary-harmless",
           "A line of 128 bytes costs the next command nothing.", kChoice, Profiles::kDocumented,
           "kinovazed.line.lf-boundary"),
    look("EStop after a line of 128 bytes is answered.",
         [](ServerBench& server) {
           server.send(long_move(128) + "\nEStop\r\n");
           server.expect(Event::kRejected);
           server.expect(Event::kAccepted);
         }),

    must("kinovazed.line.beside-boundary",
         "A line of 127 or 129 bytes costs the next command nothing.", "server; reference 2.12"),
    look("EStop after lines of 127 and of 129 bytes is answered.",
         [](ServerBench& server) {
           for (const std::size_t size : {127U, 129U}) {
             server.about("the command after one of " + std::to_string(size) + " bytes");
             server.send(long_move(size) + "\nEStop\r\n");
             server.expect(Event::kRejected);
             server.expect(Event::kAccepted);
           }
         }),

    must("kinovazed.line.boundary-alone",
         "A line of 128 bytes costs a command that comes later nothing.",
         "server, recording framing-boundary-alone"),
    look("EStop 200 ms after a line of 128 bytes is answered.",
         [](ServerBench& server) {
           server.send(long_move(128) + "\n");
           server.expect(Event::kRejected);
           server.pause(200ms);
           server.send("EStop\r\n");
           server.expect(Event::kAccepted);
         }),

    must("kinovazed.line.carry-over",
         "Whole pieces of 128 bytes that a client left without an LF spoil the next client's first "
         "line, and only that.",
         "server, transcript S1", Profiles::kFirmware, "kinovazed.line.no-carry-over"),
    look("128 bytes of the client before cost one line.",
         [](ServerBench& server) {
           leave_behind(server, 128);
           server.about("the first line after 128 bytes of the client before");
           server.say("EStop");
           server.expect_silence();
           server.accept("EStop");
         }),

    should("kinovazed.line.no-carry-over",
           "128 bytes that a client left without an LF do not spoil the next client's first line.",
           kChoice, Profiles::kDocumented, "kinovazed.line.carry-over"),
    look("128 bytes of the client before cost nothing.",
         [](ServerBench& server) {
           leave_behind(server, 128);
           server.accept("EStop");
         }),

    must("kinovazed.line.carry-over-short",
         "127 bytes that a client left without an LF leave no trace.", "server, transcript S1"),
    look("127 bytes of the client before cost nothing.",
         [](ServerBench& server) {
           leave_behind(server, 127);
           server.accept("EStop");
         }),

    must("kinovazed.line.carry-over-counts",
         "What was carried over counts for the length of the next client's first line.",
         "server; reference 2.15", Profiles::kFirmware),
    look("After 1024 bytes of the client before 128 more close.",
         [](ServerBench& server) {
           leave_behind(server, 1024);
           server.send(junk(127));
           server.expect_quiet(300ms);
           server.send(junk(1));
           server.expect_end();
         }),
};

}  // namespace

Chapter long_line_chapter() { return chapter("Long lines and line feeds", kLongLineClauses); }

}  // namespace armjig::kinovazed::conformance
