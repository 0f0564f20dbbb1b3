// SPDX-License-Identifier: Apache-2.0
#include <numeric>

#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

/// Codes that neither move anything nor change a state.
constexpr int kHarmlessCodes[] = {0, 1, 42, 99, 104, 122, 124, 155, 157, 200, 254, 255};

/// J5 of a homed arm, driven beyond its 6400 steps and back.
Answer beyond_range(BoardBench& board) {
  constexpr std::size_t kJoint = 4;
  const auto is_outside = [](const Answer& answer) { return answer.position[kJoint].value > 6420; };
  board.needs_emulation();
  board.spoil();
  if (!board.ask_until(jog(kJoint, 7000), is_outside, 5s)) {
    board.fail("j5 to go beyond 6420 steps", "it does not");
  }
  const auto answer = board.act(idle());
  const auto is_inside = [](const Answer& back) { return back.position[kJoint].value < 6300; };
  (void)board.ask_until(jog(kJoint, -7000), is_inside, 5s);
  board.act(idle());
  return answer;
}

/// Of an idle frame, of both signs and all lengths.
constexpr Speeds kIdleSpeeds{1, -1, 255, -256, 40'000, -49'999};
/// By then the end of homing has been taken note of (parol6.home.idle-after).
constexpr Duration kDropped = 100ms;

constexpr GripperSetPoint kElsewhere{.speed = 77, .id = 5};

/// The board took each frame between when it was handed over and when its answer had come.
void expect_interval(BoardBench& board, const Answer& before, const Answer& after) {
  const auto least = ticks_in(after.asked - before.received) * (1 - kClockError) - 1;
  const auto most = ticks_in(after.received - before.asked) * (1 + kClockError) + 1;
  const auto above_least = static_cast<std::uint16_t>(after.timing - static_cast<int>(least));
  board.expect_in_time({static_cast<double>(above_least), 0, most - least + 1, "ticks"},
                       fmt::format("timing of {:.0f} to {:.0f} ticks, modulo 65536", least, most),
                       fmt::format("{} ticks", after.timing));
}

void expect_interval_after(BoardBench& board, Duration gap) {
  const auto before = board.ask(idle());
  board.pause(gap);
  expect_interval(board, before, board.ask(idle()));
}

/// Slow enough that hardly a step is made.
Answer reported(BoardBench& board, const Speeds& speeds) {
  board.act(jog(speeds));
  const auto answer = board.ask(jog(speeds));
  board.act(idle());
  return answer;
}

/// While homing is under way speeds in idle frames are ignored (parol6.home.idle-speeds-ignored).
void expect_speeds_behind(BoardBench& board, const CommandFrame& end) {
  board.act(end);
  const auto frame = with_speeds(255, kIdleSpeeds);
  board.act(frame);
  board.about(fmt::format("home, then code {}, then idle", static_cast<int>(end.command)));
  expect_reported(board, board.ask(frame), kIdleSpeeds);
  board.act(idle());
  board.act(with_code(kEnable));
}

/// A disabled board does not take it (parol6.command.disabled-home), and homes no arm later.
void expect_speeds_behind_refused_home(BoardBench& board) {
  board.act(with_code(kDisable));
  board.act(with_code(Command::kHome));
  expect_speeds_behind(board, idle());
}

void expect_speeds_behind_each_end(BoardBench& board) {
  constexpr Duration kUnderWay = 50ms;
  for (const auto& end :
       {with_code(kEnable), with_code(kDisable), with_code(kClearError), jog({})}) {
    begin_homing(board, kUnderWay);
    expect_speeds_behind(board, end);
  }
  begin_homing(board, kUnderWay);
  expect_speeds_behind(board, go_to(rest_in_homing(board).position));
}

