// SPDX-License-Identifier: Apache-2.0
#include "cli/lab_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "cli/devices/devices.hpp"

namespace armjig::cli {
namespace {

using ::testing::HasSubstr;

std::vector<LabDevice> lab_of(std::string_view text) {
  auto lab = parse_lab(text, "lab.toml", shipped_devices());
  EXPECT_TRUE(lab) << describe(lab.error());
  return lab ? *std::move(lab) : std::vector<LabDevice>{};
}

TEST(LabFile, ADeviceOfWhichNothingIsSaidIsWhereProgramsLookForIt) {
  const auto lab = lab_of(
      "[[device]]\ndevice = 'parol6'\n"
      "[[device]]\ndevice = 'parol6'\nname = 'second'\n"
      "[[device]]\ndevice = 'kinovazed'\n"
      "[[device]]\ndevice = 'morap'\n");
  ASSERT_EQ(lab.size(), 4U);
  EXPECT_EQ(lab[0].name, "parol6");
  EXPECT_TRUE(lab[0].target.is_emulated());
  EXPECT_EQ(lab[0].places.board, 0);
  EXPECT_EQ(lab[1].places.board, 1);
  EXPECT_EQ(lab[2].places.tcp, 51717);
  EXPECT_EQ(lab[3].places.bus, 1);
  EXPECT_EQ(lab[3].where, "lab.toml:8");
}

TEST(LabFile, NodesThatAreSpokenForAreLeftOut) {
  const auto lab = lab_of(
      "[[device]]\ndevice = 'parol6'\n"
      "[[device]]\ndevice = 'demo'\nttyACM = 0\n"
      "[[device]]\ndevice = 'morap'\nname = 'a'\n"
      "[[device]]\ndevice = 'morap'\nname = 'b'\ni2c = 1\n");
  ASSERT_EQ(lab.size(), 4U);
  EXPECT_EQ(lab[0].places.board, 1);
  EXPECT_EQ(lab[2].places.bus, 2);
}

TEST(LabFile, ReadsEverythingThatADeviceCanHave) {
  const auto lab = lab_of(
      "[[device]]\nname = 'left'\ndevice = 'parol6'\ntarget = 'emulated:?profile=documented'\n"
      "pty = '/tmp/left'\ntcp = 4000\nrfc2217 = 4001\nbind = '::1'\nusb = '/tmp/left.sock'\n"
      "usbip = 0\nusb_serial = 'L'\nttyACM = 3\nspeed = 2\nimpair = 'loss=1%'\n"
      "capture = 'left.pcapng'\nrotate = '10kB,2'\nredact = true\ncheck = true\n");
  ASSERT_EQ(lab.size(), 1U);
  const auto& left = lab.front();
  EXPECT_EQ(left.target.options.at("profile"), "documented");
  ASSERT_TRUE(left.places.pty);
  EXPECT_EQ(left.places.pty->link, "/tmp/left");
  EXPECT_EQ(left.places.tcp, 4000);
  EXPECT_EQ(left.places.rfc2217, 4001);
  EXPECT_EQ(left.places.bind, "::1");
  EXPECT_EQ(left.places.usb_socket, "/tmp/left.sock");
  EXPECT_EQ(left.places.usbip, 0);
  EXPECT_EQ(left.places.usb_serial, "L");
  EXPECT_EQ(left.places.board, 3);
  EXPECT_EQ(left.speed, 2);
  ASSERT_TRUE(left.impairment);
  EXPECT_EQ(left.impairment->out.loss, 0.01);
  EXPECT_EQ(left.capture.file, "left.pcapng");
  EXPECT_EQ(left.capture.rotate, "10kB,2");
  EXPECT_TRUE(left.capture.is_redacted);
  EXPECT_TRUE(left.wants_check);
}

TEST(LabFile, OneDeviceMayBeInSeveralPlacesAndPortsThatAreAnyAreNobodys) {
  EXPECT_EQ(lab_of("[[device]]\ndevice = 'parol6'\ntcp = 0\nusbip = 0\n"
                   "[[device]]\ndevice = 'kinovazed'\ntcp = 0\n")
                .size(),
            2U);
}

TEST(LabFile, ABoardIsKnownOnUsbByItsNumbersAndItsName) {
  const auto lab = lab_of("[[device]]\ndevice = 'parol6'\nname = 'left'\n");
  const auto serving = serving_at(*lab.front().device, lab.front().name, lab.front().places);
  EXPECT_EQ(serving.identity.vendor, 0x0483);
  EXPECT_EQ(serving.identity.product, 0x5740);
  EXPECT_EQ(serving.identity.serial_number, "left-emulated");
  EXPECT_TRUE(serving.how.pty) << "a terminal is behind its node";
}

/// What a wrong lab is refused with.
struct RefusedFile {
  std::string_view text;
  std::string_view where;
  std::string_view hint;
};

const RefusedFile kRefusals[] = {
    {"", "lab.toml:1", "write [[device]]"},
    {"colour = 'red'\n[[device]]\ndevice = 'demo'\n", "lab.toml:1", "'colour'"},
    {"[[device]]\ndevice = 'demo'\ncolour = 'red'\n", "lab.toml:3", "'colour'"},
    {"[[device]]\nname = 'x'\n", "lab.toml:1", "device is missing"},
    {"[[device]]\ndevice = 'parol7'\n", "lab.toml:2", "no device 'parol7'"},
    {"[[device]]\ndevice = 6\n", "lab.toml:2", "a text in quotes"},
    {"[[device]]\ndevice = 'demo'\nname = 'a.b'\n", "lab.toml:3", "letters, digits"},
    {"[[device]]\ndevice = 'demo'\nname = ''\n", "lab.toml:3", "letters, digits"},
    {"[[device]]\ndevice = 'demo'\nname = "
     "'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa'\n",
     "lab.toml:3", "1 to 64"},
    {"[[device]]\ndevice = 'demo'\n[[device]]\ndevice = 'morap'\nname = 'demo'\n", "lab.toml:5",
     "another device 'demo'"},
    {"[[device]]\ndevice = 'demo'\ntarget = 'moon:'\n", "lab.toml:3", "no target"},
    {"[[device]]\ndevice = 'demo'\ntarget = 'emulated:?x'\n", "lab.toml:3", "NAME=VALUE"},
    {"[[device]]\ndevice = 'demo'\npty = true\n", "lab.toml:3", "a text in quotes"},
    {"[[device]]\ndevice = 'demo'\ntcp = 65536\n", "lab.toml:3", "from 0 to 65535"},
    {"[[device]]\ndevice = 'demo'\nrfc2217 = -1\n", "lab.toml:3", "from 0 to 65535"},
    {"[[device]]\ndevice = 'demo'\nusbip = 'x'\n", "lab.toml:3", "from 0 to 65535"},
    {"[[device]]\ndevice = 'demo'\nttyACM = 256\n", "lab.toml:3", "from 0 to 255"},
    {"[[device]]\ndevice = 'morap'\ni2c = 256\n", "lab.toml:3", "from 0 to 255"},
    {"[[device]]\ndevice = 'demo'\nbind = '::1'\n", "lab.toml:3", "for tcp and rfc2217"},
    {"[[device]]\ndevice = 'demo'\nusb = 'x'\nusb_serial = 'a b'\n", "lab.toml:4", "visible"},
    {"[[device]]\ndevice = 'demo'\ntcp = 0\nusb_serial = 'L'\n", "lab.toml:4", "for usb, usbip"},
    {"[[device]]\ndevice = 'morap'\nusb_serial = 'L'\n", "lab.toml:3", "for usb and usbip"},
    {"[[device]]\ndevice = 'demo'\nspeed = 0\n", "lab.toml:3", "0.001 to 10000"},
    {"[[device]]\ndevice = 'demo'\nspeed = nan\n", "lab.toml:3", "0.001 to 10000"},
    {"[[device]]\ndevice = 'demo'\ntarget = 'pty:/dev/x'\nspeed = 2\n", "lab.toml:4", "its own"},
    {"[[device]]\ndevice = 'demo'\nimpair = 'loss=2'\n", "lab.toml:3", "loss"},
    {"[[device]]\ndevice = 'demo'\ntarget = 'pty:/dev/x'\nimpair = 'loss=1%'\n", "lab.toml:4",
     "no guard"},
    {"[[device]]\ndevice = 'demo'\nrotate = '10kB,2'\n", "lab.toml:3", "nothing is recorded"},
    {"[[device]]\ndevice = 'demo'\nredact = true\n", "lab.toml:3", "nothing is recorded"},
    {"[[device]]\ndevice = 'demo'\ncheck = true\n", "lab.toml:3", "nothing is demanded"},
    {"[[device]]\ndevice = 'parol6'\ncheck = 1\n", "lab.toml:3", "true or false"},
    // Places that are not for their kind of port.
    {"[[device]]\ndevice = 'demo'\ni2c = 1\n", "lab.toml:3", "i2c is not for a byte stream"},
    {"[[device]]\ndevice = 'kinovazed'\npty = ''\n", "lab.toml:3", "pty is not for a TCP server"},
    {"[[device]]\ndevice = 'kinovazed'\nrfc2217 = 1\n", "lab.toml:3", "not for a TCP server"},
    {"[[device]]\ndevice = 'kinovazed'\nusb = 'x'\n", "lab.toml:3", "not for a TCP server"},
    {"[[device]]\ndevice = 'kinovazed'\nusbip = 1\n", "lab.toml:3", "not for a TCP server"},
    {"[[device]]\ndevice = 'kinovazed'\nttyACM = 1\n", "lab.toml:3", "not for a TCP server"},
    {"[[device]]\ndevice = 'kinovazed'\ni2c = 1\n", "lab.toml:3", "not for a TCP server"},
    {"[[device]]\ndevice = 'morap'\npty = ''\n", "lab.toml:3", "pty is not for a bus"},
    {"[[device]]\ndevice = 'morap'\ntcp = 1\n", "lab.toml:3", "tcp is not for a bus"},
    {"[[device]]\ndevice = 'morap'\nrfc2217 = 1\n", "lab.toml:3", "not for a bus"},
    {"[[device]]\ndevice = 'morap'\nttyACM = 1\n", "lab.toml:3", "not for a bus"},
    {"[[device]]\ndevice = 'morap'\nspeed = 2\n", "lab.toml:3", "speed is not for a bus"},
    {"[[device]]\ndevice = 'morap'\ntarget = 'i2c:/dev/i2c-1'\n", "lab.toml:3", "whole"},
    // Two devices in one place.
    {"[[device]]\ndevice = 'demo'\npty = '/a'\n[[device]]\ndevice = 'parol6'\npty = '/a'\n",
     "lab.toml:6", "'demo' is at /a already"},
    {"[[device]]\ndevice = 'demo'\ntcp = 4\n[[device]]\ndevice = 'parol6'\nrfc2217 = 4\n",
     "lab.toml:6", "'demo' is at TCP port 4 already"},
    {"[[device]]\ndevice = 'demo'\nusbip = 4\n[[device]]\ndevice = 'kinovazed'\ntcp = 4\n",
     "lab.toml:6", "TCP port 4"},
    {"[[device]]\ndevice = 'demo'\ntcp = 4\nbind = '::1'\n"
     "[[device]]\ndevice = 'parol6'\ntcp = 4\nbind = '::1'\n",
     "lab.toml:7", "TCP port ::1:4"},
    {"[[device]]\ndevice = 'kinovazed'\n[[device]]\ndevice = 'kinovazed'\nname = 'b'\n",
     "lab.toml:4", "TCP port 51717"},
    {"[[device]]\ndevice = 'demo'\nusb = '/a'\n[[device]]\ndevice = 'parol6'\nusb = '/a'\n",
     "lab.toml:6", "/a"},
    {"[[device]]\ndevice = 'demo'\nttyACM = 2\n[[device]]\ndevice = 'parol6'\nttyACM = 2\n",
     "lab.toml:6", "/dev/ttyACM2"},
    {"[[device]]\ndevice = 'morap'\ni2c = 2\n[[device]]\ndevice = 'morap'\nname = 'b'\ni2c = 2\n",
     "lab.toml:7", "/dev/i2c-2"},
    {"[[device]]\ndevice = 'demo'\ncapture = 'a.jsonl'\n"
     "[[device]]\ndevice = 'parol6'\ncapture = 'a.jsonl'\n",
     "lab.toml:6", "'demo' is at a.jsonl already"},
};

TEST(LabFile, NamesTheLineOfEachMistake) {
  for (const auto& refusal : kRefusals) {
    const auto lab = parse_lab(refusal.text, "lab.toml", shipped_devices());
    ASSERT_FALSE(lab) << refusal.text;
    EXPECT_EQ(lab.error().where, refusal.where) << refusal.text;
    EXPECT_THAT(lab.error().hint, HasSubstr(refusal.hint)) << refusal.text;
    EXPECT_EQ(lab.error().code, ErrorCode::kMalformed) << refusal.text;
  }
}

TEST(LabFile, AFileThatIsNotThereIsNamed) {
  const auto lab = read_lab("/none/lab.toml", shipped_devices());
  ASSERT_FALSE(lab);
  EXPECT_THAT(lab.error().where, HasSubstr("/none/lab.toml"));
}

}  // namespace
}  // namespace armjig::cli
