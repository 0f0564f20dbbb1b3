// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/target.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/rig/real_target.hpp"

namespace armjig {
namespace {

using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

Problem problem_of(std::string_view text) {
  auto target = parse_target(text);
  if (!target) return target.error();
  auto port = open_target<StreamPort>(*target, {});
  return port ? Problem{} : port.error();
}

TEST(Target, HasASchemeAndAnAddress) {
  const auto target = parse_target("pty:/dev/pts/5").value();
  EXPECT_EQ(target.text, "pty:/dev/pts/5");
  EXPECT_EQ(target.scheme, "pty");
  EXPECT_EQ(target.address, "/dev/pts/5");
  EXPECT_TRUE(target.options.empty());
  EXPECT_FALSE(target.is_emulated());
}

TEST(Target, AddressesKeepTheirColonsCommasAndQuestionMarks) {
  EXPECT_EQ(parse_target("tcp:[::1]:4000")->address, "[::1]:4000");
  EXPECT_EQ(parse_target("usb:0483:5740")->address, "0483:5740");
  EXPECT_EQ(parse_target("serial:/dev/ttyACM0,3000000")->address, "/dev/ttyACM0,3000000");
  EXPECT_EQ(parse_target("pty:/tmp/what?a=b")->address, "/tmp/what?a=b");
}

TEST(Target, AnEmulatedOneHasOptions) {
  const auto target = parse_target("emulated:?profile=firmware&fault=zero:echo").value();
  EXPECT_TRUE(target.is_emulated());
  EXPECT_TRUE(target.address.empty());
  EXPECT_THAT(target.options,
              UnorderedElementsAre(Pair("profile", "firmware"), Pair("fault", "zero:echo")));
}

TEST(Target, AnOptionMayBeEmptyButNotNameless) {
  EXPECT_EQ(parse_target("emulated:?fault=")->options.at("fault"), "");
  EXPECT_FALSE(parse_target("emulated:?=zero"));
  EXPECT_FALSE(parse_target("emulated:?fault"));
}

TEST(Target, WhatIsNoneIsAnsweredWithAllForms) {
  for (const auto* text : {"", "nonsense", "/dev/ttyACM0", "rs232:/dev/ttyS0", ":", "PTY:/dev/x"}) {
    const auto parsed = parse_target(text);
    ASSERT_FALSE(parsed) << text;
    const auto& found = parsed.error();
    EXPECT_EQ(found.code, ErrorCode::kBadTarget) << text;
    for (const auto* form : {"emulated:", "serial:", "usb:", "pty:", "tcp:"}) {
      EXPECT_THAT(found.hint, HasSubstr(form)) << text;
    }
  }
}

TEST(Target, AnEmulatedOneHasNoAddress) {
  EXPECT_THAT(problem_of("emulated:parol6").hint, HasSubstr("no address"));
}

TEST(Target, ASerialPortNeedsAPathAndMayHaveASpeed) {
  for (const auto* text : {"serial:", "serial:,9600", "serial:/dev/x,", "serial:/dev/x,fast",
                           "serial:/dev/x,0", "serial:/dev/x,-1", "serial:/dev/x,99999999999"}) {
    EXPECT_EQ(problem_of(text).code, ErrorCode::kBadTarget) << text;
    EXPECT_THAT(problem_of(text).hint, HasSubstr("serial:PATH,BAUD")) << text;
  }
}

TEST(Target, ASerialPortThatIsNotThereIsNotFound) {
  const auto found = problem_of("serial:/dev/there-is-no-such-port");
  EXPECT_EQ(found.code, ErrorCode::kNotFound);
  EXPECT_EQ(found.where, "/dev/there-is-no-such-port");
  EXPECT_THAT(found.hint, HasSubstr("armjig devices"));
}

TEST(Target, AUsbDeviceIsTwoHexadecimalNumbersOrAPlace) {
  for (const auto* text : {"usb:", "usb:0483", "usb:0483:", "usb:0483:57400", "usb:xyz:5740",
                           "usb:0483:5740:", "usb:0483:5740,fast", "usb:-1:5740", "usb:1-2."}) {
    EXPECT_EQ(problem_of(text).code, ErrorCode::kBadTarget) << text;
    EXPECT_THAT(problem_of(text).hint, HasSubstr("usb:0483:5740")) << text;
  }
}

}  // namespace
}  // namespace armjig