constexpr Clause kTelemetryClauses[] = {
    must("parol6.telemetry.layout",
         "Telemetry is 60 bytes that begin with FF FF FF 38 and end with 01 02.",
         "document, packet table; firmware"),
    look("An answer is 60 bytes with start and end where they belong.",
         [](BoardBench& board) { board.expect_whole(); }),
    variant("always", look("Twenty answers are all whole.",
                           [](BoardBench& board) {
                             for (int i = 0; i < 20 && !board.is_over(); ++i) board.expect_whole();
                           })),

    must("parol6.telemetry.check", "The check byte of telemetry is 212.",
         "document, check byte; firmware"),
    look("The check byte is D4.",
         [](BoardBench& board) { board.expect(board.ask(idle()), "check", kCheckBoard); }),

    must("parol6.telemetry.spare-homed", "The two spare bits of homed are ones.", "firmware"),
    look("homed ends with 11.",
         [](BoardBench& board) { board.expect_bits(board.ask(idle()), "homed", 0x03, 0x03); }),

    must("parol6.telemetry.spare-io", "The three spare bits of io are ones.", "firmware"),
    look("io ends with 111.",
         [](BoardBench& board) { board.expect_bits(board.ask(idle()), "io", 0x07, 0x07); }),

    must("parol6.telemetry.spare-errors",
         "The two spare bits of temperature_error and of position_error are ones.", "firmware"),
    look("Both error bytes end with 11.",
         [](BoardBench& board) {
           const auto answer = board.ask(idle());
           board.expect_bits(answer, "temperature_error", 0x03, 0x03);
           board.expect_bits(answer, "position_error", 0x03, 0x03);
         }),

    must("parol6.telemetry.temperature-error", "No joint ever reports a temperature error.",
         "firmware: nothing measures it"),
    look("All temperature errors are 0.",
         [](BoardBench& board) {
           board.expect_bits(board.ask(idle()), "temperature_error", 0xFC, 0);
         }),
    variant("homed", from(kHomed, Hazard::kState, "Nor do those of a homed board.",
                          [](BoardBench& board) {
                            board.expect_bits(board.ask(idle()), "temperature_error", 0xFC, 0);
                          })),

    must("parol6.telemetry.no-position-error", "No joint ever reports a position error.",
         "firmware: never set", Profiles::kFirmware, "parol6.telemetry.position-error"),
    variant("idle", look("All position errors of an idle board are 0.",
                         [](BoardBench& board) {
                           board.expect_bits(board.ask(idle()), "position_error", 0xFC, 0);
                         })),
    variant("homed", from(kHomed, Hazard::kState, "All position errors of a homed one are 0.",
                          [](BoardBench& board) {
                            board.expect_bits(board.ask(idle()), "position_error", 0xFC, 0);
                          })),
    variant("outside", from(kHomed, Hazard::kMove, "J5 beyond its range is no error.",
                            [](BoardBench& board) {
                              board.expect_bits(beyond_range(board), "position_error", 0xFC, 0);
                            })),

    must("parol6.telemetry.position-error",
         "The position error of a joint is set once it leaves the range of the GUI table while all "
         "joints are homed, and stays until clear error.",
         "document, packet table, made precise", Profiles::kDocumented,
         "parol6.telemetry.no-position-error"),
    from(kHomed, Hazard::kMove, "J5 beyond its range is an error until clear error.",
         [](BoardBench& board) {
           board.expect_bits(beyond_range(board), "position_error", 0xFC, flag(4));
           board.about("back in range, before clear error");
           board.expect_bits(board.ask(idle()), "position_error", 0xFC, flag(4));
           board.act(with_code(kClearError));
           board.about("after clear error");
           board.expect_bits(board.ask(idle()), "position_error", 0xFC, 0);
         }),

    must("parol6.telemetry.timeout-error", "The timeout error is always 100.", "firmware",
         Profiles::kFirmware, "parol6.command.timeout-reported"),
    look("The timeout error is 100.",
         [](BoardBench& board) { board.expect(board.ask(idle()), "timeout_error", 100); }),
    variant("asked-for", look("It is 100 with a timeout, kept or not.",
                              [](BoardBench& board) {
                                for (const int timeout : {1, 20, 100, 255}) {
                                  auto frame = idle();
                                  frame.timeout = static_cast<std::uint8_t>(timeout);
                                  board.about(fmt::format("a timeout of {} ms", timeout));
                                  board.expect(board.ask(frame), "timeout_error", 100);
                                  board.pause(300ms);
                                  board.expect(board.ask(frame), "timeout_error", 100);
                                }
                              })),

    must("parol6.telemetry.gripper-id", "The gripper id of telemetry is always 0.", "firmware",
         Profiles::kFirmware, "parol6.telemetry.gripper-id-echoed"),
    variant("idle",
            look("The gripper id is 0 while nothing is commanded.",
                 [](BoardBench& board) { board.expect(board.ask(idle()), "gripper.id", 0); })),
    variant("commanded",
            from(kListening, Hazard::kGrip, "The gripper id is 0 after a set-point for node 5.",
                 [](BoardBench& board) {
                   board.act(with_gripper(kElsewhere));
                   board.expect(board.ask(with_gripper(kElsewhere)), "gripper.id", 0);
                 })),

    must("parol6.telemetry.gripper-id-echoed", "Telemetry shows the gripper id that was commanded.",
         "document, packet table", Profiles::kDocumented, "parol6.telemetry.gripper-id"),
    from(kListening, Hazard::kGrip, "The gripper id is 5 after a set-point for node 5.",
         [](BoardBench& board) {
           board.act(with_gripper(kElsewhere));
           board.expect(board.ask(with_gripper(kElsewhere)), "gripper.id", 5);
         }),

    must("parol6.telemetry.gripper-speed", "The gripper speed of telemetry is always 1.",
         "firmware", Profiles::kFirmware, "parol6.telemetry.gripper-speed-echoed"),
    variant("idle",
            look("The gripper speed is 1 while nothing is commanded.",
                 [](BoardBench& board) { board.expect(board.ask(idle()), "gripper.speed", 1); })),
    variant("commanded", from(kListening, Hazard::kGrip,
                              "The gripper speed is 1 after a set-point with speed 77.",
                              [](BoardBench& board) {
                                board.act(with_gripper(kElsewhere));
                                board.expect(board.ask(with_gripper(kElsewhere)), "gripper.speed",
                                             1);
                              })),

    must("parol6.telemetry.gripper-speed-echoed",
         "Telemetry shows the gripper speed that was commanded.", "document, packet table",
         Profiles::kDocumented, "parol6.telemetry.gripper-speed"),
    from(kListening, Hazard::kGrip, "The gripper speed is 77 after a set-point with speed 77.",
         [](BoardBench& board) {
           board.act(with_gripper(kElsewhere));
           board.expect(board.ask(with_gripper(kElsewhere)), "gripper.speed", 77);
         }),

    must("parol6.telemetry.gripper-object", "The object byte of telemetry is always 1.", "firmware",
         Profiles::kFirmware, "parol6.telemetry.gripper-object-decoded"),
    look("The object byte is 1.",
         [](BoardBench& board) { board.expect(board.ask(idle()), "gripper.object", 1); }),

    must("parol6.telemetry.gripper-object-decoded",
         "The object byte of telemetry is the object code of the gripper's status, low bit first.",
         "document, packet table; gripper", Profiles::kDocumented,
         "parol6.telemetry.gripper-object"),
    look("The object byte agrees with the status.",
         [](BoardBench& board) {
           board.act(idle());
           const auto answer = board.ask(idle());
           const unsigned low = answer.gripper.status & gripper_status::kObjectLow ? 1 : 0;
           const unsigned high = answer.gripper.status & gripper_status::kObjectHigh ? 2 : 0;
           board.expect(answer, "gripper.object", low + high);
         }),

    must("parol6.telemetry.echo",
         "Telemetry repeats the command byte of the frame that it answers.", "firmware"),
    look("Codes without effect are echoed.",
         [](BoardBench& board) {
           for (const auto code : kHarmlessCodes)
             board.expect(board.ask(with_code(code)), "echo", code);
         }),
    variant("all", from(kHomed, Hazard::kHome,
                        "A disabled board echoes all codes but 69, which it would obey.",
                        [](BoardBench& board) {
                          auto frame = with_code(kDisable);
                          frame.position = board.act(frame).position;
                          for (int code = 0; code < 256; ++code) {
                            const bool enables = code == 101;
                            const bool ignores_disable = code == 69;
                            if (enables || ignores_disable) continue;
                            frame.command = Command{static_cast<std::uint8_t>(code)};
                            board.expect(board.ask(frame), "echo", code);
                          }
                          board.expect(board.act(with_code(kEnable)), "echo", 101);
                          board.act(idle());
                        })),

    must("parol6.telemetry.timing",
         "The timing field counts 703,125 Hz ticks since the frame before.",
         "document, timing; arithmetic: 90 MHz / 128"),
    look("The timing field measures gaps up to 85 ms.",
         [](BoardBench& board) {
           for (const auto gap : {1ms, 5ms, 10ms, 20ms, 60ms, 85ms})
             expect_interval_after(board, gap);
         }),
    variant("burst", look("Frames of a burst are hardly any time apart.",
                          [](BoardBench& board) {
                            auto before = board.ask(idle());
                            board.pause(10ms);
                            const auto asked = board.now();
                            for (auto answer : board.ask_together({idle(), idle(), idle()})) {
                              answer.asked = asked;
                              expect_interval(board, before, answer);
                              before = answer;
                            }
                          })),
    /// Intervals are whole passes, and a pass may be a whole number of ticks.
    variant("single-ticks",
            look("Forty intervals have no common divisor that is shorter than a pass.",
                 [](BoardBench& board) {
                   constexpr int kTwentyMicroseconds = 14;
                   int divisor = 0;
                   for (int i = 0; i < 40; ++i) {
                     board.pause(1000us + i * 37us);
                     divisor = std::gcd(divisor, int{board.ask(idle()).timing});
                   }
                   board.expect_true(divisor == 1 || divisor >= kTwentyMicroseconds,
                                     "intervals that are counted in single ticks",
                                     fmt::format("all are multiples of {} ticks", divisor));
                 })),

    variant("any-code", from(kEnabled, Hazard::kState, "Frames of any code begin an interval.",
                             [](BoardBench& board) {
                               auto before = board.ask(idle());
                               for (const int code : {42, 101, 102, 103, 101, 123, 156, 255}) {
                                 board.pause(7ms);
                                 auto frame = with_code(code);
                                 frame.position = before.position;
                                 const auto answer = board.ask(frame);
                                 board.about(fmt::format("a frame of code {}", code));
                                 expect_interval(board, before, answer);
                                 before = answer;
                               }
                             })),

    /// Which is any number, as power-up and the first frame are any time apart.
    variant("first", from(kFresh, Hazard::kObserve, "The first interval is not 0.",
                          [](BoardBench& board) {
                            const double ticks = board.ask(idle()).timing;
                            board.expect_in_time({ticks, 1, 65'535, "ticks"}, "timing above 0",
                                                 fmt::format("{} ticks", ticks));
                          })),

    must("parol6.telemetry.timing-wraps",
         "The timing field counts modulo 65536: a gap of 100 ms reads 4776 or 4777.",
         "document, 16-bit timer; arithmetic"),
    look("Gaps of 100 ms to 1 s are measured modulo 65536.",
         [](BoardBench& board) {
           for (const auto gap : {100ms, 180ms, 190ms, 1000ms}) expect_interval_after(board, gap);
         }),

    must("parol6.telemetry.timing-dropped",
         "A frame that was dropped is no frame before: timing counts from the last one answered.",
         "firmware: the reference is taken when a frame is accepted"),
    look("A dropped frame does not begin a new interval.",
         [](BoardBench& board) {
           const auto before = board.ask(idle());
           board.pause(10ms);
           auto dropped = encode(idle());
           dropped.back() = std::byte{3};
           board.send(dropped);
           board.pause(10ms);
           board.about("with a dropped frame in the middle");
           expect_interval(board, before, board.ask(idle()));
         }),

    must("parol6.telemetry.old-motion",
         "An answer shows positions, speeds and homed bits from before its own frame was acted on.",
         "firmware: it is sent in the pass that reads the frame, which acts one pass later"),
    from(kEnabled, Hazard::kMove, "The first answer to a jog shows rest, the second one its speed.",
         [](BoardBench& board) {
           const auto before = board.ask(idle());
           const auto first = board.act(jog(4, 500));
           board.about("the answer to the first frame of a jog");
           board.expect(first, "speed.j5", 0);
           board.expect_same(first, "position.j5", before);
           board.about("the answer to the second frame of a jog");
           board.expect(board.ask(jog(4, 500)), "speed.j5", 500);
           board.act(idle());
         }),

    must("parol6.telemetry.speed-own-joint",
         "The speed field of each joint shows that joint's speed and no other's.",
         "document, packet table; firmware"),
    from(kEnabled, Hazard::kMove, "A jog of one joint shows in one speed field.",
         [](BoardBench& board) {
           for (std::size_t j = 0; j < kJointCount; ++j) {
             Speeds speeds{};
             speeds[j] = 3;
             board.about(fmt::format("a jog of j{}", j + 1));
             expect_reported(board, reported(board, speeds), speeds);
           }
         }),

    must("parol6.telemetry.speed-signed",
         "Speeds in telemetry are signed: backward is negative, in two's complement.", "firmware"),
    from(kEnabled, Hazard::kMove, "Six slow jogs backward show as -1 to -6.",
         [](BoardBench& board) {
           constexpr Speeds kSpeeds{-1, -2, -3, -4, -5, -6};
           expect_reported(board, reported(board, kSpeeds), kSpeeds);
         }),

    must("parol6.telemetry.speed-big-endian",
         "Speeds in telemetry have 24 bits, most significant byte first.", "firmware"),
    from(kEnabled, Hazard::kMove, "Speeds whose bytes differ come back as they were.",
         [](BoardBench& board) {
           constexpr Speeds kSpeeds{258, -259, 513, -514, 1027, 1290};
           expect_reported(board, reported(board, kSpeeds), kSpeeds);
         }),

    must("parol6.telemetry.position-own-joint",
         "The position field of each joint shows that joint's counter and no other's.",
         "document, packet table; firmware"),
    from(kEnabled, Hazard::kMove, "A jog of one joint shows in one position field.",
         [](BoardBench& board) {
           for (std::size_t j = 0; j < kJointCount; ++j) {
             const auto stretch = run(board, jog(j, 900), 50ms);
             board.act(idle());
             for (std::size_t other = 0; other < kJointCount; ++other) {
               board.about(fmt::format("a jog of j{}", j + 1));
               if (other != j)
                 board.expect_same(stretch.after, position_field(other), stretch.before);
             }
             board.expect_true(steps(stretch, j) > 0, fmt::format("j{} to count up", j + 1),
                               "it does not");
           }
         }),

    must("parol6.telemetry.position-signed",
         "Positions in telemetry are signed: a joint driven backward from 0 counts -1, -2, ...",
         "firmware"),
    from(kHomed, Hazard::kMove, "J4 and J5 below 0 have small negative positions.",
         [](BoardBench& board) {
           for (const std::size_t j : {3U, 4U}) {
             const auto stretch = run(board, jog(j, -500), 100ms);
             board.act(idle());
             board.about(fmt::format("j{} backward from 0", j + 1));
             board.expect_between(stretch.after, position_field(j), -500, -20);
           }
         }),

    must("parol6.telemetry.position-big-endian",
         "Positions in telemetry have 24 bits, most significant byte first.",
         "firmware: a homed arm stands at 10240, -32000, 57905, 0, 0, 32000"),
    from(kHomed, Hazard::kObserve, "The six standby positions stand where they belong.",
         [](BoardBench& board) {
           const auto answer = board.ask(idle());
           for (std::size_t j = 0; j < kJointCount; ++j) {
             board.expect(answer, position_field(j), kStandby[j].value);
           }
         }),

    must("parol6.telemetry.idle-speed",
         "An idle frame sets the speeds that telemetry reports from the next frame on.",
         "firmware: idle loads the set speeds", Profiles::kFirmware,
         "parol6.telemetry.idle-reports-zero"),
    look("Speeds of idle frames come back, joint by joint.",
         [](BoardBench& board) {
           for (std::size_t turn = 0; turn < kJointCount; ++turn) {
             Speeds speeds{};
             for (std::size_t j = 0; j < kJointCount; ++j)
               speeds[j] = kIdleSpeeds[(j + turn) % kJointCount];
             board.act(with_speeds(255, speeds));
             expect_reported(board, board.ask(with_speeds(255, speeds)), speeds);
           }
           board.act(idle());
         }),
    variant("after-homing", full(from(kEnabled, Hazard::kHome, "They come back after homing, too.",
                                      [](BoardBench& board) {
                                        home_by_idling(board);
                                        const auto frame = with_speeds(255, kIdleSpeeds);
                                        board.keep_asking(frame, kDropped);
                                        expect_reported(board, board.ask(frame), kIdleSpeeds);
                                        board.act(idle());
                                      }))),
    variant("after-ended-homing",
            from(kEnabled, Hazard::kHome,
                 "They come back after enable, disable, clear error, a jog or a go-to in homing.",
                 on<expect_speeds_behind_each_end>)),
    variant("after-refused-home",
            from(kEnabled, Hazard::kHome, "They come back after a home command while disabled.",
                 on<expect_speeds_behind_refused_home>)),

    must("parol6.telemetry.idle-reports-zero",
         "While the board idles telemetry reports speed 0, whatever speeds the frame has.",
         "document: idle frames carry no data", Profiles::kDocumented,
         "parol6.telemetry.idle-speed"),
    look("Speeds of idle frames do not come back.",
         [](BoardBench& board) {
           board.act(with_speeds(255, kIdleSpeeds));
           expect_reported(board, board.ask(idle()), {});
         }),

    must("parol6.telemetry.idle-speed-clamped",
         "A speed in an idle frame that exceeds 50,000 either way is reported as 50,000 that way.",
         "firmware, vector B6", Profiles::kFirmware),
    look("Speeds beyond 50,000 come back as 50,000.",
         [](BoardBench& board) {
           board.act(with_speeds(255, {50'000, -50'000, 50'001, -50'001, 8'388'607, -8'388'608}));
           expect_reported(board, board.ask(idle()),
                           {50'000, -50'000, 50'000, -50'000, 50'000, -50'000});
           board.act(idle());
         }),
};

}  // namespace

Chapter telemetry_chapter() { return chapter("Telemetry", kTelemetryClauses); }

}  // namespace armjig::parol6::conformance
