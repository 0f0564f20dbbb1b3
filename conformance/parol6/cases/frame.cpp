// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "conformance/parol6/board_bench.hpp"
#include "conformance/parol6/chapters.hpp"
#include "harness/core/hex.hpp"

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;

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
    board.send(std::span{frame}.subspan(split));
    board.expect_answer();
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
    board.send(bytes);
    board.expect_answer();
  }
}

void wrong_end(BoardBench& board) {
  constexpr std::array<std::pair<int, int>, 4> kWrongEnds{{{1, 3}, {2, 2}, {0, 0}, {2, 1}}};
  for (const auto& [first, second] : kWrongEnds) {
    auto frame = encode(idle());
    frame[kCommandFrameSize - 2] = static_cast<std::byte>(first);
    frame[kCommandFrameSize - 1] = static_cast<std::byte>(second);
    board.about(fmt::format("a frame that ends with {:02X} {:02X}", first, second));
    board.send(frame);
    board.expect_silence();
    board.about(
        fmt::format("the good frame behind one that ends with {:02X} {:02X}", first, second));
    board.send(encode(idle()));
    board.expect_answer();
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

void check_ignored(BoardBench& board) {
  for (const int check : {0x00, 0x01, 0xD4, 0xE4, 0xFF}) {
    auto frame = idle();
    frame.check = static_cast<std::uint8_t>(check);
    board.about(fmt::format("a frame with check byte {:02X}", check));
    board.send(encode(frame));
    board.expect_answer();
  }
}

constexpr std::array kCases{
    Case{.requirement = "parol6.frame.one-answer",
         .rule = "Ten frames get ten answers.",
         .run = on<one_answer>},
    Case{.requirement = "parol6.frame.no-chatter",
         .rule = "Half a second of silence stays so.",
         .run = on<no_chatter>},
    Case{.requirement = "parol6.frame.split-anywhere",
         .variant = "two",
         .rule = "A frame in two pieces, cut at each byte in turn, is answered.",
         .run = on<split_in_two>},
    Case{.requirement = "parol6.frame.split-anywhere",
         .variant = "bytes",
         .rule = "A frame that comes byte by byte is answered.",
         .run = on<split_bytewise>},
    Case{.requirement = "parol6.frame.burst",
         .rule = "Three frames in one write get three answers.",
         .run = on<burst>},
    Case{.requirement = "parol6.frame.noise",
         .rule = "Noise in front of a good frame is passed over.",
         .run = on<noise>},
    Case{.requirement = "parol6.frame.wrong-end",
         .rule = "Wrong end bytes cost one frame, not two.",
         .run = on<wrong_end>},
    Case{.requirement = "parol6.frame.recovers",
         .rule = "Start bytes and cut frames do not deafen the board.",
         .run = on<recovers>},
    Case{.requirement = "parol6.frame.check-ignored",
         .rule = "Five different check bytes are all answered.",
         .run = on<check_ignored>},
};

}  // namespace

std::span<const Case> frame_cases() noexcept { return kCases; }

}  // namespace armjig::parol6
