// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

void one_answer(BoardBench& board) {
  for (int i = 0; i < 10; ++i) board.ask(idle());
  board.about("after ten frames and their answers");
  board.expect_silence();
}

void no_chatter(BoardBench& board) {
  board.pause(500ms);
  board.about("half a second without a frame");
  board.expect_silence();
}

void split_in_two(BoardBench& board) {
  const auto frame = encode(idle());
  for (std::size_t split = 1; split < frame.size(); ++split) {
    board.about(fmt::format("a frame cut behind byte {}", split));
    board.send(std::span{frame}.first(split));
    board.pause(2ms);
    board.expect_answer(std::span{frame}.subspan(split));
  }
}

void split_bytewise(BoardBench& board) {
  for (const auto byte : encode(idle())) {
    board.send(std::span{&byte, 1});
    board.pause(1ms);
  }
  board.about("a frame that came byte by byte");
  board.expect_answer();
}

void burst(BoardBench& board) {
  constexpr std::array kCodes{1, 42, 255};
  const auto answers = board.ask_together({with_code(1), with_code(42), with_code(255)});
  for (std::size_t i = 0; i < kCodes.size(); ++i) board.expect(answers[i], "echo", kCodes[i]);
  board.expect_silence();
}

void noise(BoardBench& board) {
  for (std::size_t size = 1; size <= 64; size *= 2) {
    std::vector<std::byte> bytes(size);
    std::ranges::generate(bytes, [&] { return static_cast<std::byte>(board.random() % 0xFF); });
    const auto frame = encode(idle());
    bytes.insert(bytes.end(), frame.begin(), frame.end());
    board.about(fmt::format("a good frame behind {} bytes of noise", size));
    board.expect_answer(bytes);
  }
}

void wrong_end(BoardBench& board) {
  constexpr std::array<std::pair<int, int>, 4> kWrongEnds{{{1, 3}, {2, 2}, {0, 0}, {2, 1}}};
  for (const auto& [first, second] : kWrongEnds) {
    auto frame = encode(idle());
    frame[kCommandFrameSize - 2] = static_cast<std::byte>(first);
    frame[kCommandFrameSize - 1] = static_cast<std::byte>(second);
    board.about(fmt::format("a frame that ends with {:02X} {:02X}", first, second));
    board.expect_silence(frame);
    board.about(
        fmt::format("the good frame behind one that ends with {:02X} {:02X}", first, second));
    board.expect_answer(encode(idle()));
  }
}

void hundred_hertz(BoardBench& board) {
  const auto begin = board.now();
  for (int i = 1; i <= 300; ++i) {
    board.ask(idle());
    board.pause(begin + i * BoardBench::kFramePeriod - board.now());
  }
  board.about("after 300 frames and their answers");
  board.expect_silence();
}

void thousand_hertz(BoardBench& board) {
  constexpr int kFrames = 500;
  for (int i = 0; i < kFrames; ++i) {
    board.send(encode(with_code(i % 2 == 0 ? 255 : 42)));
    board.pause(1ms);
  }
  for (int i = 0; i < kFrames; ++i) {
    board.about(fmt::format("frame {} of {}, one each millisecond", i + 1, kFrames));
    board.expect(board.expect_answer(), "echo", i % 2 == 0 ? 255 : 42);
  }
}

void long_burst(BoardBench& board) {
  std::vector<CommandFrame> frames;
  for (int i = 0; i < 30; ++i) frames.push_back(with_code(i));
  const auto answers = board.ask_together(frames);
  for (int i = 0; i < 30; ++i) board.expect(answers[static_cast<std::size_t>(i)], "echo", i);
}

void pause_inside(BoardBench& board) {
  const auto frame = encode(idle());
  board.send(std::span{frame}.first(20));
  board.pause(1s);
  board.send(std::span{frame}.subspan(20));
  board.about("a frame with a second between its two pieces");
  board.expect_answer();
}

void start_inside(BoardBench& board) {
  auto frame = idle();
  for (auto& position : frame.position) position = Steps{-1};
  frame.position[3] = Steps{0x34FFFF - 0x1000000};
  board.about("a frame with positions of FF FF FF");
  const auto answer = board.ask(frame);
  board.expect(answer, "echo", 255);
  board.expect_silence();
  board.about("the frame behind it");
  board.ask(idle());
}

void two_starts(BoardBench& board) {
  const auto frame = encode(idle());
  board.about("a frame without its first byte");
  board.expect_silence(std::span{frame}.subspan(1));
  board.about("the frame behind it");
  board.expect_answer(frame);
}

void interrupted_start(BoardBench& board) {
  for (const auto* hex : {"FF 07", "FF FF 09", "FF 07 FF FF 09", "01 02 03 00 FF 07 FF FF 09"}) {
    auto bytes = *from_hex(hex);
    const auto frame = encode(idle());
    bytes.insert(bytes.end(), frame.begin(), frame.end());
    board.about(fmt::format("a good frame behind {}", hex));
    board.expect_answer(bytes);
  }
}

void long_noise(BoardBench& board) {
  std::vector<std::byte> bytes(8192);
  std::ranges::generate(bytes, [&] { return static_cast<std::byte>(board.random() % 0xFF); });
  board.about("8192 bytes of noise without start bytes");
  board.expect_silence(bytes);
  board.about("the frame behind 8192 bytes of noise");
  board.expect_answer(encode(idle()));
}

