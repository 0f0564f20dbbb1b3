// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

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

void crlf(ServerBench& server) {
  server.send("EStop\r\n");
  server.expect(Event::kAccepted);
  server.expect_silence();
}

void lf(ServerBench& server) {
  server.send("EStop\n");
  server.expect(Event::kAccepted);
  server.expect_silence();
}

void cr_alone(ServerBench& server) {
  server.send("EStop\r");
  server.expect_silence();
  server.send("\n");
  server.expect(Event::kAccepted);
}

void many_cr(ServerBench& server) {
  server.send("EStop\r\r\r\n");
  server.expect(Event::kAccepted);
}

void lf_cr(ServerBench& server) {
  for (int i = 0; i < 3; ++i) {
    server.send("EStop\n\r");
    server.expect(Event::kAccepted);
  }
  server.send("\n");
  server.expect_silence();
}

void split_anywhere(ServerBench& server) {
  constexpr auto kLine = "EStop\r\n"sv;
  for (std::size_t cut = 1; cut < kLine.size(); ++cut) {
    server.about("cut after byte " + std::to_string(cut));
    server.send(kLine.substr(0, cut));
    server.pause(10ms);
    server.send(kLine.substr(cut));
    server.expect(Event::kAccepted);
  }
}

void byte_by_byte(ServerBench& server) {
  for (const char byte : "SetJoystickMode:XYZ\r\n"sv) {
    server.send(std::string{byte});
    server.pause(20ms);
  }
  server.expect(Event::kRejected);
}

void together(ServerBench& server) {
  server.send("EStop\r\nUnfold\r\nQuitEStop\r\nRetract\r\nEStop\r\n");
  for (const auto answer :
       {Event::kAccepted, Event::kRejected, Event::kAccepted, Event::kRejected, Event::kAccepted}) {
    server.expect(answer);
  }
  server.expect_silence();
}

