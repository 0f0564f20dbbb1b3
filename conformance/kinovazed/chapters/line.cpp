// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr auto kSilent = "document is silent; our reading";

using namespace std::string_view_literals;

constexpr std::array kUnknown{"Foo"sv,     "E Stop"sv, "EStop;QuitEStop"sv, "EStop QuitEStop"sv,
                              "Bogus:1"sv, "Stop"sv};

constexpr std::array kWrongCount{"EStop:1"sv,
                                 "QuitEStop:1:2"sv,
                                 "SetJoystickMode"sv,
                                 "SetJoystickMode:XYZ:1"sv,
                                 "RunObjective"sv,
                                 "RunObjective:Home:x"sv,
                                 "MoveJoystick"sv,
                                 "MoveJoystick:1:2"sv,
                                 "MoveJoystick:1:2:3:4"sv,
                                 "MoveJoystick:1,2,3"sv};

constexpr std::array kBadModes{"SetJoystickMode:xyz"sv, "SetJoystickMode:1"sv,
                               "SetJoystickMode::"sv, "SetJoystickMode:Axis1to6"sv,
                               "SetJoystickMode:Nowhere"sv};

constexpr std::array kBadObjectives{"RunObjective:Bell"sv, "RunObjective:home"sv,
                                    "RunObjective:1"sv, "RunObjective::Home"sv,
                                    "RunObjective:Nowhere"sv};

constexpr std::array kOtherCapitals{"estop"sv, "ESTOP"sv, "eStop"sv, "Estop"sv};

constexpr std::array kMoreThanAName{"EStopX"sv, "XEStop"sv, "EStop.Now"sv, "EStopEStop"sv};

constexpr std::array kServerWords{"Accepted"sv, "Rejected"sv, "Heartbeat:3"sv, "Initialized"sv};

constexpr std::array kBlankLines{"   "sv, "\t \v\f"sv};

constexpr std::array kBlanksAround{"  EStop"sv, "EStop  "sv, "\tEStop\t"sv, "  \t EStop \t "sv};

constexpr std::array kBlanksAtArguments{"SetJoystickMode: XYZ"sv, "RunObjective: Home"sv};

constexpr std::array kColonsInFront{":EStop"sv, ":"sv, "::::"sv};

constexpr std::array kTwoColons{"EStop::"sv, "EStop: :"sv, "QuitEStop::"sv};

constexpr std::array kNuls{"Quit\0EStop"sv, "EStop\0"sv, "\0EStop"sv};

constexpr std::array kControls{"\x01\x02\x03"sv, "EStopX\b"sv, "EStop\x7F"sv, "\x1B[AEStop"sv};

constexpr std::array kNonAscii{
    "\xEF\xBB\xBF"
    "EStop"sv,
    "\xC3\x89Stop"sv, "EStop\xA0"sv,
    "\xFF\xFD\x01"
    "EStop"sv};

constexpr std::array kTooLarge{"MoveJoystick:2147483648:0:0"sv, "MoveJoystick:0:-2147483649:0"sv,
                               "MoveJoystick:0:0:99999999999999999999"sv};

constexpr std::array kNoDigits{"MoveJoystick::0:0"sv,    "MoveJoystick:a:b:c"sv,
                               "MoveJoystick:-:0:0"sv,   "MoveJoystick:0:+-1:0"sv,
                               "MoveJoystick:0:0:- 1"sv, "MoveJoystick::::"sv};

template <const auto& lines>
void not_understood(ServerBench& server) {
  for (const auto line : lines) server.not_understood(line);
  server.expect_silence();
}

/// In emergencyStopped everything that is understood is `Rejected`, and EStop `Accepted`.
template <const auto& lines>
void stops(ServerBench& server) {
  for (const auto line : lines) {
    server.accept("QuitEStop");
    server.about(std::string{line});
    server.say(line);
    server.expect(Event::kAccepted);
    server.expect_probe();
  }
  server.expect_silence();
}

template <const auto& lines>
void passed_over(ServerBench& server) {
  for (const auto line : lines) server.ignored(std::string{line} + "\r\n");
  server.expect_silence();
}

template <const auto& lines>
void refused(ServerBench& server) {
  for (const auto line : lines) server.refuse(line);
  server.expect_silence();
}

