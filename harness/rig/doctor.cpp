// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/doctor.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <grp.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): POSIX, posix_openpt
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>

#include "harness/link/descriptor.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;
using State = Finding::State;
using Boards = std::span<const KnownBoard>;

constexpr std::string_view kUdevHead =
    R"(# SPDX-License-Identifier: Apache-2.0
# Boards that armjig knows: the user at the desk may open them, ModemManager leaves them alone, and
# they have a name that does not depend on what was plugged in first. A board with the numbers of
# its chip's maker looks like others with that chip.
# The number is below 73, where udev turns the tag into permissions.
ACTION=="remove", GOTO="armjig_end"
)";
/// Of the device, its vendor and its product.
constexpr std::string_view kUdevBoard = R"(
# {0}
SUBSYSTEM=="usb", ENV{{DEVTYPE}}=="usb_device", ATTR{{idVendor}}=="{1:04x}", ATTR{{idProduct}}=="{2:04x}", ENV{{ID_MM_DEVICE_IGNORE}}="1", TAG+="uaccess"
SUBSYSTEM=="tty", KERNEL=="ttyACM*", ATTRS{{idVendor}}=="{1:04x}", ATTRS{{idProduct}}=="{2:04x}", ENV{{ID_MM_DEVICE_IGNORE}}="1", TAG+="uaccess", SYMLINK+="armjig/{0}-$attr{{serial}}"
)";
/// The family has two pairs of numbers.
constexpr std::string_view kUdevAdapters = R"(
# I2C adapters: without a driver (i2c-tiny-usb:), and the bus that the kernel makes of one (i2c:)
SUBSYSTEM=="usb", ENV{DEVTYPE}=="usb_device", ATTR{idVendor}=="0403", ATTR{idProduct}=="c631", TAG+="uaccess"
SUBSYSTEM=="usb", ENV{DEVTYPE}=="usb_device", ATTR{idVendor}=="1c40", ATTR{idProduct}=="0534", TAG+="uaccess"
SUBSYSTEM=="i2c-dev", ATTR{name}=="i2c-tiny-usb*", TAG+="uaccess"
)";
constexpr std::string_view kUdevTail = R"(
LABEL="armjig_end"
)";

constexpr auto kGroup = "dialout";
constexpr auto kJoinGroup = "sudo adduser $USER dialout, then log in again";
constexpr auto kInstallRules =
    "armjig doctor --udev-rules | sudo tee /etc/udev/rules.d/60-armjig.rules; "
    "sudo udevadm control --reload; plug the board in again";
constexpr std::uint64_t kEnoughMemory = std::uint64_t{64} << 20;
constexpr std::uint64_t kUsualSlackNs = 50'000;

// Reading.

/// The first line; empty if the file cannot be read.
std::string first_line(const fs::path& path) {
  std::ifstream file{path};
  std::string line;
  std::getline(file, line);
  return line;
}

