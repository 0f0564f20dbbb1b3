// SPDX-License-Identifier: Apache-2.0
#include "emulators/lab/device_nodes.hpp"

#include <fmt/core.h>
#include <sys/stat.h>
#include <umockdev.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <utility>

#include "emulators/lab/client_memory.hpp"
#include "emulators/lab/i2c_adapter.hpp"
#include "emulators/lab/i2c_calls.hpp"
#include "emulators/lab/tty_calls.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDevices = "/sys/devices/";
/// By its name libserialport tells that something is on USB.
constexpr auto kHub = "/sys/devices/usb1";

/// A file that passes for a character device: umockdev takes the sticky bit as its sign.
bool make_node(const fs::path& file) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (!std::ofstream{file}) return false;
  return ::chmod(file.c_str(), S_ISVTX | 0666) == 0;
}

/// A node that leads to a terminal.
bool make_node(const fs::path& file, const std::string& terminal) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  fs::create_symlink(terminal, file, error);
  return !error;
}

}  // namespace

class DeviceNodes::Bed {
 public:
  Bed() : bed_{umockdev_testbed_new()} {}
  Bed(const Bed&) = delete;
  Bed& operator=(const Bed&) = delete;
  ~Bed() {
    for (const auto& [path, calls] : calls_) {
      umockdev_testbed_detach_ioctl(bed_.get(), path.c_str(), nullptr);
    }
  }

  Outcome<std::string> add_bus(int number, Host& host) {
    const auto path = fmt::format("/dev/i2c-{}", number);
    (void)add("i2c-dev", {}, path.substr(path.rfind('/') + 1), {"name", "armjig emulated bus"},
              {"DEVNAME", path});
    if (!make_node(root() + path)) return not_writable(path);
    auto& adapter = adapters_.emplace_back(std::make_unique<I2cAdapter>(host));
    return attach(path, lab::answer_i2c_calls(*adapter));
  }

  Outcome<std::string> add_board(int number, const usb::Identity& identity,
                                 const std::string& terminal) {
    const auto path = path_of_board(number);
    const auto usb =
        add("usb", kHub, usb_name(number),
            {"idVendor", fmt::format("{:04x}", identity.vendor), "idProduct",
             fmt::format("{:04x}", identity.product), "manufacturer", identity.manufacturer,
             "product", identity.product_name, "serial", identity.serial_number, "busnum", "1",
             "devnum", fmt::format("{}", number + 2), "bNumInterfaces", "2"},
            {"DEVTYPE", "usb_device"});
    const auto interface = add("usb", usb, usb_name(number) + ":1.0", {"bInterfaceClass", "02"},
                               {"DEVTYPE", "usb_interface"});
    const auto tty =
        add("tty", interface + "/tty", path.substr(path.rfind('/') + 1), {}, {"DEVNAME", path});
    const auto link = "../../.." + interface.substr(interface.rfind('/'));
    umockdev_testbed_set_attribute_link(bed_.get(), tty.c_str(), "device", link.c_str());
    if (!make_node(root() + path, terminal)) return not_writable(path);
    return attach(path, lab::answer_tty_calls(lines_[number]));
  }

  [[nodiscard]] std::string root() const {
    gchar* text = umockdev_testbed_get_root_dir(bed_.get());
    std::string root = text;
    g_free(text);
    return root;
  }

 private:
  static std::string path_of_board(int number) { return fmt::format("/dev/ttyACM{}", number); }
  /// The port of the hub that it is in.
  static std::string usb_name(int number) { return fmt::format("1-{}", number + 1); }

  static tl::unexpected<Problem> not_writable(const std::string& path) {
    return problem(ErrorCode::kSystem, path, "the test bed is not writable");
  }

  /// An entry in /sys, below `parent` unless that is empty. Its path.
  std::string add(const char* subsystem, const std::string& parent, const std::string& name,
                  std::vector<std::string> attributes, std::vector<std::string> properties) {
    // The library looks for a parent in the /sys of this process, which is another one.
    const auto place = parent.empty() ? name : parent.substr(kDevices.size()) + "/" + name;
    const auto pointers = [](std::vector<std::string>& texts) {
      std::vector<gchar*> all;
      for (auto& text : texts) all.push_back(text.data());
      all.push_back(nullptr);
      return all;
    };
    gchar* path =
        umockdev_testbed_add_devicev(bed_.get(), subsystem, place.c_str(), nullptr,
                                     pointers(attributes).data(), pointers(properties).data());
    std::string added = path == nullptr ? "" : path;
    g_free(path);
    return added;
  }

  Outcome<std::string> attach(const std::string& path, lab::GObjectRef<UMockdevIoctlBase> calls) {
    GError* error = nullptr;
    const bool is_attached =
        umockdev_testbed_attach_ioctl(bed_.get(), path.c_str(), calls.get(), &error) != 0;
    const std::string why = error == nullptr ? "nobody says why" : error->message;
    g_clear_error(&error);
    if (!is_attached) return problem(ErrorCode::kSystem, path, why);
    calls_[path] = std::move(calls);
    return path;
  }

  std::vector<std::unique_ptr<I2cAdapter>> adapters_;
  std::map<int, lab::SerialLines> lines_;  ///< of boards, by number
  lab::GObjectRef<UMockdevTestbed> bed_;
  std::map<std::string, lab::GObjectRef<UMockdevIoctlBase>> calls_;  ///< by path of the node
};

DeviceNodes::DeviceNodes() = default;
DeviceNodes::~DeviceNodes() = default;

DeviceNodes::Bed& DeviceNodes::bed() {
  if (!bed_) bed_ = std::make_unique<Bed>();
  return *bed_;
}

Outcome<std::string> DeviceNodes::add_bus(int number, Host& host) {
  return bed().add_bus(number, host);
}

Outcome<std::string> DeviceNodes::add_board(int number, const usb::Identity& identity,
                                            const std::string& terminal) {
  return bed().add_board(number, identity, terminal);
}

std::vector<std::string> DeviceNodes::environment() const {
  if (!bed_) return {};
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody changes the environment meanwhile
  const char* others = std::getenv("LD_PRELOAD");
  std::string preload = "LD_PRELOAD=libumockdev-preload.so.0";
  if (others != nullptr && *others != '\0') preload += std::string{":"} + others;
  return {"UMOCKDEV_DIR=" + bed_->root(), std::move(preload)};
}

}  // namespace armjig
