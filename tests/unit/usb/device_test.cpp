// SPDX-License-Identifier: Apache-2.0
#include "emulators/usb/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/unit/usb/plugged.hpp"

namespace armjig::usb {
namespace {

using ::testing::Each;
using ::testing::Pair;

TEST(UsbDevice, EndsEachTransferOnceAtWhateverMomentItIsCancelled) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 dice{seed};
    Plugged plugged;
    plugged.open();
    std::map<std::uint64_t, int> ends;
    std::uint64_t id = 100;
    for (int step = 0; step < 60; ++step) {
      plugged.appetite = static_cast<int>(dice() % 3);
      switch (dice() % 5) {
        case 0:
          ends[++id] = 0;
          plugged.read(id, 1 + dice() % 200);
          break;
        case 1:
          ends[++id] = 0;
          plugged.submit({.id = id,
                          .endpoint = CdcAcm::kBulkOut,
                          .bytes = std::vector<std::byte>(dice() % 200)});
          break;
        case 2:
          plugged.device.cancel(100 + dice() % (id - 99));
          break;
        case 3:
          (void)plugged.port.send(std::vector<std::byte>(1 + dice() % 150));
          plugged.device.advance();
          break;
        default:
          while (const auto end = plugged.device.next(Instant{})) ++ends[end->id];
      }
    }
    plugged.device.reset(Instant{});  // the host ends all that waits
    while (const auto end = plugged.device.next(Instant{})) ++ends[end->id];
    EXPECT_THAT(ends, Each(Pair(::testing::_, 1))) << "seed " << seed;
  }
}

TEST(UsbDevice, ACancelledTransferIsNotEndedAgain) {
  Plugged plugged;
  plugged.open();
  plugged.read(1, 64);
  EXPECT_TRUE(plugged.device.cancel(1));
  plugged.say("aa");
  EXPECT_EQ(plugged.ended().status, Status::kCancelled);
  EXPECT_FALSE(plugged.device.next(Instant{}));
  EXPECT_FALSE(plugged.device.cancel(1));
}

TEST(UsbDevice, WhatACancelledReadLeavesIsForTheNext) {
  Plugged plugged;
  plugged.open();
  plugged.read(1, 64);
  plugged.device.cancel(1);
  (void)plugged.ended();
  plugged.say("bb");
  plugged.read(2, 64);
  EXPECT_EQ(to_hex(plugged.ended().bytes), "bb");
}

TEST(UsbDevice, AHaltedEndpointStallsUntilTheHostClearsIt) {
  Plugged plugged;
  plugged.read(1, 64);
  plugged.submit({.id = 2, .setup = {0x02, 3, 0, CdcAcm::kBulkIn, 0}});
  EXPECT_EQ(plugged.ended().status, Status::kStalled);  // the one that waited
  (void)plugged.ended();                                // the request itself
  EXPECT_EQ(to_hex(plugged.get({0x82, 0, 0, CdcAcm::kBulkIn, 2}).bytes), "0100");
  plugged.read(3, 64);
  EXPECT_EQ(plugged.ended().status, Status::kStalled);
  plugged.set({0x02, 1, 0, CdcAcm::kBulkIn, 0});
  plugged.read(4, 64);
  EXPECT_FALSE(plugged.device.next(Instant{}));
}

TEST(UsbDevice, KnowsItsOneConfiguration) {
  Plugged plugged;
  EXPECT_EQ(to_hex(plugged.get({0x80, 8, 0, 0, 1}).bytes), "01");
  EXPECT_EQ(plugged.set({0x00, 9, 2, 0, 0}).status, Status::kStalled);
  EXPECT_EQ(plugged.set({0x01, 11, 0, 1, 0}).status, Status::kDone);
  EXPECT_EQ(plugged.set({0x01, 11, 1, 1, 0}).status, Status::kStalled);  // another setting
  EXPECT_EQ(plugged.set({0x01, 11, 0, 2, 0}).status, Status::kStalled);  // a third interface
}

TEST(UsbDevice, RefusesAnEndpointThatItDoesNotHave) {
  Plugged plugged;
  plugged.submit({.endpoint = 0x83, .room = 8});
  EXPECT_EQ(plugged.ended().status, Status::kInvalid);
}

TEST(UsbDevice, RefusesARequestWhoseDataAreNotAsLongAsItSays) {
  Plugged plugged;
  plugged.submit({.setup = {0x21, 0x20, 0, 0, 7}, .bytes = std::vector<std::byte>(6)});
  EXPECT_EQ(plugged.ended().status, Status::kInvalid);
  plugged.submit({.endpoint = 0, .setup = {0x80, 6, 0x0100, 0, 18}});  // reads the wrong way
  EXPECT_EQ(plugged.ended().status, Status::kInvalid);
}

TEST(UsbDevice, LetsNoHostPileUpTransfers) {
  Plugged plugged;
  for (std::size_t i = 0; i <= Device::kMostTransfers; ++i) plugged.read(i, 64);
  EXPECT_EQ(plugged.ended().status, Status::kInvalid);
  EXPECT_FALSE(plugged.device.next(Instant{}));
}

}  // namespace
}  // namespace armjig::usb
