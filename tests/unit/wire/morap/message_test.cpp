// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/message.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <set>
#include <string_view>

#include "harness/wire/morap/pen.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::morap {
namespace {

using test::as_vector;
using test::hex;
using enum CommandId;

const DecodedCommand& decoded(const std::variant<DecodedCommand, CommandFault>& result) {
  return std::get<DecodedCommand>(result);
}

TEST(MorapCommand, EncodesAsInTheTestVectors) {
  EXPECT_EQ(as_vector(encode(Command{kCalibrateZero}).view()), hex("10"));
  EXPECT_EQ(as_vector(encode(Command{kPosition, 1.0F}).view()), hex("01 00 00 80 3F"));
  EXPECT_EQ(as_vector(encode(Command{kDirectVoltage, -30.0F}).view()), hex("04 00 00 F0 C1"));
  const TuneRequest request{TuneKind::kPiSpeed, 0.1F, -50.0F};  // the pendulum application
  EXPECT_EQ(as_vector(encode(Command{kTune, request}).view()),
            hex("22 02 CD CC CC 3D 00 00 48 C2"));
}

TEST(MorapCommand, IsListedOnceAndEveryOneComesBack) {
  std::set<CommandId> ids;
  for (const auto& info : commands()) {
    EXPECT_TRUE(ids.insert(info.id).second) << info.name;
    auto data = hex("00 00 00 00 00 00 00 00 00 00 00 FF");
    data[0] = static_cast<std::byte>(info.id);
    const auto result = decode_command(data);
    const auto& [command, size] = decoded(result);
    EXPECT_EQ(command.id, info.id);
    const auto expected = Bytes{data}.first(size);
    EXPECT_EQ(as_vector(encode(command).view()), as_vector(expected)) << info.name;
  }
  for (const auto& info : readings()) {
    EXPECT_TRUE(ids.insert(info.selector).second) << info.name;
    const std::array data{static_cast<std::byte>(info.selector)};
    EXPECT_EQ(decoded(decode_command(data)).command.id, info.selector);
  }
}

TEST(MorapCommand, SaysWhyBytesAreNone) {
  const auto fault = [](std::string_view text) {
    return std::get<CommandFault>(decode_command(hex(text))).kind;
  };
  using enum CommandFault::Kind;
  EXPECT_EQ(fault(""), kEmpty);
  EXPECT_EQ(fault("06"), kUnknownId);
  EXPECT_EQ(fault("87 00"), kUnknownId);
  EXPECT_EQ(fault("01 00 00 80"), kTooShort);
  EXPECT_EQ(fault("22 00 CD CC 4C 3E 00 00 10"), kTooShort);
  EXPECT_EQ(fault("20 00 C8 00 01"), kTooShort);
  EXPECT_EQ(fault("20 00 C8 00 05"), kBadSet);
  EXPECT_EQ(fault("20 00 00 00 00 00 00 00 00 00 00 FE"), kBadSet);
}

TEST(MorapCommand, KeepsEveryBitOfAFloat) {
  test::for_all([] {
    const auto bits = *rc::gen::arbitrary<std::uint32_t>();
    const auto bytes = encode(Command{kSpeed, std::bit_cast<float>(bits)});
    const auto result = decode_command(bytes);
    RC_ASSERT(std::bit_cast<std::uint32_t>(std::get<float>(decoded(result).command.payload)) ==
              bits);
    RC_ASSERT(as_vector(encode(std::bit_cast<float>(bits))) == as_vector(bytes.view().subspan(1)));
  });
  // A signalling NaN, a negative zero, and a NaN with a sign: none may be tidied up.
  for (const auto bits : {0x7F800201U, 0x80000000U, 0xFFC00001U}) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(decode_float(encode(std::bit_cast<float>(bits)))), bits);
  }
}

TEST(MorapCommand, LeavesWhatFollowsItAlone) {
  EXPECT_EQ(decoded(decode_command(hex("01 00 00 80 3F AA BB"))).size, 5U);
  EXPECT_EQ(decoded(decode_command(hex("22 00 CD CC 4C 3E 00 00 10 C1 09"))).size, 10U);
  EXPECT_EQ(decoded(decode_command(hex("80 81"))).size, 1U);
}

TEST(NodeAddress, IsTheBaseOredWithTheIdentifier) {
  EXPECT_EQ(node_address(0), 0x10);
  EXPECT_EQ(node_address(2), 0x12);
  EXPECT_EQ(node_address(9), pen::kAddress);  // a node that collides with the pen
  EXPECT_EQ(node_address(16), 0x10);
}

TEST(Pen, TurnsPositionsIntoDegreesTowardsZero) {
  // docs/spec/morap.md, section Pen.
  const auto degrees = [](std::string_view text) { return pen::servo_degrees(hex(text)); };
  EXPECT_EQ(degrees("01"), 8);
  EXPECT_EQ(degrees("02"), 45);
  EXPECT_EQ(degrees("07 00"), 45);
  EXPECT_EQ(degrees("07 06"), 45);
  EXPECT_EQ(degrees("07 07"), 44);
  EXPECT_EQ(degrees("07 40"), 36);
  EXPECT_EQ(degrees("07 7F"), 27);
  EXPECT_EQ(degrees("07 80"), 27);
  EXPECT_EQ(degrees("07 83"), 26);
  EXPECT_EQ(degrees("07 FE"), 9);
  EXPECT_EQ(degrees("07 FF"), 8);
  EXPECT_EQ(degrees("07"), 45);
  EXPECT_EQ(degrees("09"), 45);
  EXPECT_EQ(as_vector(pen::encode({pen::CommandId::kSetPosition, 128}).view()), hex("07 80"));
  EXPECT_EQ(as_vector(pen::encode({pen::CommandId::kDeploy}).view()), hex("01"));
}

}  // namespace
}  // namespace armjig::morap
