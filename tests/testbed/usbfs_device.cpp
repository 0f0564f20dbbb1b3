// SPDX-License-Identifier: Apache-2.0
#include "tests/testbed/usbfs_device.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <linux/usb/ch9.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <vector>

#include "harness/core/bytes.hpp"

namespace armjig::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSetupSize = sizeof(usb_ctrlrequest);
constexpr std::byte kVendorIn{USB_DIR_IN | USB_TYPE_VENDOR | USB_RECIP_INTERFACE};
constexpr std::byte kVendorOut{USB_DIR_OUT | USB_TYPE_VENDOR | USB_RECIP_INTERFACE};
constexpr std::byte kStandardIn{USB_DIR_IN | USB_TYPE_STANDARD | USB_RECIP_DEVICE};
constexpr std::byte kGetDescriptor{USB_REQ_GET_DESCRIPTOR};
constexpr std::uint8_t kStringDescriptor = USB_DT_STRING;
constexpr std::uint8_t kSerialNumberIndex = 1;

template <class Descriptor>
void append(std::vector<std::uint8_t>& bytes, const Descriptor& descriptor) {
  std::array<std::uint8_t, sizeof descriptor> copy{};
  std::memcpy(copy.data(), &descriptor, sizeof descriptor);
  bytes.insert(bytes.end(), copy.begin(), copy.begin() + descriptor.bLength);
}

/// A device and its only configuration: an interface without endpoints.
std::vector<std::uint8_t> descriptors_of(UsbId numbers) {
  std::vector<std::uint8_t> bytes;
  append(bytes, usb_device_descriptor{.bLength = USB_DT_DEVICE_SIZE,
                                      .bDescriptorType = USB_DT_DEVICE,
                                      .bcdUSB = 0x0110,
                                      .bDeviceClass = USB_CLASS_VENDOR_SPEC,
                                      .bMaxPacketSize0 = 8,
                                      .idVendor = numbers.vendor,
                                      .idProduct = numbers.product,
                                      .iSerialNumber = kSerialNumberIndex,
                                      .bNumConfigurations = 1});
  append(bytes, usb_config_descriptor{.bLength = USB_DT_CONFIG_SIZE,
                                      .bDescriptorType = USB_DT_CONFIG,
                                      .wTotalLength = USB_DT_CONFIG_SIZE + USB_DT_INTERFACE_SIZE,
                                      .bNumInterfaces = 1,
                                      .bConfigurationValue = 1,
                                      .bmAttributes = USB_CONFIG_ATT_ONE,
                                      .bMaxPower = 50});
  append(bytes, usb_interface_descriptor{.bLength = USB_DT_INTERFACE_SIZE,
                                         .bDescriptorType = USB_DT_INTERFACE,
                                         .bInterfaceClass = USB_CLASS_VENDOR_SPEC});
  return bytes;
}

struct Unref {
  void operator()(void* object) const noexcept { g_object_unref(object); }
};
/// A copy of memory of the program whose call is answered; null if it has none there.
using Memory = std::unique_ptr<UMockdevIoctlData, Unref>;

Memory behind(UMockdevIoctlData* data, std::size_t offset, std::size_t size) {
  return Memory{umockdev_ioctl_data_resolve(data, offset, size, nullptr)};
}

template <class T>
T load(const UMockdevIoctlData& data) {
  T value;
  std::memcpy(&value, data.data, sizeof value);
  return value;
}

template <class T>
void store(UMockdevIoctlData& data, std::size_t offset, T value) {
  umockdev_ioctl_data_update(&data, offset, reinterpret_cast<guint8*>(&value), sizeof value);
}

}  // namespace