/// In steering a move that is understood is `Accepted`.
template <const auto& lines>
void moved(ServerBench& server) {
  for (const auto line : lines) {
    server.accept(line);
    server.accept("MoveJoystick:0:0:0");
  }
}

constexpr std::array kBadAnywhere{"Initialize:now"sv, "MoveJoystick:1:2"sv,
                                  "RunObjective:Nowhere"sv, "SetJoystickMode:Nowhere"sv, "Bogus"sv};

constexpr std::array kEmpty{""sv};

constexpr std::array kBlankBehindName{"EStop :"sv, "EStop\t:"sv};

constexpr std::array kColonAtEnd{"EStop:"sv};

constexpr std::array kSigns{"MoveJoystick:+5:-5:+0"sv, "MoveJoystick:-7:+8:-0"sv};

constexpr std::array kZeros{"MoveJoystick:005:-003:0000000000000"sv};

constexpr std::array kLimits{"MoveJoystick:2147483647:0:0"sv, "MoveJoystick:0:-2147483648:0"sv};

constexpr std::array kTails{"MoveJoystick:1.9:1e3:0x10"sv, "MoveJoystick:1x:2 :3_"sv};

constexpr std::array kNumberBlanks{"MoveJoystick: 4:\t5:\v6"sv};

constexpr std::array kTailsForSteering{"MoveJoystick:0.9:0:0"sv, "MoveJoystick:0:0e3:0"sv,
                                       "MoveJoystick:0:0:0x10"sv};

constexpr std::array kBlanksForSteering{"MoveJoystick: 0:0:0"sv, "MoveJoystick:0:0: 0"sv};

