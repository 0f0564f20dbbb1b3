// SPDX-License-Identifier: Apache-2.0
// The protocol is described with the kernel (Documentation/usb/usbip_protocol.rst). All numbers are
// big-endian.
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "emulators/host/usb_wire.hpp"

namespace armjig {
namespace {

constexpr std::uint16_t kUsbipVersion = 0x0111;
constexpr std::uint16_t kListRequest = 0x8005;
constexpr std::uint16_t kListReply = 0x0005;
constexpr std::uint16_t kImportRequest = 0x8003;
constexpr std::uint16_t kImportReply = 0x0003;
constexpr std::uint32_t kNotAvailable = 1;
constexpr std::size_t kOperationSize = 8;
constexpr std::size_t kPathSize = 256;
constexpr std::size_t kBusIdSize = 32;

constexpr std::string_view kBusId = "1-1";
constexpr std::uint32_t kBusNumber = 1;
constexpr std::uint32_t kDeviceNumber = 2;

constexpr std::uint32_t kSubmit = 1;
constexpr std::uint32_t kUnlink = 2;
constexpr std::uint32_t kSubmitted = 3;
constexpr std::uint32_t kUnlinked = 4;
constexpr std::size_t kHeaderSize = 48;
constexpr std::uint32_t kNoPackets = 0xFFFF'FFFF;  // as good as 0: not isochronous
constexpr std::uint32_t kLongestTransfer = std::uint32_t{1} << 20U;

// Linux' error numbers, whatever system this runs on.
constexpr std::int32_t kConnectionReset = -104;
std::int32_t linux_status(usb::Status status) noexcept {
  switch (status) {
    case usb::Status::kDone:
      return 0;
    case usb::Status::kCancelled:
      return kConnectionReset;
    case usb::Status::kStalled:
      return -32;  // EPIPE
    case usb::Status::kBabbled:
      return -75;  // EOVERFLOW
    case usb::Status::kInvalid:
      break;
  }
  return -22;  // EINVAL
}

void put_number(std::vector<std::byte>& out, std::uint32_t value, std::size_t size) {
  for (std::size_t i = size; i-- > 0;) out.push_back(static_cast<std::byte>(value >> 8 * i));
}

void put_text(std::vector<std::byte>& out, std::string_view text, std::size_t size) {
  const auto end = out.size() + size;
  for (const char c : text) out.push_back(static_cast<std::byte>(c));
  out.resize(end);
}

/// Reads fields one after the other. Requires that they are there.
class Fields {
 public:
  explicit Fields(Bytes bytes) noexcept : rest_{bytes} {}

  std::uint32_t number(std::size_t size) {
    std::uint32_t value = 0;
    for (const auto byte : take(size)) value = value << 8U | std::to_integer<std::uint32_t>(byte);
    return value;
  }
  Bytes take(std::size_t size) {
    const auto taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

 private:
  Bytes rest_;
};

class UsbipWire final : public UsbWire {
 public:
  UsbipWire(usb::Device& device, Cable cable) : device_{device}, cable_{cable} {}

  bool receive(Instant time, Bytes bytes) override {
    incoming_.insert(incoming_.end(), bytes.begin(), bytes.end());
    std::size_t used = 0;
    while (const auto size = step(time, Bytes{incoming_}.subspan(used))) {
      if (*size == 0) break;
      used += *size;
    }
    incoming_.erase(incoming_.begin(), incoming_.begin() + static_cast<std::ptrdiff_t>(used));
    return !is_broken_;
  }

  void tell(const usb::Completion& completion) override {
    const auto number = static_cast<std::uint32_t>(completion.id);
    if (unlinked_.erase(number) > 0) return;  // that it was unlinked is all there is to say
    put_head(kSubmitted, number);
    put(static_cast<std::uint32_t>(linux_status(completion.status)));
    put(static_cast<std::uint32_t>(completion.size));
    outgoing_.resize(outgoing_.size() + 20);  // of isochronous transfers
    outgoing_.insert(outgoing_.end(), completion.bytes.begin(), completion.bytes.end());
  }

  bool set_cable(Cable cable) override {
    cable_ = cable;
    return cable == Cable::kIn;
  }

 private:
  void put(std::uint32_t value) { put_number(outgoing_, value, 4); }

  /// The bytes of the next message, 0 if it is not all there; none if it is no message.
  std::optional<std::size_t> step(Instant time, Bytes bytes) {
    const auto used = is_imported_ ? step_transfer(time, bytes) : step_operation(bytes);
    if (!used) is_broken_ = true;
    return used;
  }

  // Before a device is imported.

  std::optional<std::size_t> step_operation(Bytes bytes) {
    if (bytes.size() < kOperationSize) return 0;
    Fields fields{bytes};
    const bool is_known = fields.number(2) == kUsbipVersion;
    const auto code = static_cast<std::uint16_t>(fields.number(2));
    if (is_known && code == kListRequest) {
      list();
      return kOperationSize;
    }
    if (!is_known || code != kImportRequest) return std::nullopt;
    if (bytes.size() < kOperationSize + kBusIdSize) return 0;
    import_device(bytes.subspan(kOperationSize, kBusIdSize));
    return kOperationSize + kBusIdSize;
  }

