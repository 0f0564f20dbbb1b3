// SPDX-License-Identifier: Apache-2.0
#include "tests/testbed/usb_bench.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace armjig::testing {
namespace {

namespace fs = std::filesystem;

}  // namespace

UsbBench::UsbBench() : bed_{umockdev_testbed_new()} {}

UsbBench::~UsbBench() {
  ports_.clear();
  g_object_unref(bed_);
}

void UsbBench::plug_in(const Board& board, const std::string& terminal) {
  const auto usb = add("usb", "usb-of-" + board.name, nullptr,
                       {"idVendor", board.vendor.c_str(), "idProduct", board.product.c_str(),
                        "manufacturer", "STMicroelectronics", "product", "PAROL6 control board",
                        "serial", board.serial_number.c_str(), "busnum", "1", "devnum", "7"},
                       {"DEVTYPE", "usb_device"});
  const auto interface = add("usb", "interface-of-" + board.name, usb.c_str(),
                             {"bInterfaceClass", "02"}, {"DEVTYPE", "usb_interface"});
  const auto node = "/dev/" + board.name;
  const auto tty = add("tty", board.name, interface.c_str(), {}, {"DEVNAME", node.c_str()});
  umockdev_testbed_set_attribute_link(bed_, tty.c_str(), "device", "..");
  link(node, terminal);
  auto& port = ports_[node];
  port.calls = lab::answer_tty_calls(port.lines);
  ASSERT_TRUE(umockdev_testbed_attach_ioctl(bed_, node.c_str(), port.calls.get(), nullptr));
}

void UsbBench::pull_out(const Board& board) {
  ASSERT_TRUE(umockdev_testbed_detach_ioctl(bed_, ("/dev/" + board.name).c_str(), nullptr));
  const auto usb = "/sys/devices/usb-of-" + board.name;
  const auto interface = usb + "/interface-of-" + board.name;
  for (const auto& path : {interface + "/" + board.name, interface, usb}) {
    umockdev_testbed_remove_device(bed_, path.c_str());
  }
  fs::remove(root() + "/dev/" + board.name);
}

std::string UsbBench::add(const char* subsystem, const std::string& name, const char* parent,
                          std::vector<const char*> attributes,
                          std::vector<const char*> properties) const {
  attributes.push_back(nullptr);
  properties.push_back(nullptr);
  gchar* path = umockdev_testbed_add_devicev(bed_, subsystem, name.c_str(), parent,
                                             const_cast<gchar**>(attributes.data()),
                                             const_cast<gchar**>(properties.data()));
  std::string added = path == nullptr ? "" : path;
  g_free(path);
  return added;
}

std::string UsbBench::root() const {
  gchar* text = umockdev_testbed_get_root_dir(bed_);
  std::string root = text;
  g_free(text);
  return root;
}

void UsbBench::link(const std::string& path, const std::string& to) const {
  const fs::path place{root() + path};
  fs::create_directories(place.parent_path());
  fs::remove(place);
  fs::create_symlink(to, place);
}

std::uint32_t UsbBench::baud_of(const std::string& path) const {
  const auto port = ports_.find(path);
  return port == ports_.end() ? 0 : port->second.lines.baud.load();
}

}  // namespace armjig::testing
