// SPDX-License-Identifier: Apache-2.0
#include "cli/lab_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "emulators/host/paced_clock.hpp"
#include "harness/config/toml_table.hpp"

namespace armjig::cli {
namespace {

constexpr std::int64_t kLastPort = 65'535;
constexpr int kLastNode = 255;
constexpr std::size_t kLongestName = 64;

bool is_name(std::string_view text) noexcept {
  const auto is_fine = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !text.empty() && text.size() <= kLongestName && std::ranges::all_of(text, is_fine);
}

/// Reads the devices of a lab one after the other; what is wrong is noted in the table.
class LabReader {
 public:
  explicit LabReader(Devices devices) : devices_{devices} {}

  [[nodiscard]] Outcome<std::vector<LabDevice>> read(TomlTable file) {
    auto tables = file.tables("device");
    if (tables.empty()) file.complain("device", "write [[device]], and its keys below it");
    for (auto& table : tables) read_device(table);
    for (std::size_t i = 0; i < lab_.size(); ++i) give_usual_place(lab_[i], tables[i]);
    return file.finish().map([this] { return std::move(lab_); });
  }

 private:
  void read_device(TomlTable& table) {
    auto& device = lab_.emplace_back();
    device.where = table.where();
    read_identity(table, device);
    read_places(table, device);
    read_link(table, device);
    read_capture(table, device);
    if (device.device == nullptr) return;  // noted
    std::visit([&](const auto& kind) { refuse_places(kind, table, device); }, device.device->port);
  }

  void read_identity(TomlTable& table, LabDevice& device) {
    const auto kind = table.text("device");
    const auto found = find_device(devices_, kind.value_or(""));
    if (!found) {
      table.complain("device",
                     kind ? fmt::format("there is no device '{}'; {}", *kind, found.error().hint)
                          : "device is missing: say which one it is");
    }
    device.device = found ? *found : nullptr;
    device.name = table.text("name").value_or(kind.value_or(""));
    if (!is_name(device.name) && found) {
      table.complain("name", "name has to be of 1 to 64 letters, digits, - and _");
    }
    if (!names_.insert(device.name).second) {
      table.complain("name", fmt::format("there is another device '{}': give each a name of its "
                                         "own",
                                         device.name));
    }
    auto target = parse_target(table.text("target").value_or("emulated:"));
    if (!target) {
      return table.complain("target", describe(target.error()));
    }
    device.target = *std::move(target);
  }

  void read_places(TomlTable& table, LabDevice& device) {
    auto& places = device.places;
    if (auto link = table.text("pty")) {
      claim(table, "pty", *link, device);
      places.pty = PtyOptions{*std::move(link)};
    }
    places.bind = table.text("bind").value_or("");
    places.tcp = port(table, "tcp", device, places.bind);
    places.rfc2217 = port(table, "rfc2217", device, places.bind);
    places.usbip = port(table, "usbip", device, "");
    places.usb_socket = table.text("usb").value_or("");
    claim(table, "usb", places.usb_socket, device);
    places.usb_serial = table.text("usb_serial").value_or("");
    if (!is_usb_text(places.usb_serial)) {
      table.complain("usb_serial", fmt::format("usb_serial has to be {}", kUsbText));
    }
    places.board = node(table, "ttyACM", "/dev/ttyACM", device);
    places.bus = node(table, "i2c", "/dev/i2c-", device);
    if (!places.bind.empty() && !places.tcp && !places.rfc2217) {
      table.complain("bind", "bind is for tcp and rfc2217");
    }
  }

  void read_link(TomlTable& table, LabDevice& device) {
    device.speed = table.number("speed").value_or(1);
    if (!PacedClock::is_speed(device.speed)) {
      table.complain("speed", "speed has to be a number from 0.001 to 10000");
    }
    if (device.speed != 1 && !device.target.is_emulated()) {
      table.complain("speed", "the time of a device that is not emulated is its own");
    }
    if (const auto text = table.text("impair")) {
      if (!device.target.is_emulated()) {
        table.complain("impair",
                       "a flipped bit could make a device move that is not emulated, and "
                       "here is no guard");
      }
      auto impairment = parse_impairment(*text);
      if (!impairment) return table.complain("impair", describe(impairment.error()));
      device.impairment = *impairment;
    }
  }

  void read_capture(TomlTable& table, LabDevice& device) {
    device.capture.file = table.text("capture").value_or("");
    device.capture.rotate = table.text("rotate").value_or("");
    device.capture.is_redacted = table.boolean("redact").value_or(false);
    claim(table, "capture", device.capture.file, device);
    for (const auto key : {"rotate", "redact"}) {
      if (device.capture.file.empty() && table.has(key)) {
        table.complain(key, "nothing is recorded: say capture = \"FILE\"");
      }
    }
    device.wants_check = table.boolean("check").value_or(false);
    if (device.wants_check && device.device != nullptr && !device.device->program_check) {
      table.complain("check",
                     fmt::format("nothing is demanded of programs for {}", device.device->name));
    }
  }

