// SPDX-License-Identifier: Apache-2.0
// A board's serial port as its host sees it: requests and bytes are those of "USB Class Definitions
// for CDC, PSTN Subclass" 1.2 and of USB 2.0, chapter 9.
#include "emulators/usb/cdc_acm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "emulators/usb/device.hpp"
#include "harness/core/hex.hpp"
#include "tests/unit/usb/plugged.hpp"

namespace armjig::usb {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(CdcAcm, DescribesItselfAsTheDeviceOfItsEntry) {
  Plugged plugged;
  // USB 2.0, CDC, 64 bytes, 0483:5740, version 1.00, strings 1 to 3, one configuration.
  EXPECT_EQ(to_hex(plugged.get({0x80, 6, 0x0100, 0, 64}).bytes),
            "1201000202000040830440570001010203"
            "01");
  // "armjig" in UTF-16.
  EXPECT_EQ(to_hex(plugged.get({0x80, 6, 0x0301, 0x0409, 255}).bytes),
            "0e03610072006d006a0069006700");
}

TEST(CdcAcm, GivesAsMuchOfADescriptorAsIsAskedFor) {
  Plugged plugged;
  const auto head = plugged.get({0x80, 6, 0x0200, 0, 9});
  // Nine bytes; 67 in all: 9 + 9 + 19 + 7 of the first interface, 9 + 7 + 7 of the second.
  EXPECT_EQ(to_hex(head.bytes),
            "0902430002010080"
            "32");
  EXPECT_EQ(plugged.get({0x80, 6, 0x0200, 0, 255}).bytes.size(), 67U);
}

TEST(CdcAcm, HasNothingButItsOwnDescriptors) {
  Plugged plugged;
  EXPECT_EQ(plugged.get({0x80, 6, 0x0600, 0, 10}).status, Status::kStalled);  // of high speed
  EXPECT_EQ(plugged.get({0x80, 6, 0x0304, 0, 10}).status, Status::kStalled);  // a fourth string
  EXPECT_EQ(plugged.get({0x80, 6, 0x0201, 0, 10}).status, Status::kStalled);  // a second one
}

TEST(CdcAcm, KeepsTheLineCodingThatWasSet) {
  Plugged plugged;
  // 3,000,000 baud (0x2DC6C0), two stop bits, even parity, 7 bits.
  const auto coding = from_hex("c0c62d00020207").value();
  EXPECT_EQ(plugged.set({0x21, 0x20, 0, 0, 7}, coding).status, Status::kDone);
  EXPECT_EQ(plugged.port.line_coding(), (LineCoding{3'000'000, 2, 2, 7}));
  EXPECT_EQ(to_hex(plugged.get({0xA1, 0x21, 0, 0, 7}).bytes), "c0c62d00020207");
}

TEST(CdcAcm, RefusesALineCodingOfAnotherLength) {
  Plugged plugged;
  EXPECT_EQ(plugged.set({0x21, 0x20, 0, 0, 3}, from_hex("010203").value()).status,
            Status::kStalled);
  EXPECT_EQ(plugged.port.line_coding(), LineCoding{});
}

TEST(CdcAcm, HearsNoProgramBeforeItIsConfigured) {
  Plugged plugged{Plugged::Configured::kNo};
  plugged.submit({.id = 7, .endpoint = CdcAcm::kBulkOut, .bytes = from_hex("01").value()});
  EXPECT_EQ(plugged.ended().status, Status::kInvalid);
  EXPECT_EQ(plugged.heard, "");
}

TEST(CdcAcm, PassesOnWhatIsWrittenInItsOrder) {
  Plugged plugged;
  plugged.write("0102");
  plugged.write("03");
  EXPECT_EQ(plugged.heard, "010203");
  EXPECT_EQ(plugged.ended().size, 2U);
}

TEST(CdcAcm, CutsALongWriteIntoPackets) {
  Plugged plugged;
  plugged.write(std::string(2 * 130, 'a'));
  EXPECT_THAT(plugged.packets, ElementsAre(64, 64, 2));
}

TEST(CdcAcm, AnEmptyPacketIsNoBytes) {
  Plugged plugged;
  plugged.write("");
  EXPECT_EQ(plugged.ended().status, Status::kDone);
  EXPECT_THAT(plugged.packets, ElementsAre());
}

TEST(CdcAcm, LetsTheHostWaitInTheMiddleOfAWrite) {
  Plugged plugged;
  plugged.appetite = 2;
  plugged.write(std::string(2 * 200, 'b'));
  EXPECT_THAT(plugged.packets, ElementsAre(64, 64));
  EXPECT_FALSE(plugged.device.next(Instant{}));
  plugged.appetite = 2;
  plugged.device.advance();
  EXPECT_THAT(plugged.packets, ElementsAre(64, 64, 64, 8));
  EXPECT_EQ(plugged.ended().size, 200U);
}

TEST(CdcAcm, AReadEndsWithAShortPacket) {
  Plugged plugged;
  plugged.open();
  plugged.read(1, 128);
  plugged.read(2, 128);
  plugged.say(std::string(2 * 70, '1'));
  plugged.say("22");
  EXPECT_EQ(plugged.ended().size, 70U);
  EXPECT_EQ(to_hex(plugged.ended().bytes), "22");
}

TEST(CdcAcm, AMessageOfWholePacketsEndsWithAnEmptyOne) {
  Plugged plugged;
  plugged.open();
  plugged.read(1, 256);
  plugged.say(std::string(2 * 128, '3'));
  EXPECT_EQ(plugged.ended().size, 128U);  // it did not wait until 256 are full
  plugged.read(2, 64);
  plugged.say(std::string(2 * 64, '4'));
  EXPECT_EQ(plugged.ended().size, 64U);
  plugged.read(3, 64);
  EXPECT_EQ(plugged.ended().size, 0U);  // the empty one
}

TEST(CdcAcm, MoreThanThereIsRoomForIsBabble) {
  Plugged plugged;
  plugged.open();
  plugged.read(1, 10);
  plugged.say(std::string(2 * 20, '5'));
  const auto end = plugged.ended();
  EXPECT_EQ(end.status, Status::kBabbled);
  EXPECT_EQ(end.size, 10U);
}

TEST(CdcAcm, DropsWhatNobodyIsThereFor) {
  Plugged plugged;
  EXPECT_FALSE(plugged.port.send(from_hex("01").value()));
  plugged.open();
  EXPECT_TRUE(plugged.port.send(from_hex("02").value()));
  plugged.close();
  plugged.open();
  plugged.read(1, 64);
  EXPECT_FALSE(plugged.device.next(Instant{})) << "the next program got what was for another";
}

TEST(CdcAcm, DropsWholeMessagesOfAProgramThatDoesNotRead) {
  Plugged plugged;
  plugged.open();
  const std::vector<std::byte> message(1000);
  std::size_t taken = 0;
  while (plugged.port.send(message)) ++taken;
  EXPECT_EQ(taken, CdcAcm::kCapacity / 1000);
  plugged.read(1, 4096);
  EXPECT_EQ(plugged.ended().size, 1000U);
  EXPECT_TRUE(plugged.port.send(message));
}

TEST(CdcAcm, NotifiesThatItIsReadyWhenAProgramComes) {
  Plugged plugged;
  plugged.submit({.id = 9, .endpoint = CdcAcm::kNotifications, .room = 16});
  plugged.open();
  // SERIAL_STATE to interface 0, two bytes: carrier and data set ready.
  EXPECT_EQ(to_hex(plugged.ended().bytes), "a1200000000002000300");
}

TEST(CdcAcm, ForgetsAllWhenItIsPulledOut) {
  Plugged plugged;
  plugged.open();
  plugged.set({0x21, 0x20, 0, 0, 7}, from_hex("8025000000000"
                                              "8")
                                         .value());
  plugged.read(1, 64);
  plugged.device.unplug(Instant{});
  EXPECT_FALSE(plugged.device.next(Instant{}));
  EXPECT_FALSE(plugged.port.is_open());
  EXPECT_EQ(plugged.port.line_coding(), LineCoding{});
  EXPECT_EQ(plugged.device.configuration(), 0);
}

}  // namespace
}  // namespace armjig::usb