/// Any bytes, but no length of 0, and no frame that would be accepted.
std::vector<std::byte> garbage(BoardBench& board, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (auto& byte : bytes) {
    byte = board.random() % 4 == 0 ? kStartByte : static_cast<std::byte>(3 + board.random() % 250);
  }
  return bytes;
}

void random_noise(BoardBench& board) {
  for (int i = 0; i < 20; ++i) {
    board.about("after 600 random bytes");
    board.send(garbage(board, 600));
    board.expect_recovery(6);
  }
}

void recovers(BoardBench& board) {
  // Each kind of garbage that can make a receiver wait: a stray start byte, a length that claims
  // the most, a frame cut short. Length 0 is left out: the shipped board may stay deaf for long.
  const auto good = encode(idle());
  const std::array<std::vector<std::byte>, 4> garbage{
      std::vector(1, kStartByte), std::vector(4, kStartByte), std::vector(300, kStartByte),
      std::vector(good.begin(), good.begin() + 30)};
  for (const auto& bytes : garbage) {
    board.about(fmt::format(
        "after {}{}", to_hex_dump(std::span{bytes}.first(std::min<std::size_t>(bytes.size(), 8))),
        bytes.size() > 8 ? " ..." : ""));
    board.send(bytes);
    board.expect_recovery(6);
  }
}

CommandBytes with_check(BoardBench& board, int check) {
  auto frame = idle();
  frame.check = static_cast<std::uint8_t>(check);
  board.about(fmt::format("a frame with check byte {:02X}", check));
  return encode(frame);
}

void check_demanded(BoardBench& board) {
  for (const int check : {0x00, 0xD3, 0xE4, 0x2B}) {
    board.expect_silence(with_check(board, check));
    board.about("the good frame behind it");
    board.expect_answer(encode(idle()));
  }
}

void check_ignored(BoardBench& board) {
  for (const int check : {0x00, 0x01, 0xD4, 0xE4, 0xFF}) {
    board.expect_answer(with_check(board, check));
  }
}

constexpr Case kCases[] = {
    {.requirement = "parol6.frame.one-answer",
     .rule = "Ten frames get ten answers.",
     .run = on<one_answer>},
    {.requirement = "parol6.frame.no-chatter",
     .rule = "Half a second of silence stays so.",
     .run = on<no_chatter>},
    from(kFresh, Hazard::kState, "parol6.frame.no-chatter",
         "A board that is switched on says nothing.", on<no_chatter>, "power-up"),
    {.requirement = "parol6.frame.split-anywhere",
     .variant = "two",
     .rule = "A frame in two pieces, cut at each byte in turn, is answered.",
     .run = on<split_in_two>},
    {.requirement = "parol6.frame.split-anywhere",
     .variant = "bytes",
     .rule = "A frame that comes byte by byte is answered.",
     .run = on<split_bytewise>},
    {.requirement = "parol6.frame.split-anywhere",
     .variant = "pause",
     .rule = "A frame with a second in its middle is answered.",
     .run = on<pause_inside>},
    {.requirement = "parol6.frame.burst",
     .rule = "Three frames in one write get three answers.",
     .run = on<burst>},
    {.requirement = "parol6.frame.burst",
     .variant = "thirty",
     .rule = "Thirty frames in one write get thirty answers.",
     .run = on<long_burst>},
    {.requirement = "parol6.frame.rate",
     .rule = "Three seconds at 100 Hz.",
     .run = on<hundred_hertz>},
    {.requirement = "parol6.frame.rate-beyond",
     .rule = "Half a second at 1000 Hz, every frame answered in its turn.",
     .run = on<thousand_hertz>},
    {.requirement = "parol6.frame.start-inside",
     .rule = "A frame full of FF is one frame.",
     .run = on<start_inside>},
    {.requirement = "parol6.frame.noise",
     .rule = "Noise in front of a good frame is passed over.",
     .run = on<noise>},
    {.requirement = "parol6.frame.two-starts",
     .rule = "A frame without its first byte is lost alone.",
     .run = on<two_starts>},
    {.requirement = "parol6.frame.interrupted-start",
     .rule = "Start bytes with others between them harm no frame.",
     .run = on<interrupted_start>},
    {.requirement = "parol6.frame.wrong-end",
     .rule = "Wrong end bytes cost one frame, not two.",
     .run = on<wrong_end>},
    {.requirement = "parol6.frame.recovers",
     .rule = "Start bytes and cut frames do not deafen the board.",
     .run = on<recovers>},
    {.requirement = "parol6.frame.long-noise",
     .rule = "8192 bytes of noise are passed over.",
     .run = on<long_noise>},
    {.requirement = "parol6.frame.random-noise",
     .rule = "Twenty times 600 random bytes are recovered from.",
     .run = on<random_noise>},
    {.requirement = "parol6.frame.check-ignored",
     .rule = "Five different check bytes are all answered.",
     .run = on<check_ignored>},
    {.requirement = "parol6.frame.check-demanded",
     .rule = "Frames with other check bytes are not answered.",
     .run = on<check_demanded>},
};

}  // namespace

std::span<const Case> frame_cases() noexcept { return kCases; }

}  // namespace armjig::parol6::conformance