UsbfsDevice::UsbfsDevice(const UsbBench& bench, const Identity& identity, UsbControl& control)
    : bench_{bench},
      identity_{identity},
      control_{control},
      node_{fmt::format("/dev/bus/usb/001/{:03}", identity.number)},
      ioctls_{umockdev_ioctl_base_new()} {
  g_signal_connect(ioctls_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
  const auto number = fmt::format("{}\n", identity.number);
  const auto vendor = fmt::format("{:04x}\n", identity.numbers.vendor);
  const auto product = fmt::format("{:04x}\n", identity.numbers.product);
  entry_ = bench.add("usb", fmt::format("1-{}", identity.number), nullptr,
                     {"busnum", "1\n", "devnum", number.c_str(), "idVendor", vendor.c_str(),
                      "idProduct", product.c_str(), "speed", "1.5\n", "bConfigurationValue", "1\n"},
                     {"DEVTYPE", "usb_device", "DEVNAME", node_.c_str()});
  auto descriptors = descriptors_of(identity.numbers);
  umockdev_testbed_set_attribute_binary(bench.bed(), entry_.c_str(), "descriptors",
                                        descriptors.data(), static_cast<int>(descriptors.size()));
  fs::create_directories(fs::path{file()}.parent_path());
  EXPECT_TRUE(std::ofstream{file()}.is_open());
  ::chmod(file().c_str(), S_ISVTX | 0666);  // umockdev takes the sticky bit for a device's sign
  EXPECT_TRUE(umockdev_testbed_attach_ioctl(bench.bed(), node_.c_str(), ioctls_, nullptr));
}

UsbfsDevice::~UsbfsDevice() {
  if (!is_gone_) pull_out();
  umockdev_testbed_detach_ioctl(bench_.bed(), node_.c_str(), nullptr);
  g_signal_handlers_disconnect_by_data(ioctls_, this);
  g_object_unref(ioctls_);
}

void UsbfsDevice::pull_out() {
  {
    const std::lock_guard lock{guard_};
    is_gone_ = true;
  }
  umockdev_testbed_uevent(bench_.bed(), entry_.c_str(), "remove");
  umockdev_testbed_remove_device(bench_.bed(), entry_.c_str());
  fs::remove(file());
}

void UsbfsDevice::end_transfers_with(int error) {
  const std::lock_guard lock{guard_};
  error_ = error;
}

void UsbfsDevice::fall_silent() {
  const std::lock_guard lock{guard_};
  is_silent_ = true;
}

std::string UsbfsDevice::file() const { return bench_.root() + node_; }

gboolean UsbfsDevice::on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client,
                               gpointer device) {
  const int error = static_cast<UsbfsDevice*>(device)->answer(client);
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
  return TRUE;
}

int UsbfsDevice::answer(UMockdevIoctlClient* client) {
  const std::lock_guard lock{guard_};
  if (is_gone_) return ENODEV;
  auto* argument = umockdev_ioctl_client_get_arg(client);
  switch (umockdev_ioctl_client_get_request(client)) {
    case USBDEVFS_GET_CAPABILITIES: {
      const auto capabilities = behind(argument, 0, sizeof(std::uint32_t));
      if (!capabilities) return EFAULT;
      store(*capabilities, 0, std::uint32_t{0});
      return 0;
    }
    case USBDEVFS_CLAIMINTERFACE:
      if (is_claimed_) return EBUSY;
      is_claimed_ = true;
      return 0;
    case USBDEVFS_RELEASEINTERFACE:
      is_claimed_ = false;
      return 0;
    case USBDEVFS_SUBMITURB:
      return submit(argument);
    case USBDEVFS_CONTROL:
      return write_at_once(argument);
    case USBDEVFS_DISCARDURB:
      return discard(argument);
    case USBDEVFS_REAPURBNDELAY:
      return reap(argument);
    default:
      return ENOTTY;
  }
}