constexpr Clause kLineClauses[] = {
    must("kinovazed.line.crlf", "CR LF ends a line.", "document; server, recording framing-crlf"),
    look("EStop and CR LF are answered once.",
         [](ServerBench& server) {
           server.send("EStop\r\n");
           server.expect(Event::kAccepted);
           server.expect_silence();
         }),

    must("kinovazed.line.end", "LF alone ends a line.", "server, recording framing-lf"),
    look("EStop and LF are answered once.",
         [](ServerBench& server) {
           server.send("EStop\n");
           server.expect(Event::kAccepted);
           server.expect_silence();
         }),

    must("kinovazed.line.cr-alone", "CR alone ends no line.", "server, transcript T62"),
    look("EStop and CR are not answered until the LF comes.",
         [](ServerBench& server) {
           server.send("EStop\r");
           server.expect_silence();
           server.send("\n");
           server.expect(Event::kAccepted);
         }),

    must("kinovazed.line.many-cr", "Several CR in front of the LF are no part of a line.",
         "server; reference 2.4", Profiles::kFirmware),
    look("EStop with three CR is answered.",
         [](ServerBench& server) {
           server.send("EStop\r\r\r\n");
           server.expect(Event::kAccepted);
         }),

    must("kinovazed.line.lf-cr", "A CR after an LF is a blank in front of the next line.",
         "server, recording framing-lfcr", Profiles::kFirmware),
    look("Three lines that end with LF CR are answered.",
         [](ServerBench& server) {
           for (int i = 0; i < 3; ++i) {
             server.send("EStop\n\r");
             server.expect(Event::kAccepted);
           }
           server.send("\n");
           server.expect_silence();
         }),

    must("kinovazed.line.split-anywhere", "A line may come in two segments, wherever it is cut.",
         "server, recording framing-byte-by-byte"),
    look("EStop in two segments is answered, for each of six cuts.",
         [](ServerBench& server) {
           constexpr auto kLine = "EStop\r\n"sv;
           for (std::size_t cut = 1; cut < kLine.size(); ++cut) {
             server.about("cut after byte " + std::to_string(cut));
             server.send(kLine.substr(0, cut));
             server.pause(10ms);
             server.send(kLine.substr(cut));
             server.expect(Event::kAccepted);
           }
         }),

    must("kinovazed.line.byte-by-byte", "A line may come byte by byte, with pauses.",
         "server, recording framing-byte-by-byte"),
    look("A command of which a byte comes each 20 ms is answered.",
         [](ServerBench& server) {
           for (const char byte : "SetJoystickMode:XYZ\r\n"sv) {
             server.send(std::string{byte});
             server.pause(20ms);
           }
           server.expect(Event::kRejected);
         }),

    must("kinovazed.line.together", "Several lines in one segment are all served, in their order.",
         "server, recording framing-pipelined"),
    from(kStopped, Hazard::kState, "Five commands in one segment get their five answers.",
         [](ServerBench& server) {
           server.send("EStop\r\nUnfold\r\nQuitEStop\r\nRetract\r\nEStop\r\n");
           for (const auto answer : {Event::kAccepted, Event::kRejected, Event::kAccepted,
                                     Event::kRejected, Event::kAccepted}) {
             server.expect(answer);
           }
           server.expect_silence();
         }),

    must("kinovazed.line.across",
         "Segments may hold the end of one line and the beginning of the next.",
         "server; reference 2.5"),
    look("Four commands in four segments that cut them get their answers.",
         [](ServerBench& server) {
           for (const auto segment :
                {"ESt"sv, "op\r\nUnf"sv, "old\r\nEStop\r\nRetr"sv, "act\r\n"sv}) {
             server.send(segment);
             server.pause(20ms);
           }
           for (const auto answer :
                {Event::kAccepted, Event::kRejected, Event::kAccepted, Event::kRejected}) {
             server.expect(answer);
           }
         }),

    must("kinovazed.line.silence", "A line with an unknown word gets no answer.",
         "server, recording framing-unknown", Profiles::kFirmware, "kinovazed.line.rejected"),
    look("Six unknown lines get no answer.", on<not_understood<kUnknown>>),

    should("kinovazed.line.rejected", "A line with an unknown word is Rejected.", kSilent,
           Profiles::kDocumented, "kinovazed.line.silence"),
    look("Six unknown lines are Rejected.", on<not_understood<kUnknown>>),

    must("kinovazed.line.argument-count",
         "A command with too few or too many arguments gets no answer.",
         "server, recording framing-arg-count", Profiles::kFirmware,
         "kinovazed.line.argument-count-rejected"),
    look("Ten commands with wrong counts get no answer.", on<not_understood<kWrongCount>>),

    should("kinovazed.line.argument-count-rejected",
           "A command with too few or too many arguments is Rejected.", kSilent,
           Profiles::kDocumented, "kinovazed.line.argument-count"),
    look("Ten commands with wrong counts are Rejected.", on<not_understood<kWrongCount>>),

    must("kinovazed.line.bad-mode",
         "SetJoystickMode with anything but one of the five modes gets no answer.",
         "server; reference 3.2", Profiles::kFirmware, "kinovazed.line.bad-mode-rejected"),
    look("Five modes that are none get no answer.", on<not_understood<kBadModes>>),

    should("kinovazed.line.bad-mode-rejected",
           "SetJoystickMode with anything but one of the five modes is Rejected.", kSilent,
           Profiles::kDocumented, "kinovazed.line.bad-mode"),
    look("Five modes that are none are Rejected.", on<not_understood<kBadModes>>),

    must("kinovazed.line.bad-objective", "RunObjective with an unknown objective gets no answer.",
         "server, recording names-objectives-unknown", Profiles::kFirmware,
         "kinovazed.line.bad-objective-rejected"),
    look("Five objectives that are none get no answer.", on<not_understood<kBadObjectives>>),

    should("kinovazed.line.bad-objective-rejected",
           "RunObjective with an unknown objective is Rejected.", kSilent, Profiles::kDocumented,
           "kinovazed.line.bad-objective"),
    look("Five objectives that are none are Rejected.", on<not_understood<kBadObjectives>>),

    must("kinovazed.line.bad-in-any-state",
         "What is no command gets no answer also where the state would refuse the command.",
         "server, recording names-bad-in-wrong-state", Profiles::kFirmware,
         "kinovazed.line.bad-in-any-state-rejected"),
    variant("off", from(kOff, Hazard::kState,
                        "In poweredOff five lines that are no commands get no answer.",
                        on<not_understood<kBadAnywhere>>)),
    variant("idle",
            from(kReady, Hazard::kMove, "In idle five lines that are no commands get no answer.",
                 on<not_understood<kBadAnywhere>>)),
    variant("steering", from(kInMode, Hazard::kMove,
                             "In steering five lines that are no commands get no answer.",
                             on<not_understood<kBadAnywhere>>)),
    variant("retracted", from(kFolded, Hazard::kMove,
                              "In retracted five lines that are no commands get no answer.",
                              on<not_understood<kBadAnywhere>>)),

    should("kinovazed.line.bad-in-any-state-rejected",
           "What is no command is Rejected in every state.", kSilent, Profiles::kDocumented,
           "kinovazed.line.bad-in-any-state"),
    from(kOff, Hazard::kState, "In poweredOff five lines that are no commands are Rejected.",
         on<not_understood<kBadAnywhere>>),

    must("kinovazed.line.case", "Names are compared byte by byte: other capitals make no command.",
         "server, recording framing-case", Profiles::kFirmware, "kinovazed.line.case-rejected"),
    look("EStop in four other spellings gets no answer.", on<not_understood<kOtherCapitals>>),

    should("kinovazed.line.case-rejected", "A command in other capitals is Rejected.", kSilent,
           Profiles::kDocumented, "kinovazed.line.case"),
    look("EStop in four other spellings is Rejected.", on<not_understood<kOtherCapitals>>),

    must("kinovazed.line.whole-name", "A name with something before or after it makes no command.",
         "server; reference 3.3", Profiles::kFirmware),
    look("Names with something around them get no answer.", on<not_understood<kMoreThanAName>>),

    must("kinovazed.line.server-words", "The server's own words, sent to it, are no commands.",
         "server; reference 3.3", Profiles::kFirmware),
    look("Four words of the server get no answer.", on<not_understood<kServerWords>>),

    must("kinovazed.line.empty", "An empty line of CR LF is passed over.",
         "server, recording framing-empty-crlf"),
    look("An empty line gets no answer, and the next command its own.", on<passed_over<kEmpty>>),

    must("kinovazed.line.blank", "A line of blanks is passed over.",
         "server, recording framing-blank-and-colon", Profiles::kFirmware),
    look("Lines of blanks get no answer.", on<passed_over<kBlankLines>>),

    must("kinovazed.line.blanks", "Blanks around a line do not count.",
         "server, recording framing-blanks", Profiles::kFirmware, "kinovazed.line.no-blanks"),
    from(kStopped, Hazard::kState, "EStop with blanks around it stops.", on<stops<kBlanksAround>>),

    should("kinovazed.line.no-blanks", "A command with blanks around it is Rejected.", kSilent,
           Profiles::kDocumented, "kinovazed.line.blanks"),
    look("EStop with blanks around it is Rejected.", on<not_understood<kBlanksAround>>),

    must("kinovazed.line.blank-behind-name", "Blanks between a name and its colon do not count.",
         "server, transcript T65", Profiles::kFirmware),
    from(kStopped, Hazard::kState, "EStop with a blank in front of its colon stops.",
         on<stops<kBlankBehindName>>),

    must("kinovazed.line.blank-at-argument",
         "A blank in front of a mode or an objective makes no command.", "server, transcript T88",
         Profiles::kFirmware),
    look("A mode and an objective with a blank in front get no answer.",
         on<not_understood<kBlanksAtArguments>>),

    must("kinovazed.line.trailing-colon", "One colon at the end of a line is free.",
         "server, recording framing-extra-colons", Profiles::kFirmware,
         "kinovazed.line.no-trailing-colon"),
    from(kStopped, Hazard::kState, "EStop with a colon after it stops.", on<stops<kColonAtEnd>>),

    should("kinovazed.line.no-trailing-colon",
           "A command with a colon too many at its end is Rejected.", kSilent,
           Profiles::kDocumented, "kinovazed.line.trailing-colon"),
    look("EStop with a colon after it is Rejected.", on<not_understood<kColonAtEnd>>),

    must("kinovazed.line.two-colons", "A second colon at the end makes no command.",
         "server, transcript T66", Profiles::kFirmware),
    look("Commands with two colons after them get no answer.", on<not_understood<kTwoColons>>),

    must("kinovazed.line.colon-first", "A colon in front of a name makes no command.",
         "server, recording framing-blank-and-colon", Profiles::kFirmware),
    look("Lines that begin with a colon get no answer.", on<not_understood<kColonsInFront>>),

    must("kinovazed.line.nul", "A NUL in or after a name makes no command.",
         "server, recording framing-nul", Profiles::kFirmware),
    look("NUL in, after and before a name gets no answer.", on<not_understood<kNuls>>),

    must("kinovazed.line.controls",
         "Control characters that are no blanks, backspace and DEL among them, make no command.",
         "server, recording framing-controls", Profiles::kFirmware),
    look("Four lines with control characters get no answer.", on<not_understood<kControls>>),

    must("kinovazed.line.non-ascii",
         "Bytes beyond ASCII, a byte order mark among them, make no command.",
         "server, recording framing-utf8", Profiles::kFirmware,
         "kinovazed.line.non-ascii-rejected"),
    look("Four lines with other bytes get no answer.", on<not_understood<kNonAscii>>),

    must("kinovazed.line.non-ascii-rejected", "A line with bytes beyond ASCII is Rejected.",
         "document: strictly ASCII", Profiles::kDocumented, "kinovazed.line.non-ascii"),
    look("Four lines with other bytes are Rejected.", on<not_understood<kNonAscii>>),

    must("kinovazed.line.number-sign", "A number may have a sign.",
         "server, recording joystick-numbers-ok"),
    variant("refused",
            look("MoveJoystick with signs is understood, and refused here.", on<refused<kSigns>>)),
    from(kInMode, Hazard::kMove, "MoveJoystick with signs is Accepted.", on<moved<kSigns>>),

    must("kinovazed.line.number-zeros", "A number may have zeros in front.",
         "server, recording joystick-numbers-ok"),
    variant("refused", look("MoveJoystick with zeros in front is understood, and refused here.",
                            on<refused<kZeros>>)),
    from(kInMode, Hazard::kMove, "MoveJoystick with zeros in front is Accepted.",
         on<moved<kZeros>>),

    must("kinovazed.line.number-limits",
         "Every number of 32 bits with a sign is one, its limits included.",
         "server; reference 3.2"),
    variant("refused", look("The largest and the smallest number are understood, and refused here.",
                            on<refused<kLimits>>)),

    must("kinovazed.line.number", "What stands after the digits of a number is passed over.",
         "server, recording joystick-numbers-tail", Profiles::kFirmware,
         "kinovazed.line.number-strict"),
    look("Six tails after numbers are understood, and refused here.", on<refused<kTails>>),

    should("kinovazed.line.number-strict", "A number with anything after its digits is Rejected.",
           kSilent, Profiles::kDocumented, "kinovazed.line.number"),
    from(kInMode, Hazard::kMove, "Three tails after a zero are Rejected in steering.",
         on<refused<kTailsForSteering>>),

    must("kinovazed.line.number-blanks", "Blanks in front of a number do not count.",
         "server, recording joystick-numbers-ok", Profiles::kFirmware,
         "kinovazed.line.number-no-blanks"),
    look("Numbers with blanks in front are understood, and refused here.",
         on<refused<kNumberBlanks>>),

    should("kinovazed.line.number-no-blanks", "A number with a blank in front is Rejected.",
           kSilent, Profiles::kDocumented, "kinovazed.line.number-blanks"),
    from(kInMode, Hazard::kMove, "Zeros with a blank in front are Rejected in steering.",
         on<refused<kBlanksForSteering>>),

    must("kinovazed.line.number-too-large", "A number beyond 32 bits makes no command.",
         "server, transcript T86", Profiles::kFirmware, "kinovazed.line.number-too-large-rejected"),
    look("Three numbers beyond 32 bits get no answer.", on<not_understood<kTooLarge>>),

    should("kinovazed.line.number-too-large-rejected",
           "A command with a number beyond 32 bits is Rejected.", kSilent, Profiles::kDocumented,
           "kinovazed.line.number-too-large"),
    from(kInMode, Hazard::kMove, "Three numbers beyond 32 bits are Rejected in steering.",
         on<refused<kTooLarge>>),

    must("kinovazed.line.number-missing", "A number without digits makes no command.",
         "server, recording joystick-numbers-bad", Profiles::kFirmware,
         "kinovazed.line.number-missing-rejected"),
    look("Six moves without a number get no answer.", on<not_understood<kNoDigits>>),

    should("kinovazed.line.number-missing-rejected",
           "A command with a number without digits is Rejected.", kSilent, Profiles::kDocumented,
           "kinovazed.line.number-missing"),
    from(kInMode, Hazard::kMove, "Six moves without a number are Rejected in steering.",
         on<refused<kNoDigits>>),
};

}  // namespace

Chapter line_chapter() { return chapter("Lines", kLineClauses); }

}  // namespace armjig::kinovazed::conformance
