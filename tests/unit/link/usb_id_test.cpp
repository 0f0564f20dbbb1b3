// SPDX-License-Identifier: Apache-2.0
#include "harness/link/usb_id.hpp"

#include <gtest/gtest.h>

namespace armjig {
namespace {

const UsbId kBoard{0x0483, 0x5740};

TEST(UsbId, IsWrittenAsItIsRead) {
  const auto id = parse_usb_id("0483:5740").value();
  EXPECT_EQ(id.vendor, 0x0483);
  EXPECT_EQ(id.product, 0x5740);
  EXPECT_EQ(to_string(id), "0483:5740");
  EXPECT_EQ(parse_usb_id("AbC:f"), (UsbId{0x0ABC, 0x000F}));
}

TEST(UsbChoice, IsAKindOfBoardAndMayBeOneOfThem) {
  EXPECT_EQ(parse_usb_board("0483:5740"), UsbChoice{.ids = {kBoard}});
  EXPECT_EQ(parse_usb_board("483:5740:42A"), (UsbChoice{.ids = {kBoard}, .serial_number = "42A"}));
  EXPECT_EQ(parse_usb_board("0483:5740:a:b/c-1")->serial_number, "a:b/c-1");
}

TEST(UsbChoice, MayBeAPlace) {
  for (const auto* text : {"1-2", "12-1.4.7"}) {
    EXPECT_EQ(parse_usb_choice(text), UsbChoice{.place = text}) << text;
    EXPECT_FALSE(parse_usb_board(text)) << text;
  }
  EXPECT_EQ(parse_usb_choice("0483:5740"), UsbChoice{.ids = {kBoard}});
}

TEST(UsbChoice, IsNothingElse) {
  for (const auto* text : {"", ":", "0483", "0483:", ":5740", "0483:5740:", "0483:57400", "x:5740",
                           "-1:5740", "1-", "-2", "1-2.", "1-.2", "1-2-3", "1-2.x", "1-256"}) {
    EXPECT_FALSE(parse_usb_choice(text)) << text;
  }
}

}  // namespace
}  // namespace armjig
