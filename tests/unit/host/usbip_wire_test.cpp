// SPDX-License-Identifier: Apache-2.0
// The messages of the kernel's Documentation/usb/usbip_protocol.rst.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "emulators/host/usb_wire.hpp"
#include "tests/unit/usb/plugged.hpp"

namespace armjig {
namespace {

using ::testing::StartsWith;
using usb::Plugged;

std::string repeated(const std::string& hex, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += hex;
  return all;
}

const std::string kImport =
    "01118003"
    "00000000"
    "312d31" +
    repeated("00", 29);

class Imported {
 public:
  explicit Imported(Cable cable = Cable::kIn) : wire{make_usbip_wire(board.device, cable)} {}

  /// What comes for that, hexadecimal; "refused" if the wire wants no more.
  std::string ask(const std::string& hex) {
    const auto bytes = from_hex(hex).value();
    for (std::size_t i = 0; i < bytes.size(); i += step) {
      const auto piece = Bytes{bytes}.subspan(i, std::min(step, bytes.size() - i));
      if (!wire->receive(Instant{}, piece)) return "refused";
    }
    return heard();
  }
  std::string heard() {
    while (const auto end = board.device.next(Instant{})) wire->tell(*end);
    return to_hex(std::exchange(wire->outgoing(), {}));
  }
  std::string import() {
    const auto reply = ask(kImport);
    ask(submit(1, 0, 0, 0, "0009010000000000"));
    ask(submit(2, 0, 0, 0, "2122030000000000"));
    return reply;
  }
  /// A request (CMD_SUBMIT) for the first device of the first bus.
  static std::string submit(unsigned number, unsigned direction, unsigned endpoint, unsigned length,
                            const std::string& setup, const std::string& data = "") {
    return "00000001" + word(number) + "00010002" + word(direction) + word(endpoint) + "00000000" +
           word(length) + repeated("00", 12) + setup + data;
  }
  static std::string unlink(unsigned number, unsigned unlinked) {
    return "00000002" + word(number) + "00010002" + word(0) + word(0) + word(unlinked) +
           repeated("00", 24);
  }
  static std::string word(unsigned value) {
    std::vector<std::byte> bytes;
    for (unsigned i = 4; i-- > 0;) bytes.push_back(static_cast<std::byte>(value >> 8 * i));
    return to_hex(bytes);
  }

  std::size_t step = 1'000'000;
  Plugged board{Plugged::Configured::kNo};
  std::unique_ptr<UsbWire> wire;
};

const std::string kNoSetup = repeated("00", 8);

/// RET_SUBMIT without data.
std::string reply(unsigned number, const std::string& status, unsigned length) {
  return "00000003" + Imported::word(number) + repeated("00", 12) + status +
         Imported::word(length) + repeated("00", 20);
}

TEST(UsbipWire, ListsItsOnlyDevice) {
  Imported imported;
  const auto list = imported.ask("0111800500000000");
  EXPECT_THAT(list, StartsWith("01110005"
                               "00000000"
                               "00000001"));
  // Bus 1, device 2, full speed, 0483:5740, version 1.00, CDC, not configured, one configuration,
  // two interfaces and their classes.
  const std::string tail =
      "00000001"
      "00000002"
      "00000002"
      "0483"
      "5740"
      "0100"
      "020000"
      "00"
      "01"
      "02"
      "02020100"
      "0a000000";
  EXPECT_EQ(list.substr(list.size() - tail.size()), tail);
  EXPECT_EQ(list.size(), 2U * (12 + 312 + 8));
}

TEST(UsbipWire, GivesTheDeviceToWhoAsksForIt) {
  Imported imported;
  const auto import = imported.import();
  EXPECT_THAT(import, StartsWith("01110003"
                                 "00000000"));
  EXPECT_EQ(import.size(), 2U * (8 + 312));
  EXPECT_EQ(imported.board.device.configuration(), 1);
}

TEST(UsbipWire, HasNoOtherDevice) {
  Imported imported;
  EXPECT_EQ(imported.ask("0111800300000000"
                         "322d31" +
                         repeated("00", 29)),
            "0111000300000001");
  EXPECT_EQ(Imported{Cable::kOut}.ask(kImport), "0111000300000001");
  EXPECT_EQ(Imported{Cable::kOut}.ask("0111800500000000"),
            "0111000500000000"
            "00000000");
}

TEST(UsbipWire, CarriesBytesBothWaysHoweverTheyAreCut) {
  for (const std::size_t step : {std::size_t{1}, std::size_t{11}, std::size_t{1'000'000}}) {
    Imported imported;
    imported.step = step;
    imported.import();
    EXPECT_EQ(imported.ask(Imported::submit(3, 0, 1, 3, kNoSetup, "010203")),
              reply(3, "00000000", 3));
    EXPECT_EQ(imported.board.heard, "010203");
    EXPECT_EQ(imported.ask(Imported::submit(4, 1, 1, 64, kNoSetup)), "");
    imported.board.say("aabb");
    EXPECT_EQ(imported.heard(), reply(4, "00000000", 2) + "aabb");
  }
}

TEST(UsbipWire, TellsAStallAsLinuxDoes) {
  Imported imported;
  imported.import();
  // A descriptor of high speed: EPIPE, 32.
  EXPECT_EQ(imported.ask(Imported::submit(5, 1, 0, 10, "8006000600000a00")),
            reply(5, "ffffffe0", 0));
}

TEST(UsbipWire, WhatIsUnlinkedHasNoOtherEnd) {
  Imported imported;
  imported.import();
  imported.ask(Imported::submit(6, 1, 1, 64, kNoSetup));
  // ECONNRESET, 104: it was in time.
  EXPECT_EQ(imported.ask(Imported::unlink(7, 6)),
            "00000004"
            "00000007" +
                repeated("00", 12) + "ffffff98" + repeated("00", 24));
  imported.board.say("dd");
  EXPECT_EQ(imported.heard(), "");
  EXPECT_EQ(imported.ask(Imported::submit(8, 1, 1, 64, kNoSetup)), reply(8, "00000000", 1) + "dd");
}

TEST(UsbipWire, WhatHasEndedCannotBeUnlinked) {
  Imported imported;
  imported.import();
  imported.ask(Imported::submit(9, 0, 1, 1, kNoSetup, "01"));
  EXPECT_EQ(imported.ask(Imported::unlink(10, 9)),
            "00000004"
            "0000000a" +
                repeated("00", 12) + "00000000" + repeated("00", 24));
}

TEST(UsbipWire, EndsWithTheCable) {
  Imported imported;
  EXPECT_FALSE(imported.wire->set_cable(Cable::kOut));
  EXPECT_TRUE(imported.wire->set_cable(Cable::kIn));
}

TEST(UsbipWire, LetsGoWhoDoesNotSpeakTheProtocol) {
  EXPECT_EQ(Imported{}.ask("0106800300000000"), "refused");  // another version
  EXPECT_EQ(Imported{}.ask("0111800400000000"), "refused");  // another operation
  Imported imported;
  imported.import();
  EXPECT_EQ(imported.ask(Imported::submit(3, 0, 1, 0x7FFF'FFFF, kNoSetup)), "refused");
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 dice{seed};
    Imported another;
    another.import();
    std::vector<std::byte> noise(4096);
    for (auto& byte : noise) byte = static_cast<std::byte>(dice());
    EXPECT_EQ(another.ask(to_hex(noise)), "refused");
  }
}

}  // namespace
}  // namespace armjig