  void put_operation(std::uint16_t code, std::uint32_t status) {
    put_number(outgoing_, kUsbipVersion, 2);
    put_number(outgoing_, code, 2);
    put(status);
  }

  void list() {
    put_operation(kListReply, 0);
    put(cable_ == Cable::kIn ? 1 : 0);
    if (cable_ == Cable::kOut) return;
    put_device();
    for (const auto& interface : device_.description().interfaces) {
      put_code(interface.code);
      put_number(outgoing_, 0, 1);
    }
  }

  void import_device(Bytes bus_id) {
    std::string_view wanted{reinterpret_cast<const char*>(bus_id.data()), bus_id.size()};
    wanted = wanted.substr(0, wanted.find('\0'));
    is_imported_ = cable_ == Cable::kIn && wanted == kBusId;
    put_operation(kImportReply, is_imported_ ? 0 : kNotAvailable);
    if (is_imported_) put_device();
  }

  void put_device() {
    const auto& description = device_.description();
    put_text(outgoing_, "/sys/devices/armjig/1-1", kPathSize);
    put_text(outgoing_, kBusId, kBusIdSize);
    put(kBusNumber);
    put(kDeviceNumber);
    put(description.speed == usb::Speed::kLow ? 1 : 2);
    put_number(outgoing_, description.identity.vendor, 2);
    put_number(outgoing_, description.identity.product, 2);
    put_number(outgoing_, usb::kDeviceVersion, 2);
    put_code(description.code);
    put_number(outgoing_, device_.configuration(), 1);
    put_number(outgoing_, 1, 1);  // configurations
    put_number(outgoing_, static_cast<std::uint32_t>(description.interfaces.size()), 1);
  }

  void put_code(usb::ClassCode code) {
    for (const auto part : {code.main, code.sub, code.protocol}) put_number(outgoing_, part, 1);
  }

  // Afterwards.

  void put_head(std::uint32_t command, std::uint32_t number) {
    put(command);
    put(number);
    outgoing_.resize(outgoing_.size() + 12);  // device, direction, endpoint: said in the request
  }

  std::optional<std::size_t> step_transfer(Instant time, Bytes bytes) {
    if (bytes.size() < kHeaderSize) return 0;
    Fields fields{bytes};
    const auto command = fields.number(4);
    const auto number = fields.number(4);
    (void)fields.number(4);  // the device: there is one
    const bool is_read = fields.number(4) != 0;
    const auto endpoint = fields.number(4);
    if (command == kUnlink) {
      unlink(number, fields.number(4));
      return kHeaderSize;
    }
    if (command != kSubmit || endpoint > 0x0F) return std::nullopt;
    (void)fields.number(4);  // flags of Linux
    const auto length = fields.number(4);
    (void)fields.number(4);
    const auto packets = fields.number(4);
    (void)fields.number(4);
    if (length > kLongestTransfer || (packets != 0 && packets != kNoPackets)) return std::nullopt;
    const auto setup = setup_in(fields.take(8));
    const auto data = is_read ? std::size_t{0} : std::size_t{length};
    if (bytes.size() < kHeaderSize + data) return 0;
    const auto sent = fields.take(data);
    device_.submit(time,
                   {.id = number,
                    .endpoint = static_cast<std::uint8_t>(endpoint | (is_read ? usb::kIn : 0)),
                    .setup = setup,
                    .room = is_read ? length : 0,
                    .bytes = {sent.begin(), sent.end()}});
    return kHeaderSize + data;
  }

  /// As it is on the wire of USB: little-endian.
  static usb::Setup setup_in(Bytes bytes) {
    const auto at = [bytes](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
    const auto word = [at](std::size_t i) {
      return static_cast<std::uint16_t>(at(i) | at(i + 1) << 8U);
    };
    return {static_cast<std::uint8_t>(at(0)), static_cast<std::uint8_t>(at(1)), word(2), word(4),
            word(6)};
  }

  void unlink(std::uint32_t number, std::uint32_t unlinked) {
    const bool is_cancelled = device_.cancel(unlinked);
    if (is_cancelled) unlinked_.insert(unlinked);
    put_head(kUnlinked, number);
    put(static_cast<std::uint32_t>(is_cancelled ? kConnectionReset : 0));
    outgoing_.resize(outgoing_.size() + 24);
  }

  usb::Device& device_;
  Cable cable_;
  std::vector<std::byte> incoming_;
  std::set<std::uint32_t> unlinked_;  ///< whose end nobody asks for any more
  bool is_imported_ = false;
  bool is_broken_ = false;
};

}  // namespace

std::unique_ptr<UsbWire> make_usbip_wire(usb::Device& device, Cable cable) {
  return std::make_unique<UsbipWire>(device, cable);
}

}  // namespace armjig
