// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/cases.hpp"

namespace armjig::parol6::conformance {
namespace {

/// Lengths at which the end bytes fall into no field that does anything.
constexpr int kOtherLengths[] = {3, 12, 21, 36, 40, 51, 53, 60, 255};

/// A frame of any length: as much of `frame` as fits, filled up with 55, and the end bytes.
std::vector<std::byte> with_length(const CommandFrame& frame, int length) {
  const auto whole = encode(frame);
  std::vector<std::byte> bytes(kHeaderSize + static_cast<std::size_t>(length), std::byte{0x55});
  const auto brought = std::min<std::size_t>(bytes.size(), kHeaderSize + kCommandBodySize);
  std::copy_n(whole.begin(), brought, bytes.begin());
  bytes[kHeaderSize - 1] = static_cast<std::byte>(length);
  std::ranges::copy(kEndBytes, bytes.end() - kEndBytes.size());
  return bytes;
}

/// Length 24 brings the positions and the speeds of J1 and J2, the end bytes being part of J2's.
Answer half_of_the_speeds(BoardBench& board) {
  board.act(with_speeds(255, {11, 12, 13, 14, 15, 16}));
  board.about("idle with speeds 11 to 16, then length 24 with j1 = 99");
  board.expect_answer(with_length(with_speeds(255, {99, 0, 0, 0, 0, 0}), 24));
  board.pause(BoardBench::kPassTime);
  return board.ask(with_code(42));
}

constexpr std::byte kLengthZero[] = {kStartByte, kStartByte, kStartByte, std::byte{0}};

constexpr std::size_t kCuts[] = {4, 30, 54};

/// The next frame is the first behind it.
void send_cut(BoardBench& board, std::size_t size) {
  board.send(Bytes{encode(idle())}.first(size));
  board.about(fmt::format("the first frame after one cut after {} bytes", size));
}

template <class Look>
void after_each_cut(BoardBench& board, Look look) {
  for (const auto size : kCuts) {
    send_cut(board, size);
    look(size);
  }
}

constexpr Clause kReceiveClauses[] = {
    must("parol6.receive.any-length",
         "Any byte after three start bytes is believed to be the length, FF included, and a frame "
         "of "
         "any length from 2 on is accepted if it ends with 01 02.",
         "firmware, vectors R4 to R7", Profiles::kFirmware, "parol6.receive.one-length"),
    look("Idle frames of nine lengths are answered.",
         [](BoardBench& board) {
           for (const auto length : kOtherLengths) {
             board.ask(idle());
             board.about(fmt::format("an idle frame of length {}", length));
             board.expect(board.expect_answer(with_length(idle(), length)), "echo", 255);
           }
           board.act(idle());
         }),

    must("parol6.receive.one-length", "A frame with another length than 52 is not answered.",
         "document, length byte", Profiles::kDocumented, "parol6.receive.any-length"),
    look("Idle frames of nine lengths are not answered.",
         [](BoardBench& board) {
           for (const auto length : kOtherLengths) {
             board.about(fmt::format("an idle frame of length {}", length));
             board.expect_silence(with_length(idle(), length));
             board.about(fmt::format("the frame after one of length {}", length));
             board.ask(idle());
           }
         }),

    must("parol6.receive.shortest",
         "The six bytes FF FF FF 02 01 02 are a complete poll, answered with the echo of the "
         "command "
         "before.",
         "firmware, vector R4", Profiles::kFirmware),
    look("Six bytes poll a board that does nothing.",
         [](BoardBench& board) {
           board.act(with_code(42));
           board.about("FF FF FF 02 01 02 after code 42");
           board.expect(board.expect_answer(with_length(idle(), 2)), "echo", 42);
           board.act(idle());
         }),

    must("parol6.receive.store-stays",
         "What a short frame does not bring is what earlier frames left in the store.", "firmware",
         Profiles::kFirmware),
    look("A frame of length 24 leaves four speeds as they were.",
         [](BoardBench& board) {
           const auto answer = half_of_the_speeds(board);
           board.expect(answer, "speed.j1", 99);
           for (int j = 2; j < 6; ++j) {
             board.expect(answer, speed_field(static_cast<std::size_t>(j)), 11 + j);
           }
           board.act(idle());
         }),

    must("parol6.receive.dropped-stays",
         "Also a frame that is dropped for its end bytes leaves its payload in the store.",
         "firmware", Profiles::kFirmware),
    look("The shortest frame uncovers the speeds of a dropped one.",
         [](BoardBench& board) {
           board.act(idle());
           auto dropped = encode(with_speeds(255, {21, 22, 23, 24, 25, 26}));
           dropped.back() = std::byte{3};
           board.about("a dropped idle frame with speeds 21 to 26, then FF FF FF 02 01 02");
           board.expect_silence(dropped);
           board.expect_answer(with_length(idle(), 2));
           board.pause(BoardBench::kPassTime);
           expect_reported(board, board.ask(with_code(42)), {21, 22, 23, 24, 25, 26});
           board.act(idle());
         }),

    must("parol6.receive.end-in-field",
         "The end bytes of a short frame stand in the store too, as part of whatever field is "
         "there.",
         "firmware, vector R5", Profiles::kFirmware),
    look("The end bytes of a frame of length 24 become the speed of J2.",
         [](BoardBench& board) {
           board.expect(half_of_the_speeds(board), "speed.j2", 0x0102);
           board.act(idle());
         }),

    must("parol6.receive.long-tail",
         "Of a frame longer than 52 the first 50 payload bytes count and the rest is passed over.",
         "firmware, vector R7", Profiles::kFirmware),
    look("A frame of length 60 sets the speeds of its first 50 bytes.",
         [](BoardBench& board) {
           board.about("an idle frame of length 60 with speeds 31 to 36");
           board.expect(
               board.expect_answer(with_length(with_speeds(255, {31, 32, 33, 34, 35, 36}), 60)),
               "echo", 255);
           board.pause(BoardBench::kPassTime);
           expect_reported(board, board.ask(with_code(42)), {31, 32, 33, 34, 35, 36});
           board.act(idle());
         }),

    must("parol6.receive.length-zero",
         "After a length of 0 the store is filled to its end, the 256th byte becomes the new "
         "length, "
         "and reception goes on at the beginning of the store.",
         "firmware as built by the vendor; undefined behaviour", Profiles::kFirmware,
         "parol6.receive.length-zero-harmless"),
    from(kFresh, Hazard::kState, "The 256th byte after a length of 0 is the next length.",
         [](BoardBench& board) {
           board.spoil_memory();
           board.send(kLengthZero);
           board.about("255 bytes after a length of 0");
           board.expect_silence(std::vector(255, std::byte{0x55}));
           board.about("the payload of a frame, as its 256th byte says 52");
           board.expect(board.expect_answer(Bytes{encode(with_code(42))}.subspan(kHeaderSize - 1)),
                        "echo", 42);
         }),

    should("parol6.receive.length-zero-harmless",
           "A length of 0 is no frame, and the good frame directly after it is answered.",
           "document is silent; our choice", Profiles::kDocumented, "parol6.receive.length-zero"),
    from(kFresh, Hazard::kState, "A length of 0 costs no good frame.",
         [](BoardBench& board) {
           board.spoil_memory();
           board.about("a good frame after FF FF FF 00");
           board.send(kLengthZero);
           board.expect_answer(encode(idle()));
         }),

    must("parol6.receive.length-one",
         "A frame of length 1 is never accepted, and the next good frame is answered.",
         "firmware as built by the vendor, vector R12; undefined behaviour", Profiles::kFirmware),
    look("A length of 1 gets no answer and costs no good frame.",
         [](BoardBench& board) {
           for (const auto byte : {std::byte{1}, std::byte{2}, std::byte{0x55}}) {
             board.about("FF FF FF 01 and a byte");
             board.expect_silence(
                 std::vector{kStartByte, kStartByte, kStartByte, std::byte{1}, byte});
             board.about("the frame after one of length 1");
             board.expect_answer(encode(idle()));
           }
         }),

    must("parol6.receive.stray-start",
         "One start byte directly in front of a good frame costs that frame and the next four.",
         "firmware: the third start byte becomes a length of 255; vector R3", Profiles::kFirmware,
         "parol6.receive.resync"),
    look("The sixth frame after a stray start byte is the first to be answered.",
         [](BoardBench& board) {
           board.send(std::vector{kStartByte});
           for (int i = 1; i <= 5; ++i) {
             board.about(fmt::format("frame {} after a stray FF", i));
             board.expect_silence(encode(idle()));
           }
           board.about("frame 6 after a stray FF");
           board.expect_answer(encode(idle()));
         }),

    should("parol6.receive.resync",
           "Of a run of start bytes the last three count, so that a stray one in front of a frame "
           "costs "
           "nothing.",
           "document is silent; our choice", Profiles::kDocumented, "parol6.receive.stray-start"),
    look("Runs of start bytes in front of a good frame cost nothing.",
         [](BoardBench& board) {
           for (const std::size_t size : {1U, 2U, 3U, 7U, 300U}) {
             board.about(fmt::format("a good frame after {} start bytes", size));
             board.send(std::vector(size, kStartByte));
             board.expect_answer(encode(idle()));
           }
         }),

    must("parol6.receive.cut-short",
         "A frame cut short is completed from the next one, which is lost with it; the one after "
         "that "
         "is answered.",
         "firmware, vector R9", Profiles::kFirmware, "parol6.receive.cut-harmless"),
    look("A frame cut short takes the next one with it, and no more.",
         [](BoardBench& board) {
           after_each_cut(board, [&](std::size_t size) {
             board.expect_silence(encode(idle()));
             for (const auto* which : {"second", "third"}) {
               board.about(fmt::format("the {} frame after one cut after {} bytes", which, size));
               board.expect_answer(encode(idle()));
             }
           });
         }),

    should("parol6.receive.cut-harmless", "A frame cut short does not take the next one with it.",
           "document is silent; our choice", Profiles::kDocumented, "parol6.receive.cut-short"),
    look("The frame after one cut short is answered.",
         [](BoardBench& board) {
           after_each_cut(board, [&](std::size_t) { board.expect_answer(encode(idle())); });
         }),
};

}  // namespace

Chapter receive_chapter() { return chapter("Receiving", kReceiveClauses); }

}  // namespace armjig::parol6::conformance