  /// A TCP port; 0 is any.
  std::optional<std::uint16_t> port(TomlTable& table, std::string_view key, const LabDevice& device,
                                    const std::string& address) {
    const auto number = table.integer(key, 0, kLastPort);
    if (!number) return std::nullopt;
    if (*number != 0) {
      claim(table, key,
            fmt::format("TCP port {}{}{}", address, address.empty() ? "" : ":", *number), device);
    }
    return static_cast<std::uint16_t>(*number);
  }

  std::optional<int> node(TomlTable& table, std::string_view key, std::string_view path,
                          const LabDevice& device) {
    const auto number = table.integer(key, 0, kLastNode);
    if (!number) return std::nullopt;
    claim(table, key, fmt::format("{}{}", path, *number), device);
    return static_cast<int>(*number);
  }

  /// Complains if another device has that place.
  void claim(TomlTable& table, std::string_view key, const std::string& place,
             const LabDevice& device) {
    if (place.empty()) return;
    const auto [owner, is_free] = places_.try_emplace(place, device.name);
    if (!is_free) table.complain(key, fmt::format("'{}' is at {} already", owner->second, place));
  }

  // Places that are not for its kind of port.

  static void refuse(TomlTable& table, std::initializer_list<std::string_view> keys,
                     std::string_view why) {
    for (const auto key : keys) {
      if (table.has(key)) table.complain(key, fmt::format("{} is not for {}", key, why));
    }
  }
  static void refuse_places(const OnStream& /*kind*/, TomlTable& table, const LabDevice& device) {
    refuse(table, {"i2c"}, "a byte stream: it has pty, tcp, rfc2217, usb, usbip, ttyACM");
    if (!device.places.usb_serial.empty() && !device.places.is_on_usb() && !device.places.board &&
        has_place(device.places)) {
      table.complain("usb_serial", "usb_serial is for usb, usbip and ttyACM");
    }
  }
  static void refuse_places(const OnServer& /*kind*/, TomlTable& table,
                            const LabDevice& /*device*/) {
    refuse(table, {"pty", "rfc2217", "usb", "usbip", "usb_serial", "ttyACM", "i2c"},
           "a TCP server: it has tcp");
  }
  static void refuse_places(const OnBus& /*kind*/, TomlTable& table, const LabDevice& device) {
    refuse(table, {"pty", "tcp", "rfc2217", "bind", "ttyACM", "speed"},
           "a bus: it has i2c, usb, usbip");
    if (!device.target.is_emulated()) {
      table.complain("target",
                     "of a bus only an emulated one can be served, for adapters do whole "
                     "transactions only");
    }
    if (!device.places.usb_serial.empty() && !device.places.is_on_usb()) {
      table.complain("usb_serial", "usb_serial is for usb and usbip");
    }
  }

  // Where programs look for a device of which nothing is said.

  [[nodiscard]] static bool has_place(const Places& places) noexcept {
    return places.is_of_stream() || places.tcp || places.is_on_usb() || places.bus;
  }
  [[nodiscard]] int free_node(std::string_view path, int number, const LabDevice& device) {
    while (!places_.try_emplace(fmt::format("{}{}", path, number), device.name).second) ++number;
    return number;
  }
  void give_usual_place(LabDevice& device, TomlTable& table) {
    if (device.device == nullptr || has_place(device.places)) return;
    const auto& port = device.device->port;
    if (std::holds_alternative<OnStream>(port)) {
      device.places.board = free_node("/dev/ttyACM", 0, device);
    } else if (std::holds_alternative<OnBus>(port)) {
      device.places.bus = free_node("/dev/i2c-", 1, device);
    } else {
      const auto usual = std::get<OnServer>(port).tcp_port;
      claim(table, "device", fmt::format("TCP port {}", usual), device);
      device.places.tcp = usual;
    }
  }

  Devices devices_;
  std::vector<LabDevice> lab_;
  std::set<std::string, std::less<>> names_;
  std::map<std::string, std::string, std::less<>> places_;  ///< who is there
};

}  // namespace

Outcome<std::vector<LabDevice>> read_lab(const std::string& path, Devices devices) {
  return TomlTable::read(path).and_then(
      [&](TomlTable file) { return LabReader{devices}.read(std::move(file)); });
}

Outcome<std::vector<LabDevice>> parse_lab(std::string_view text, std::string path,
                                          Devices devices) {
  return TomlTable::parse(text, std::move(path)).and_then([&](TomlTable file) {
    return LabReader{devices}.read(std::move(file));
  });
}

}  // namespace armjig::cli