void across(ServerBench& server) {
  for (const auto segment : {"ESt"sv, "op\r\nUnf"sv, "old\r\nEStop\r\nRetr"sv, "act\r\n"sv}) {
    server.send(segment);
    server.pause(20ms);
  }
  for (const auto answer :
       {Event::kAccepted, Event::kRejected, Event::kAccepted, Event::kRejected}) {
    server.expect(answer);
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

constexpr Case kCases[] = {
    {.requirement = "kinovazed.line.crlf",
     .rule = "EStop and CR LF are answered once.",
     .run = on<crlf>},
    {.requirement = "kinovazed.line.end", .rule = "EStop and LF are answered once.", .run = on<lf>},
    {.requirement = "kinovazed.line.cr-alone",
     .rule = "EStop and CR are not answered until the LF comes.",
     .run = on<cr_alone>},
    {.requirement = "kinovazed.line.many-cr",
     .rule = "EStop with three CR is answered.",
     .run = on<many_cr>},
    {.requirement = "kinovazed.line.lf-cr",
     .rule = "Three lines that end with LF CR are answered.",
     .run = on<lf_cr>},
    {.requirement = "kinovazed.line.split-anywhere",
     .rule = "EStop in two segments is answered, for each of six cuts.",
     .run = on<split_anywhere>},
    {.requirement = "kinovazed.line.byte-by-byte",
     .rule = "A command of which a byte comes each 20 ms is answered.",
     .run = on<byte_by_byte>},
    from(kStopped, Hazard::kState, "kinovazed.line.together",
         "Five commands in one segment get their five answers.", on<together>),
    {.requirement = "kinovazed.line.across",
     .rule = "Four commands in four segments that cut them get their answers.",
     .run = on<across>},
    {.requirement = "kinovazed.line.silence",
     .rule = "Six unknown lines get no answer.",
     .run = on<not_understood<kUnknown>>},
    {.requirement = "kinovazed.line.rejected",
     .rule = "Six unknown lines are Rejected.",
     .run = on<not_understood<kUnknown>>},
    {.requirement = "kinovazed.line.argument-count",
     .rule = "Ten commands with wrong counts get no answer.",
     .run = on<not_understood<kWrongCount>>},
    {.requirement = "kinovazed.line.argument-count-rejected",
     .rule = "Ten commands with wrong counts are Rejected.",
     .run = on<not_understood<kWrongCount>>},
    {.requirement = "kinovazed.line.bad-mode",
     .rule = "Five modes that are none get no answer.",
     .run = on<not_understood<kBadModes>>},
    {.requirement = "kinovazed.line.bad-mode-rejected",
     .rule = "Five modes that are none are Rejected.",
     .run = on<not_understood<kBadModes>>},
    {.requirement = "kinovazed.line.bad-objective",
     .rule = "Five objectives that are none get no answer.",
     .run = on<not_understood<kBadObjectives>>},
    {.requirement = "kinovazed.line.bad-objective-rejected",
     .rule = "Five objectives that are none are Rejected.",
     .run = on<not_understood<kBadObjectives>>},
    from(kOff, Hazard::kState, "kinovazed.line.bad-in-any-state",
         "In poweredOff five lines that are no commands get no answer.",
         on<not_understood<kBadAnywhere>>, "off"),
    from(kReady, Hazard::kMove, "kinovazed.line.bad-in-any-state",
         "In idle five lines that are no commands get no answer.", on<not_understood<kBadAnywhere>>,
         "idle"),
    from(kSteering, Hazard::kMove, "kinovazed.line.bad-in-any-state",
         "In steering five lines that are no commands get no answer.",
         on<not_understood<kBadAnywhere>>, "steering"),
    from(kFolded, Hazard::kMove, "kinovazed.line.bad-in-any-state",
         "In retracted five lines that are no commands get no answer.",
         on<not_understood<kBadAnywhere>>, "retracted"),
    from(kOff, Hazard::kState, "kinovazed.line.bad-in-any-state-rejected",
         "In poweredOff five lines that are no commands are Rejected.",
         on<not_understood<kBadAnywhere>>),
    {.requirement = "kinovazed.line.case",
     .rule = "EStop in four other spellings gets no answer.",
     .run = on<not_understood<kOtherCapitals>>},
    {.requirement = "kinovazed.line.case-rejected",
     .rule = "EStop in four other spellings is Rejected.",
     .run = on<not_understood<kOtherCapitals>>},
    {.requirement = "kinovazed.line.whole-name",
     .rule = "Names with something around them get no answer.",
     .run = on<not_understood<kMoreThanAName>>},
    {.requirement = "kinovazed.line.server-words",
     .rule = "Four words of the server get no answer.",
     .run = on<not_understood<kServerWords>>},
    {.requirement = "kinovazed.line.empty",
     .rule = "An empty line gets no answer, and the next command its own.",
     .run = on<passed_over<kEmpty>>},
    {.requirement = "kinovazed.line.blank",
     .rule = "Lines of blanks get no answer.",
     .run = on<passed_over<kBlankLines>>},
    from(kStopped, Hazard::kState, "kinovazed.line.blanks", "EStop with blanks around it stops.",
         on<stops<kBlanksAround>>),
    {.requirement = "kinovazed.line.no-blanks",
     .rule = "EStop with blanks around it is Rejected.",
     .run = on<not_understood<kBlanksAround>>},
    from(kStopped, Hazard::kState, "kinovazed.line.blank-behind-name",
         "EStop with a blank in front of its colon stops.", on<stops<kBlankBehindName>>),
    {.requirement = "kinovazed.line.blank-at-argument",
     .rule = "A mode and an objective with a blank in front get no answer.",
     .run = on<not_understood<kBlanksAtArguments>>},
    from(kStopped, Hazard::kState, "kinovazed.line.trailing-colon",
         "EStop with a colon behind it stops.", on<stops<kColonAtEnd>>),
    {.requirement = "kinovazed.line.no-trailing-colon",
     .rule = "EStop with a colon behind it is Rejected.",
     .run = on<not_understood<kColonAtEnd>>},
    {.requirement = "kinovazed.line.two-colons",
     .rule = "Commands with two colons behind them get no answer.",
     .run = on<not_understood<kTwoColons>>},
    {.requirement = "kinovazed.line.colon-first",
     .rule = "Lines that begin with a colon get no answer.",
     .run = on<not_understood<kColonsInFront>>},
    {.requirement = "kinovazed.line.nul",
     .rule = "NUL in, behind and in front of a name gets no answer.",
     .run = on<not_understood<kNuls>>},
    {.requirement = "kinovazed.line.controls",
     .rule = "Four lines with control characters get no answer.",
     .run = on<not_understood<kControls>>},
    {.requirement = "kinovazed.line.non-ascii",
     .rule = "Four lines with other bytes get no answer.",
     .run = on<not_understood<kNonAscii>>},
    {.requirement = "kinovazed.line.non-ascii-rejected",
     .rule = "Four lines with other bytes are Rejected.",
     .run = on<not_understood<kNonAscii>>},
    {.requirement = "kinovazed.line.number-sign",
     .variant = "refused",
     .rule = "MoveJoystick with signs is understood, and refused here.",
     .run = on<refused<kSigns>>},
    from(kSteering, Hazard::kMove, "kinovazed.line.number-sign",
         "MoveJoystick with signs is Accepted.", on<moved<kSigns>>),
    {.requirement = "kinovazed.line.number-zeros",
     .variant = "refused",
     .rule = "MoveJoystick with zeros in front is understood, and refused here.",
     .run = on<refused<kZeros>>},
    from(kSteering, Hazard::kMove, "kinovazed.line.number-zeros",
         "MoveJoystick with zeros in front is Accepted.", on<moved<kZeros>>),
    {.requirement = "kinovazed.line.number-limits",
     .variant = "refused",
     .rule = "The largest and the smallest number are understood, and refused here.",
     .run = on<refused<kLimits>>},
    {.requirement = "kinovazed.line.number",
     .rule = "Six tails behind numbers are understood, and refused here.",
     .run = on<refused<kTails>>},
    from(kSteering, Hazard::kMove, "kinovazed.line.number-strict",
         "Three tails behind a zero are Rejected in steering.", on<refused<kTailsForSteering>>),
    {.requirement = "kinovazed.line.number-blanks",
     .rule = "Numbers with blanks in front are understood, and refused here.",
     .run = on<refused<kNumberBlanks>>},
    from(kSteering, Hazard::kMove, "kinovazed.line.number-no-blanks",
         "Zeros with a blank in front are Rejected in steering.", on<refused<kBlanksForSteering>>),
    {.requirement = "kinovazed.line.number-too-large",
     .rule = "Three numbers beyond 32 bits get no answer.",
     .run = on<not_understood<kTooLarge>>},
    from(kSteering, Hazard::kMove, "kinovazed.line.number-too-large-rejected",
         "Three numbers beyond 32 bits are Rejected in steering.", on<refused<kTooLarge>>),
    {.requirement = "kinovazed.line.number-missing",
     .rule = "Six moves without a number get no answer.",
     .run = on<not_understood<kNoDigits>>},
    from(kSteering, Hazard::kMove, "kinovazed.line.number-missing-rejected",
         "Six moves without a number are Rejected in steering.", on<refused<kNoDigits>>),
};

}  // namespace

std::span<const Case> line_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