/// The names in a folder; none if it cannot be read.
std::vector<std::string> entries(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it{folder, error}, end; !error && it != end; it.increment(error)) {
    names.push_back(it->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool is_running(const System& system, std::string_view program) {
  const fs::path processes{system.root + "/proc"};
  return std::ranges::any_of(entries(processes), [&](const std::string& name) {
    return first_line(processes / name / "comm") == program;
  });
}

bool has_rules(const System& system) {
  constexpr std::array kFolders{"/etc/udev/rules.d", "/run/udev/rules.d", "/usr/lib/udev/rules.d",
                                "/lib/udev/rules.d"};
  return std::ranges::any_of(kFolders, [&system](const std::string& folder) {
    return is_there(fs::path{system.root + folder} / kUdevRulesFile);
  });
}

// The checks. Each answers for one thing.

Finding check_port(const System& system, const SerialPort& port, Boards boards) {
  const auto device = device_behind(port, boards);
  const auto what = device.empty() ? fmt::format("{} is at {}", describe(port), port.path)
                                   : fmt::format("{} is at {}, a {} by its USB numbers",
                                                 describe(port), port.path, device);
  if (access_to(system.root + port.path) == FileAccess::kAllowed) {
    return {"port", State::kOk, fmt::format("{}: --target {}", what, target_of(port)), ""};
  }
  const auto state = device.empty() ? State::kAdvice : State::kProblem;
  return {"port", state, fmt::format("{}, and you may not open it", what), kJoinGroup};
}

std::vector<Finding> check_ports(const System& system, Boards boards) {
  std::vector<Finding> findings;
  for (const auto& port : system.ports) findings.push_back(check_port(system, port, boards));
  if (findings.empty()) {
    findings.push_back({"port", State::kAdvice, "no serial port is plugged in",
                        fmt::format("without a board: armjig emulate {}",
                                    boards.empty() ? "DEVICE" : boards.front().device)});
  }
  return findings;
}

Finding check_group(const System& system) {
  const bool is_member = std::ranges::find(system.groups, kGroup) != system.groups.end();
  if (system.is_superuser) return {"group", State::kOk, "root may open every port", ""};
  if (is_member) return {"group", State::kOk, fmt::format("you are in {}", kGroup), ""};
  return {"group", State::kAdvice,
          fmt::format("you are not in {}, to which serial ports belong", kGroup), kJoinGroup};
}

Finding check_rules(const System& system) {
  if (has_rules(system)) {
    return {"udev rules", State::kOk, fmt::format("{} is installed", kUdevRulesFile), ""};
  }
  if (!is_there(system.root + "/run/udev")) {
    return {"udev rules", State::kOk, "udev does not run here, as in a container", ""};
  }
  return {"udev rules", State::kAdvice,
          "boards have no names of their own (/dev/armjig/...), for their rules are not installed",
          kInstallRules};
}

Finding check_modem_manager(const System& system) {
  constexpr auto kProgram = "ModemManager";
  if (!is_running(system, kProgram)) {
    return {"modem manager", State::kOk, "ModemManager does not run", ""};
  }
  if (has_rules(system)) {
    return {"modem manager", State::kOk, "ModemManager runs and leaves our boards alone", ""};
  }
  return {"modem manager", State::kProblem,
          "ModemManager runs and may send modem commands to a board that is plugged in",
          kInstallRules};
}

Finding check_priority(const System& system) {
  if (system.is_superuser || system.realtime_priority > 0) {
    return {"priority", State::kOk, "real-time priority is to be had", ""};
  }
  return {"priority", State::kAdvice,
          "you may not ask for real-time priority, so a busy machine delays frames",
          "echo '@dialout - rtprio 50' | sudo tee /etc/security/limits.d/armjig.conf, then log in "
          "again"};
}

Finding check_memory(const System& system) {
  if (system.is_superuser || system.locked_memory >= kEnoughMemory) {
    return {"memory", State::kOk, "memory can be kept from being swapped out", ""};
  }
  return {"memory", State::kAdvice,
          fmt::format("you may keep only {} KiB of memory from being swapped out",
                      system.locked_memory / 1024),
          "echo '@dialout - memlock unlimited' | sudo tee -a /etc/security/limits.d/armjig.conf, "
          "then log in again"};
}

Finding check_governor(const System& system) {
  const fs::path cpus{system.root + "/sys/devices/system/cpu"};
  std::string slow;
  bool is_known = false;
  for (const auto& name : entries(cpus)) {
    const auto governor = first_line(cpus / name / "cpufreq/scaling_governor");
    is_known = is_known || !governor.empty();
    if (!governor.empty() && governor != "performance") slow = governor;
  }
  if (!is_known) return {"cpu governor", State::kOk, "this machine does not choose its speed", ""};
  if (slow.empty()) return {"cpu governor", State::kOk, "it is performance", ""};
  return {"cpu governor", State::kAdvice,
          fmt::format("it is {}: waking up from rest takes longer", slow),
          "sudo cpupower frequency-set -g performance"};
}

Finding check_slack(const System& system) {
  const auto line = first_line(system.root + "/proc/self/timerslack_ns");
  std::uint64_t slack{};
  const bool is_known =
      std::from_chars(line.data(), line.data() + line.size(), slack).ec == std::errc{};
  if (!is_known) return {"timer slack", State::kOk, "it cannot be read here", ""};
  const auto text = fmt::format("timers may be {} us late", slack / 1000);
  if (slack <= kUsualSlackNs) return {"timer slack", State::kOk, text, ""};
  return {"timer slack", State::kAdvice, text, "start armjig from an ordinary shell"};
}

Finding check_ptys(const System& system) {
  if (system.can_make_ptys) {
    return {"pseudo-terminals", State::kOk, "emulators can be hosted on them", ""};
  }
  return {"pseudo-terminals", State::kProblem, "none is to be had, so 'armjig emulate' needs --tcp",
          "sudo mount -t devpts devpts /dev/pts; in a container, start it with a /dev/pts"};
}

/// The dissectors are the user's own, or all users'.
bool has_dissectors(const System& system) {
  std::vector<fs::path> folders{system.root + system.home + "/.local/lib"};
  for (const auto& name : entries(system.root + "/usr/lib")) {
    folders.push_back(fs::path{system.root + "/usr/lib"} / name);
  }
  return std::ranges::any_of(folders, [](const fs::path& folder) {
    return std::ranges::any_of(entries(folder / "wireshark/plugins"), [](const std::string& name) {
      return name.starts_with("armjig_") && name.ends_with(".lua");
    });
  });
}

Finding check_wireshark(const System& system) {
  const bool is_used =
      is_there(system.root + "/usr/bin/tshark") || is_there(system.root + "/usr/bin/wireshark");
  if (!is_used) return {"Wireshark", State::kOk, "it is not installed", ""};
  if (has_dissectors(system)) return {"Wireshark", State::kOk, "it knows our devices", ""};
  return {"Wireshark", State::kAdvice, "it does not know our devices", "armjig wireshark install"};
}

// This machine.

std::vector<std::string> own_groups() {
  std::vector<gid_t> ids(static_cast<std::size_t>(std::max(::getgroups(0, nullptr), 0)));
  const auto count = ::getgroups(static_cast<int>(ids.size()), ids.data());
  ids.resize(static_cast<std::size_t>(std::max(count, 0)));
  ids.push_back(::getegid());
  std::vector<std::string> names;
  for (const auto id : ids) {
    if (const auto* group = ::getgrgid(id)) names.emplace_back(group->gr_name);
  }
  return names;
}

std::uint64_t limit_of(__rlimit_resource resource) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return 0;
  return limit.rlim_cur == RLIM_INFINITY ? System::kUnlimited : limit.rlim_cur;
}

}  // namespace

