// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/doctor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <set>

#include "harness/rig/attached.hpp"

namespace armjig {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
namespace fs = std::filesystem;
using State = Finding::State;

constexpr std::array kBoards{KnownBoard{"parol6", {0x0483, 0x5740}},
                             KnownBoard{"demo", {0x1209, 0xABCD}}};

SerialPort parol6_at(const std::string& path) {
  return {.path = path,
          .description = "PAROL6 control board - 42",
          .usb = UsbId{0x0483, 0x5740},
          .manufacturer = "STMicroelectronics",
          .product = "PAROL6 control board",
          .serial_number = "42"};
}

/// A machine below a folder of its own, on which everything is well until a test spoils it.
class Doctor : public ::testing::Test {
 protected:
  Doctor() {
    std::string name = (fs::temp_directory_path() / "armjig-doctor-XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    system_.root = root_;
    system_.groups = {"users", "dialout"};
    system_.can_make_ptys = true;
    system_.realtime_priority = 50;
    system_.locked_memory = System::kUnlimited;
    write("/etc/udev/rules.d/60-armjig.rules", "");
    write("/run/udev/control", "");
    write("/proc/1/comm", "systemd");
    write("/proc/self/timerslack_ns", "50000");
    write("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
    plug_in("/dev/ttyACM0");
  }
  ~Doctor() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& line) const {
    fs::create_directories((root_ + path).substr(0, (root_ + path).rfind('/')));
    std::ofstream{root_ + path} << line << '\n';
  }
  void remove(const std::string& path) const { fs::remove_all(root_ + path); }
  void plug_in(const std::string& path) {
    write(path, "");
    system_.ports.push_back(parol6_at(path));
  }

  [[nodiscard]] Finding finding(std::string_view check) const {
    const auto all = examine(system_, kBoards);
    const auto found = std::ranges::find(all, check, &Finding::check);
    return found == all.end() ? Finding{} : *found;
  }
  [[nodiscard]] bool is_well() const {
    return std::ranges::all_of(examine(system_, kBoards), [](const Finding& f) {
      return f.state == State::kOk && f.fix.empty();
    });
  }
  /// The only finding that is not ok.
  void expect(std::string_view check, State state, const std::string& fix) const {
    for (const auto& one : examine(system_, kBoards)) {
      EXPECT_EQ(one.state, one.check == check ? state : State::kOk) << one.check << one.text;
    }
    EXPECT_THAT(finding(check).fix, HasSubstr(fix));
    EXPECT_EQ(finding(check).fix.find('\n'), std::string::npos) << "one line";
  }

  std::string root_;
  System system_;
};

TEST_F(Doctor, FindsNothingOnAMachineThatIsWell) {
  EXPECT_TRUE(is_well());
  EXPECT_THAT(finding("port").text, HasSubstr("--target serial:/dev/ttyACM0"));
  EXPECT_THAT(finding("port").text, HasSubstr("parol6"));
}

TEST_F(Doctor, NamesEachPort) {
  plug_in("/dev/ttyACM1");
  EXPECT_EQ(std::ranges::count(examine(system_, kBoards), "port", &Finding::check), 2);
}

TEST_F(Doctor, AdvisesToPlugInABoard) {
  system_.ports.clear();
  expect("port", State::kAdvice, "armjig emulate parol6");
}

TEST_F(Doctor, ABoardThatCannotBeOpenedIsAProblem) {
  remove("/dev/ttyACM0");  // root may read anything but what is not there
  expect("port", State::kProblem, "adduser $USER dialout");
}

TEST_F(Doctor, AnotherPortThatCannotBeOpenedIsNone) {
  remove("/dev/ttyACM0");
  system_.ports.front().usb = std::nullopt;
  expect("port", State::kAdvice, "adduser $USER dialout");
}

TEST_F(Doctor, AdvisesToJoinTheGroup) {
  system_.groups = {"users"};
  expect("group", State::kAdvice, "adduser $USER dialout");
  system_.is_superuser = true;
  EXPECT_TRUE(is_well());
}

TEST_F(Doctor, AdvisesToInstallTheRules) {
  remove("/etc/udev/rules.d");
  expect("udev rules", State::kAdvice, "armjig doctor --udev-rules");
}

TEST_F(Doctor, FindsTheRulesWhereAPackagePutsThem) {
  remove("/etc/udev/rules.d");
  write("/usr/lib/udev/rules.d/60-armjig.rules", "");
  EXPECT_TRUE(is_well());
}

TEST_F(Doctor, WithoutUdevNoRulesAreMissing) {
  remove("/etc/udev/rules.d");
  remove("/run/udev");
  EXPECT_TRUE(is_well());
}

TEST_F(Doctor, ModemManagerIsAProblemOnlyWithoutTheRules) {
  write("/proc/77/comm", "ModemManager");
  EXPECT_TRUE(is_well());
  remove("/etc/udev/rules.d");
  EXPECT_EQ(finding("modem manager").state, State::kProblem);
  EXPECT_THAT(finding("modem manager").fix, HasSubstr("--udev-rules"));
}

TEST_F(Doctor, AdvisesToAllowRealTimePriority) {
  system_.realtime_priority = 0;
  expect("priority", State::kAdvice, "rtprio");
}

TEST_F(Doctor, AdvisesToAllowLockedMemory) {
  system_.locked_memory = 8 << 20;
  expect("memory", State::kAdvice, "memlock");
  EXPECT_THAT(finding("memory").text, HasSubstr("8192 KiB"));
}

TEST_F(Doctor, AdvisesOnAGovernorThatSavesPowerOnAnyCpu) {
  write("/sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "powersave");
  expect("cpu governor", State::kAdvice, "cpupower");
  EXPECT_THAT(finding("cpu governor").text, HasSubstr("powersave"));
}

TEST_F(Doctor, AMachineWithoutGovernorsIsWell) {
  remove("/sys/devices/system/cpu");
  EXPECT_TRUE(is_well());
}

TEST_F(Doctor, AdvisesOnTimersThatMayBeLate) {
  write("/proc/self/timerslack_ns", "40000000");
  expect("timer slack", State::kAdvice, "shell");
  EXPECT_THAT(finding("timer slack").text, HasSubstr("40000 us"));
}

TEST_F(Doctor, WhatCannotBeReadIsNoFinding) {
  remove("/proc");
  EXPECT_TRUE(is_well());
}

TEST_F(Doctor, NoPseudoTerminalsAreAProblem) {
  system_.can_make_ptys = false;
  expect("pseudo-terminals", State::kProblem, "devpts");
}

TEST_F(Doctor, AdvisesToTeachWiresharkOurDevices) {
  EXPECT_TRUE(is_well()) << "it is not installed";
  write("/usr/bin/tshark", "");
  expect("Wireshark", State::kAdvice, "armjig wireshark install");
  system_.home = "/home/user";
  write("/home/user/.local/lib/wireshark/plugins/armjig_parol6.lua", "");
  EXPECT_TRUE(is_well());
  remove("/home");
  write("/usr/lib/x86_64-linux-gnu/wireshark/plugins/other.lua", "");
  EXPECT_FALSE(is_well());
  write("/usr/lib/x86_64-linux-gnu/wireshark/plugins/armjig_parol6.lua", "");
  EXPECT_TRUE(is_well());
}

TEST(DoctorOfThisMachine, AnswersEachCheck) {
  std::set<std::string_view> checks;
  for (const auto& finding : examine(this_system(), kBoards)) {
    checks.insert(finding.check);
    EXPECT_FALSE(finding.text.empty());
    EXPECT_EQ(finding.fix.empty(), finding.state == State::kOk) << finding.check;
  }
  EXPECT_EQ(checks.size(), 10U);
}

TEST(UdevRules, NameEachKnownBoard) {
  for (const auto& board : kBoards) {
    const auto id = to_string(board.usb);
    EXPECT_THAT(udev_rules(kBoards), HasSubstr("ATTRS{idVendor}==\"" + id.substr(0, 4) +
                                               "\", ATTRS{idProduct}==\"" + id.substr(5) + "\""));
    EXPECT_THAT(udev_rules(kBoards), HasSubstr("armjig/" + std::string{board.device}));
  }
}

TEST(UdevRules, ComeBeforeTheOnesThatGiveAccess) {
  EXPECT_LT(kUdevRulesFile, "73-seat-late.rules");
  EXPECT_THAT(udev_rules(kBoards), HasSubstr("TAG+=\"uaccess\""));
  EXPECT_THAT(udev_rules(kBoards),
              ContainsRegex("DEVTYPE.*ATTR.idProduct.==\"5740\".*TAG.=\"uaccess\""))
      << "for usb:";
  // Both pairs of numbers that make_i2c_tiny_usb takes, and the bus of Linux' driver.
  EXPECT_THAT(udev_rules(kBoards),
              HasSubstr("ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"c631\""));
  EXPECT_THAT(udev_rules(kBoards),
              HasSubstr("ATTR{idVendor}==\"1c40\", ATTR{idProduct}==\"0534\""));
  EXPECT_THAT(udev_rules(kBoards), HasSubstr("ATTR{name}==\"i2c-tiny-usb*\", TAG+=\"uaccess\""));
  EXPECT_THAT(udev_rules(kBoards), HasSubstr("ENV{ID_MM_DEVICE_IGNORE}=\"1\""));
}

TEST(AttachedPort, LooksLikeABoardByItsUsbNumbers) {
  auto port = parol6_at("/dev/ttyACM0");
  EXPECT_EQ(device_behind(port, kBoards), "parol6");
  port.usb = UsbId{0x0483, 0x5741};
  EXPECT_EQ(device_behind(port, kBoards), "");
  port.usb = std::nullopt;
  EXPECT_EQ(device_behind(port, kBoards), "");
}

TEST(AttachedPort, IsMeantByItsNumbersAndItsSerialNumber) {
  auto port = parol6_at("/dev/ttyACM0");
  const UsbId id{0x0483, 0x5740};
  EXPECT_TRUE(is_meant(port, {.ids = {id}}));
  EXPECT_TRUE(is_meant(port, {.ids = {id}, .serial_number = "42"}));
  EXPECT_FALSE(is_meant(port, {.ids = {id}, .serial_number = "4"}));
  EXPECT_FALSE(is_meant(port, {.ids = {{0x0483, 0x5741}}, .serial_number = "42"}));
  port.usb = std::nullopt;
  EXPECT_FALSE(is_meant(port, {.ids = {id}}));
}

TEST(AttachedPort, IsDescribedByAllThatIsKnown) {
  auto port = parol6_at("/dev/ttyACM0");
  EXPECT_EQ(describe(port), "STMicroelectronics PAROL6 control board (serial number 42)");
  port.manufacturer = port.serial_number = "";
  EXPECT_EQ(describe(port), "PAROL6 control board");
  port.product = "";
  EXPECT_EQ(describe(port), port.description);
}

}  // namespace
}  // namespace armjig