/// What is submitted is done at once; only that it ended is told later.
int UsbfsDevice::submit(UMockdevIoctlData* argument) {
  const auto urb = behind(argument, 0, sizeof(usbdevfs_urb));
  if (!urb) return EFAULT;
  const auto request = load<usbdevfs_urb>(*urb);
  const auto size = static_cast<std::size_t>(request.buffer_length);
  if (request.type != USBDEVFS_URB_TYPE_CONTROL || size < kSetupSize) return EINVAL;
  const auto buffer = behind(urb.get(), offsetof(usbdevfs_urb, buffer), size);
  if (!buffer) return EFAULT;
  if (is_silent_) return 0;
  std::vector<std::byte> bytes(size);
  std::memcpy(bytes.data(), buffer->data, size);
  const int moved = error_ != 0 ? -error_ : transfer(bytes);
  umockdev_ioctl_data_update(buffer.get(), 0, reinterpret_cast<guint8*>(bytes.data()),
                             request.buffer_length);
  store(*urb, offsetof(usbdevfs_urb, status), std::min(moved, 0));
  store(*urb, offsetof(usbdevfs_urb, actual_length), std::max(moved, 0));
  ended_.push_back(urb->client_addr);
  return 0;
}

/// Without libusb.
int UsbfsDevice::write_at_once(UMockdevIoctlData* argument) {
  const auto call = behind(argument, 0, sizeof(usbdevfs_ctrltransfer));
  if (!call) return EFAULT;
  const auto setup = load<usbdevfs_ctrltransfer>(*call);
  const auto data = behind(call.get(), offsetof(usbdevfs_ctrltransfer, data), setup.wLength);
  if (!data) return EFAULT;
  if (std::byte{setup.bRequestType} != kVendorOut) return EPIPE;
  std::vector<std::byte> bytes(setup.wLength);
  std::memcpy(bytes.data(), data->data, bytes.size());
  return control_.write({setup.bRequest, setup.wValue, setup.wIndex}, bytes) ? 0 : EPIPE;
}

int UsbfsDevice::discard(UMockdevIoctlData* argument) {
  const auto urb = behind(argument, 0, sizeof(usbdevfs_urb));
  if (!urb) return EFAULT;
  if (std::ranges::find(ended_, urb->client_addr) != ended_.end()) return EINVAL;
  store(*urb, offsetof(usbdevfs_urb, status), -ENOENT);
  ended_.push_back(urb->client_addr);
  return 0;
}

int UsbfsDevice::reap(UMockdevIoctlData* argument) {
  if (ended_.empty()) return EAGAIN;
  const auto place = behind(argument, 0, sizeof(gulong));
  if (!place) return EFAULT;
  store(*place, 0, ended_.front());
  ended_.pop_front();
  return 0;
}

int UsbfsDevice::transfer(std::span<std::byte> setup_and_data) {
  const auto setup = setup_and_data.first<kSetupSize>();
  const UsbRequest request{std::to_integer<std::uint8_t>(setup[1]),
                           load_u16_le(setup.subspan<2, 2>()), load_u16_le(setup.subspan<4, 2>())};
  const auto length = load_u16_le(setup.subspan<6, 2>());
  const auto data = setup_and_data.subspan(kSetupSize);
  if (length != data.size()) return -EINVAL;
  if (setup[0] == kStandardIn && setup[1] == kGetDescriptor &&
      request.value >> 8U == kStringDescriptor) {
    return read_string(static_cast<std::uint8_t>(request.value), data);
  }
  if (setup[0] != kVendorIn && setup[0] != kVendorOut) return -EPIPE;
  const auto moved =
      setup[0] == kVendorIn ? control_.read(request, data) : control_.write(request, data);
  return moved ? static_cast<int>(*moved) : -EPIPE;
}

int UsbfsDevice::read_string(std::uint8_t index, std::span<std::byte> into) const {
  std::vector<std::byte> units;
  if (index == 0) units = {std::byte{0x09}, std::byte{0x04}};  // there is US English only
  if (index == kSerialNumberIndex) {
    for (const char letter : identity_.serial_number) {
      units.insert(units.end(), {static_cast<std::byte>(letter), std::byte{}});  // UTF-16LE
    }
  }
  if (units.empty()) return -EPIPE;
  std::vector descriptor{static_cast<std::byte>(units.size() + 2), std::byte{kStringDescriptor}};
  descriptor.insert(descriptor.end(), units.begin(), units.end());
  const auto size = std::min(descriptor.size(), into.size());
  std::copy_n(descriptor.begin(), size, into.begin());
  return static_cast<int>(size);
}

}  // namespace armjig::testing