System this_system() {
  System system;
  system.ports = list_serial_ports().value_or(std::vector<SerialPort>{});
  system.groups = own_groups();
  system.is_superuser = ::geteuid() == 0;
  const Descriptor master{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)};
  system.can_make_ptys = master.is_open() && ::unlockpt(master.value()) == 0;
  system.realtime_priority = limit_of(RLIMIT_RTPRIO);
  system.locked_memory = limit_of(RLIMIT_MEMLOCK);
  return system;
}

std::string_view to_string(Finding::State state) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"ok", "advice", "problem"};
  return kNames[static_cast<std::size_t>(state)];
}

std::vector<Finding> examine(const System& system, std::span<const KnownBoard> boards) {
  constexpr std::array kChecks{check_group,    check_rules,  check_modem_manager,
                               check_priority, check_memory, check_governor,
                               check_slack,    check_ptys,   check_wireshark};
  auto findings = check_ports(system, boards);
  for (const auto check : kChecks) findings.push_back(check(system));
  return findings;
}

std::string udev_rules(std::span<const KnownBoard> boards) {
  std::string rules{kUdevHead};
  for (const auto& board : boards) {
    rules += fmt::format(kUdevBoard, board.device, board.usb.vendor, board.usb.product);
  }
  rules += kUdevAdapters;
  return rules += kUdevTail;
}

}  // namespace armjig
