// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

void no_chatter(BoardBench& board) {
  board.pause(500ms);
  board.about("half a second without a frame");
  board.expect_silence();
}

/// Any bytes, but no length of 0, and no frame that would be accepted.
std::vector<std::byte> garbage(BoardBench& board, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (auto& byte : bytes) {
    byte = board.random() % 4 == 0 ? kStartByte : static_cast<std::byte>(3 + board.random() % 250);
  }
  return bytes;
}

CommandBytes with_check(BoardBench& board, int check, CommandFrame frame = idle()) {
  frame.check = static_cast<std::uint8_t>(check);
  board.about(fmt::format("a frame with check byte {:02X}", check));
  return encode(frame);
}

constexpr Clause kFrameClauses[] = {
    must("parol6.frame.one-answer",
         "Every good frame is answered with exactly one telemetry frame.",
         "firmware: one answer for each accepted frame"),
    look("Ten frames get ten answers.",
         [](BoardBench& board) {
           for (int i = 0; i < 10; ++i) board.ask(idle());
           board.about("after ten frames and their answers");
           board.expect_silence();
         }),

    must("parol6.frame.no-chatter",
         "The board sends nothing that was not asked for, also not at power-up.",
         "firmware: it only ever answers"),
    look("Half a second of silence stays so.", on<no_chatter>),
    variant("power-up", from(kFresh, Hazard::kState, "A board that is switched on says nothing.",
                             on<no_chatter>)),

    must("parol6.frame.split-anywhere",
         "A frame may arrive in pieces, cut at any byte, with any pauses between them.",
         "arithmetic: a byte stream has no borders; the GUI writes a frame in 26 pieces"),
    variant("two", look("A frame in two pieces, cut at each byte in turn, is answered.",
                        [](BoardBench& board) {
                          const auto frame = encode(idle());
                          for (std::size_t split = 1; split < frame.size(); ++split) {
                            board.about(fmt::format("a frame cut after byte {}", split));
                            board.send(std::span{frame}.first(split));
                            board.pause(2ms);
                            board.expect_answer(std::span{frame}.subspan(split));
                          }
                        })),
    variant("bytes", look("A frame that comes byte by byte is answered.",
                          [](BoardBench& board) {
                            for (const auto byte : encode(idle())) {
                              board.send(std::span{&byte, 1});
                              board.pause(1ms);
                            }
                            board.about("a frame that came byte by byte");
                            board.expect_answer();
                          })),
    variant("pause", look("A frame with a second in its middle is answered.",
                          [](BoardBench& board) {
                            const auto frame = encode(idle());
                            board.send(std::span{frame}.first(20));
                            board.pause(1s);
                            board.send(std::span{frame}.subspan(20));
                            board.about("a frame with a second between its two pieces");
                            board.expect_answer();
                          })),

    variant("behind-another", look("A frame is answered whose beginning, cut at each byte in turn, "
                                   "came together with the one before.",
                                   [](BoardBench& board) {
                                     const auto frame = encode(idle());
                                     for (std::size_t split = 1; split < frame.size(); ++split) {
                                       std::vector<std::byte> more{frame.begin(), frame.end()};
                                       const auto beginning = std::span{frame}.first(split);
                                       more.insert(more.end(), beginning.begin(), beginning.end());
                                       board.about(
                                           fmt::format("a frame and {} bytes of another", split));
                                       board.expect_answer(more);
                                       board.pause(2ms);
                                       board.expect_answer(std::span{frame}.subspan(split));
                                     }
                                   })),

    must("parol6.frame.burst", "Frames that arrive together are all answered, in order.",
         "firmware: all waiting bytes are read in one pass"),
    look("Three frames in one write get three answers.",
         [](BoardBench& board) {
           constexpr std::array kCodes{1, 42, 255};
           const auto answers = board.ask_together({with_code(1), with_code(42), with_code(kIdle)});
           for (std::size_t i = 0; i < kCodes.size(); ++i)
             board.expect(answers[i], "echo", kCodes[i]);
           board.expect_silence();
         }),
    variant("thirty", look("Thirty frames in one write get thirty answers.",
                           [](BoardBench& board) {
                             std::vector<CommandFrame> frames;
                             for (int i = 0; i < 30; ++i) frames.push_back(with_code(i));
                             const auto answers = board.ask_together(frames);
                             for (int i = 0; i < 30; ++i)
                               board.expect(answers[static_cast<std::size_t>(i)], "echo", i);
                           })),

    must("parol6.frame.rate",
         "A frame every 10 ms is answered before the next one comes, for as long as it lasts.",
         "document: 100 Hz; firmware"),
    look("Three seconds at 100 Hz.",
         [](BoardBench& board) {
           const auto begin = board.now();
           for (int i = 1; i <= 300; ++i) {
             board.ask(idle());
             board.pause(begin + i * kFramePeriod - board.now());
           }
           board.about("after 300 frames and their answers");
           board.expect_silence();
         }),

    should("parol6.frame.rate-beyond",
           "A frame every millisecond is answered as well as one every 10 ms.",
           "firmware: frames are answered in the pass that reads them"),
    look("Half a second at 1000 Hz, every frame answered in its turn.",
         [](BoardBench& board) {
           constexpr int kFrames = 500;
           for (int i = 0; i < kFrames; ++i) {
             board.send(encode(with_code(i % 2 == 0 ? 255 : 42)));
             board.pause(1ms);
           }
           for (int i = 0; i < kFrames; ++i) {
             board.about(fmt::format("frame {} of {}, one each millisecond", i + 1, kFrames));
             board.expect(board.expect_answer(), "echo", i % 2 == 0 ? 255 : 42);
           }
         }),

    must("parol6.frame.start-inside", "Start bytes inside a payload do not begin another frame.",
         "arithmetic: nothing is escaped, so the position -1 is FF FF FF"),
    look("A frame full of FF is one frame.",
         [](BoardBench& board) {
           auto frame = idle();
           for (auto& position : frame.position) position = Steps{-1};
           frame.position[3] = Steps{0x34FFFF - 0x1000000};
           board.about("a frame with positions of FF FF FF");
           const auto answer = board.ask(frame);
           board.expect(answer, "echo", 255);
           board.expect_silence();
           board.about("the frame after it");
           board.ask(idle());
         }),

    must("parol6.frame.noise", "Bytes without a start pattern in front of a frame do no harm.",
         "firmware: the receiver looks for FF FF FF"),
    look("Noise in front of a good frame is passed over.",
         [](BoardBench& board) {
           for (std::size_t size = 1; size <= 64; size *= 2) {
             std::vector<std::byte> bytes(size);
             std::ranges::generate(bytes,
                                   [&] { return static_cast<std::byte>(board.random() % 0xFF); });
             const auto frame = encode(idle());
             bytes.insert(bytes.end(), frame.begin(), frame.end());
             board.about(fmt::format("a good frame after {} bytes of noise", size));
             board.expect_answer(bytes);
           }
         }),

    must("parol6.frame.two-starts",
         "Two start bytes begin no frame: one that lost its first byte is not answered, the next "
         "is.",
         "document, start bytes; firmware, vector R10"),
    look("A frame without its first byte is lost alone.",
         [](BoardBench& board) {
           const auto frame = encode(idle());
           board.about("a frame without its first byte");
           board.expect_silence(std::span{frame}.subspan(1));
           board.about("the frame after it");
           board.expect_answer(frame);
         }),

    must("parol6.frame.interrupted-start",
         "Start bytes count only in a row; another byte between them begins the count anew.",
         "firmware, vector R8"),
    look("Start bytes with others between them harm no frame.",
         [](BoardBench& board) {
           for (const auto* hex :
                {"FF 07", "FF FF 09", "FF 07 FF FF 09", "01 02 03 00 FF 07 FF FF 09"}) {
             auto bytes = *from_hex(hex);
             const auto frame = encode(idle());
             bytes.insert(bytes.end(), frame.begin(), frame.end());
             board.about(fmt::format("a good frame after {}", hex));
             board.expect_answer(bytes);
           }
         }),

    must("parol6.frame.wrong-end",
         "A frame that does not end with 01 02 is not answered, and the next good one is.",
         "document, end bytes; firmware, vector R2"),
    look("Wrong end bytes cost one frame, not two.",
         [](BoardBench& board) {
           constexpr std::array<std::pair<int, int>, 6> kWrongEnds{
               {{1, 3}, {2, 2}, {0, 0}, {2, 1}, {1, 255}, {255, 255}}};
           for (const auto& [first, second] : kWrongEnds) {
             auto frame = encode(idle());
             frame[kCommandFrameSize - 2] = static_cast<std::byte>(first);
             frame[kCommandFrameSize - 1] = static_cast<std::byte>(second);
             board.about(fmt::format("a frame that ends with {:02X} {:02X}", first, second));
             board.expect_silence(frame);
             board.about(fmt::format("the good frame after one that ends with {:02X} {:02X}", first,
                                     second));
             board.expect_answer(encode(idle()));
           }
         }),

    must("parol6.frame.recovers",
         "After any garbage but a length of 0 the board answers again within six good frames.",
         "arithmetic: a length claims at most 255 bytes"),
    look("Start bytes and cut frames do not deafen the board.",
         [](BoardBench& board) {
           // Each kind of garbage that can make a receiver wait: a stray start byte, a length that
           // claims the most, a frame cut short. Length 0 is left out: the shipped board may stay
           // deaf for long.
           const auto good = encode(idle());
           const std::array<std::vector<std::byte>, 4> garbage{
               std::vector(1, kStartByte), std::vector(4, kStartByte), std::vector(300, kStartByte),
               std::vector(good.begin(), good.begin() + 30)};
           for (const auto& bytes : garbage) {
             board.about(fmt::format(
                 "after {}{}",
                 to_hex_dump(std::span{bytes}.first(std::min<std::size_t>(bytes.size(), 8))),
                 bytes.size() > 8 ? " ..." : ""));
             board.send(bytes);
             board.expect_recovery(6);
           }
         }),

    must("parol6.frame.long-noise",
         "Kilobytes of noise without start bytes leave the receiver ready for the next frame.",
         "firmware: such bytes are dropped one by one"),
    look("8192 bytes of noise are passed over.",
         [](BoardBench& board) {
           std::vector<std::byte> bytes(8192);
           std::ranges::generate(bytes,
                                 [&] { return static_cast<std::byte>(board.random() % 0xFF); });
           board.about("8192 bytes of noise without start bytes");
           board.expect_silence(bytes);
           board.about("the frame after 8192 bytes of noise");
           board.expect_answer(encode(idle()));
         }),

    must("parol6.frame.random-noise",
         "After random bytes, start bytes among them, the board answers within six good frames.",
         "arithmetic: a length claims at most 255 bytes"),
    look("Twenty times 600 random bytes are recovered from.",
         [](BoardBench& board) {
           for (int i = 0; i < 20; ++i) {
             board.about("after 600 random bytes");
             board.send(garbage(board, 600));
             board.expect_recovery(6);
           }
         }),

    must("parol6.frame.check-ignored", "The check byte of a frame is not looked at.",
         "firmware, vector R1", Profiles::kFirmware, "parol6.frame.check-demanded"),
    look("With each check byte a frame is answered, and its code taken.",
         [](BoardBench& board) {
           for (int check = 0; check < 256; ++check) {
             const int code = check % 2 == 0 ? 42 : 255;
             const auto frame = with_check(board, check, with_code(code));
             board.expect(board.expect_answer(frame), "echo", code);
           }
         }),

    must("parol6.frame.check-demanded",
         "A frame whose check byte is not 212 is dropped, and the next good one is answered.",
         "document, check byte", Profiles::kDocumented, "parol6.frame.check-ignored"),
    look("Frames with other check bytes are not answered.",
         [](BoardBench& board) {
           for (const int check : {0x00, 0xD3, 0xE4, 0x2B}) {
             board.expect_silence(with_check(board, check));
             board.about("the good frame after it");
             board.expect_answer(encode(idle()));
           }
         }),

    must("parol6.frame.prompt", "At 100 Hz most answers come before the next frame is due.",
         "firmware: a frame is answered in the pass that reads it"),
    look("Of 50 answers at 100 Hz more than half come within 10 ms.",
         [](BoardBench& board) {
           constexpr int kFrames = 50;
           int in_time = 0;
           for (int i = 0; i < kFrames; ++i) {
             const auto answer = board.ask(idle());
             if (answer.received - answer.asked < kFramePeriod) ++in_time;
             board.pause(std::max<Duration>(kFramePeriod - (board.now() - answer.asked), 0ms));
           }
           board.expect_in_time({static_cast<double>(in_time), 26, kFrames, "answers"},
                                "more than 25 of 50 answers within 10 ms",
                                fmt::format("{} were", in_time));
         }),
};

}  // namespace

Chapter frame_chapter() { return chapter("Frames", kFrameClauses); }

}  // namespace armjig::parol6::conformance
