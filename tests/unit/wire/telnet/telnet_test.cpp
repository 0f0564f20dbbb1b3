// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/telnet/telnet.hpp"

#include <string>
#include <type_traits>

#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::telnet {
namespace {

using test::ByteVector;
using test::hex;

std::string number(auto value) { return std::to_string(static_cast<unsigned>(value)); }

/// What was found, in the order in which it came: data put together, everything else in brackets.
std::string found_in(Decoder& decoder, Bytes in) {
  std::string all;
  while (!in.empty()) {
    const auto step = decoder.step(in);
    if (step.used == 0) return all + "[stuck]";
    in = in.subspan(step.used);
    if (const auto* data = std::get_if<Data>(&step.found)) {
      for (const auto byte : data->bytes) all += " " + number(byte);
    } else if (const auto* wish = std::get_if<Negotiation>(&step.found)) {
      all += " [" + number(wish->verb) + " " + number(wish->option) + "]";
    } else if (const auto* inside = std::get_if<Subnegotiation>(&step.found)) {
      all += " [in " + number(inside->option) + ":";
      for (const auto byte : inside->bytes) all += " " + number(byte);
      all += inside->is_cut ? " ...]" : "]";
    } else if (const auto* command = std::get_if<Command>(&step.found)) {
      all += " [" + number(command->code) + "]";
    }
  }
  return all;
}

std::string found_in(Bytes in) {
  Decoder decoder;
  return found_in(decoder, in);
}

ByteVector escaped(Bytes data) {
  ByteVector out;
  escape(data, [&](Bytes piece) { out.insert(out.end(), piece.begin(), piece.end()); });
  return out;
}

TEST(TelnetDecoder, TellsDataFromCommands) {
  EXPECT_EQ(found_in(hex("01 FF FD 2C 02 FF F1 03")), " 1 [253 44] 2 [241] 3");
}

TEST(TelnetDecoder, TakesTwoIacForOneByteOfData) {
  EXPECT_EQ(found_in(hex("FF FF FF FF 34 FF FF")), " 255 255 52 255");
}

TEST(TelnetDecoder, LeavesCarriageReturnsAlone) {
  EXPECT_EQ(found_in(hex("0D 00 0D 0A")), " 13 0 13 10");
}

TEST(TelnetDecoder, FindsASubnegotiationWithADoubledIac) {
  // IAC SB COM-PORT SET-BAUDRATE 0x0000FFFF IAC SE
  EXPECT_EQ(found_in(hex("FF FA 2C 01 00 00 FF FF FF FF FF F0 07")), " [in 44: 1 0 0 255 255] 7");
}

TEST(TelnetDecoder, DropsASubnegotiationThatACommandBreaksOff) {
  EXPECT_EQ(found_in(hex("FF FA 2C 01 FF FB 00 41")), " [251 0] 65");
  EXPECT_EQ(found_in(hex("FF FA 2C 01 FF FA 2C 0C 03 FF F0 41")), " [in 44: 12 3] 65");
  EXPECT_EQ(found_in(hex("FF FA FF F0 41")), " 65") << "one without an option";
}

TEST(TelnetDecoder, CutsALongSubnegotiation) {
  for (const std::size_t size : {Decoder::kLongest, Decoder::kLongest + 1, std::size_t{100'000}}) {
    const auto in = test::joined(hex("FF FA 2C"), test::zeros(size), hex("FF F0 05"));
    std::string zeros;
    for (std::size_t i = 0; i < Decoder::kLongest; ++i) zeros += " 0";
    EXPECT_EQ(found_in(in), " [in 44:" + zeros + (size > Decoder::kLongest ? " ...] 5" : "] 5"));
  }
}

TEST(TelnetDecoder, FindsTheSameHoweverTheBytesAreSplit) {
  test::for_all([] {
    // Mostly bytes that mean something to Telnet.
    const auto bytes = *rc::gen::container<std::vector<std::uint8_t>>(
        rc::gen::weightedOneOf<std::uint8_t>({{3, rc::gen::just(std::uint8_t{255})},
                                              {5, rc::gen::inRange<std::uint8_t>(240, 255)},
                                              {2, rc::gen::arbitrary<std::uint8_t>()}}));
    const auto in = std::as_bytes(std::span{bytes});
    Decoder decoder;
    std::string split;
    for (auto rest = in; !rest.empty();) {
      const auto size = *rc::gen::inRange<std::size_t>(1, rest.size() + 1);
      split += found_in(decoder, rest.first(size));
      rest = rest.subspan(size);
    }
    RC_ASSERT(split == found_in(in));
  });
}

TEST(TelnetEscape, IsUndoneByTheDecoder) {
  EXPECT_TRUE(test::same_bytes(escaped(hex("FF 01 FF FF")), hex("FF FF 01 FF FF FF FF")));
  test::Dice dice{2217};
  for (int round = 0; round < 200; ++round) {
    ByteVector data(static_cast<std::size_t>(dice.between(0, 60)));
    for (auto& byte : data) byte = dice.one_in(3) ? kIac : dice.byte();
    std::string expected;
    for (const auto byte : data) expected += " " + number(byte);
    EXPECT_EQ(found_in(escaped(data)), expected);
  }
}

}  // namespace
}  // namespace armjig::telnet
