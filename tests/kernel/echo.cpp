// SPDX-License-Identifier: Apache-2.0
// echo SOCKET VID PID ANSWER: a serial port on USB over usbredir that gives the same ANSWER
// (hexadecimal) to each transfer, at once. It has no device behind it, no clock and no other
// clients: what a round trip takes here, the wire, QEMU and the guest take.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <usbredirparser.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <vector>

#include "emulators/usb/cdc_acm.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

struct DestroyEchoParser {
  void operator()(usbredirparser* parser) const noexcept { usbredirparser_destroy(parser); }
};

class Echo {
 public:
  Echo(int socket, const usb::Description& description, std::vector<std::byte> answer)
      : socket_{socket},
        description_{description},
        answer_{std::move(answer)},
        parser_{usbredirparser_create()} {
    set_callbacks();
    std::uint32_t capabilities[USB_REDIR_CAPS_SIZE] = {};
    for (const int one : {usb_redir_cap_connect_device_version, usb_redir_cap_device_disconnect_ack,
                          usb_redir_cap_ep_info_max_packet_size, usb_redir_cap_64bits_ids,
                          usb_redir_cap_32bits_bulk_length}) {
      usbredirparser_caps_set_cap(capabilities, one);
    }
    usbredirparser_init(parser_.get(), "echo", capabilities, USB_REDIR_CAPS_SIZE,
                        usbredirparser_fl_usb_host);
  }

  /// Until the client goes.
  void run() {
    do {
      usbredirparser_do_write(parser_.get());
    } while (flush() && usbredirparser_do_read(parser_.get()) == 0);
  }

 private:
  static Echo& of(void* self) { return *static_cast<Echo*>(self); }

  void set_callbacks() {
    auto& parser = *parser_;
    parser.priv = this;
    parser.log_func = [](void* /*self*/, int /*level*/, const char* /*line*/) {};
    // One read takes what has come; the library asks again for what is still missing.
    parser.read_func = [](void* self, std::uint8_t* data, int count) {
      return of(self).read(data, count);
    };
    parser.write_func = [](void* self, std::uint8_t* data, int count) {
      of(self).outgoing_.insert(of(self).outgoing_.end(), reinterpret_cast<std::byte*>(data),
                                reinterpret_cast<std::byte*>(data) + count);
      return count;
    };
    parser.hello_func = [](void* self, usb_redir_hello_header* /*hello*/) { of(self).connect(); };
    parser.reset_func = [](void* /*self*/) {};
    parser.device_disconnect_ack_func = [](void* /*self*/) {};
    parser.cancel_data_packet_func = [](void* self, std::uint64_t id) { of(self).cancel(id); };
    parser.set_configuration_func = [](void* self, std::uint64_t id,
                                       usb_redir_set_configuration_header* asked) {
      usb_redir_configuration_status_header header{usb_redir_success, asked->configuration};
      usbredirparser_send_configuration_status(of(self).parser_.get(), id, &header);
    };
    parser.set_alt_setting_func = [](void* self, std::uint64_t id,
                                     usb_redir_set_alt_setting_header* asked) {
      usb_redir_alt_setting_status_header header{usb_redir_success, asked->interface, 0};
      usbredirparser_send_alt_setting_status(of(self).parser_.get(), id, &header);
    };
    parser.start_interrupt_receiving_func = [](void* self, std::uint64_t id,
                                               usb_redir_start_interrupt_receiving_header* asked) {
      of(self).tell_interrupts(id, asked->endpoint);
    };
    parser.stop_interrupt_receiving_func = [](void* self, std::uint64_t id,
                                              usb_redir_stop_interrupt_receiving_header* asked) {
      of(self).tell_interrupts(id, asked->endpoint);
    };
    parser.control_packet_func = [](void* self, std::uint64_t id,
                                    usb_redir_control_packet_header* header, std::uint8_t* data,
                                    int /*size*/) {
      usbredirparser_free_packet_data(of(self).parser_.get(), data);
      of(self).on_control(id, *header);
    };
    parser.bulk_packet_func = [](void* self, std::uint64_t id, usb_redir_bulk_packet_header* header,
                                 std::uint8_t* data, int /*size*/) {
      usbredirparser_free_packet_data(of(self).parser_.get(), data);
      of(self).on_bulk(id, *header);
    };
  }

  /// Waits for the first bytes of a packet only, for then the library asks until there are none.
  int read(std::uint8_t* data, int count) {
    const auto size =
        ::recv(socket_, data, static_cast<std::size_t>(count), has_read_ ? MSG_DONTWAIT : 0);
    has_read_ = size > 0;
    if (size > 0) return static_cast<int>(size);
    return size < 0 && errno == EAGAIN ? 0 : -1;
  }

  /// All at once, for QEMU wakes up for each.
  bool flush() {
    Bytes rest{outgoing_};
    while (!rest.empty()) {
      const auto size = ::send(socket_, rest.data(), rest.size(), MSG_NOSIGNAL);
      if (size < 0) return false;
      rest = rest.subspan(static_cast<std::size_t>(size));
    }
    outgoing_.clear();
    return true;
  }

  void connect() {
    usb_redir_interface_info_header interfaces{};
    usb_redir_ep_info_header endpoints{};
    std::memset(endpoints.type, usb_redir_type_invalid, sizeof endpoints.type);
    endpoints.type[0] = endpoints.type[16] = usb_redir_type_control;
    endpoints.max_packet_size[0] = endpoints.max_packet_size[16] = description_.control_packet_size;
    for (const auto& interface : description_.interfaces) {
      const auto i = interfaces.interface_count++;
      interfaces.interface[i] = static_cast<std::uint8_t>(i);
      interfaces.interface_class[i] = interface.code.main;
      interfaces.interface_subclass[i] = interface.code.sub;
      interfaces.interface_protocol[i] = interface.code.protocol;
      for (const auto& endpoint : interface.endpoints) {
        const auto place = (usb::is_in(endpoint.address) ? 16U : 0U) + (endpoint.address & 0x0FU);
        endpoints.type[place] = static_cast<std::uint8_t>(endpoint.kind);
        endpoints.interval[place] = endpoint.interval;
        endpoints.interface[place] = static_cast<std::uint8_t>(i);
        endpoints.max_packet_size[place] = endpoint.packet_size;
      }
    }
    usbredirparser_send_interface_info(parser_.get(), &interfaces);
    usbredirparser_send_ep_info(parser_.get(), &endpoints);
    usb_redir_device_connect_header header{.speed = usb_redir_speed_full,
                                           .device_class = description_.code.main,
                                           .device_subclass = description_.code.sub,
                                           .device_protocol = description_.code.protocol,
                                           .vendor_id = description_.identity.vendor,
                                           .product_id = description_.identity.product,
                                           .device_version_bcd = usb::kDeviceVersion};
    usbredirparser_send_device_connect(parser_.get(), &header);
  }

  void tell_interrupts(std::uint64_t id, std::uint8_t endpoint) {
    usb_redir_interrupt_receiving_status_header header{usb_redir_success, endpoint};
    usbredirparser_send_interrupt_receiving_status(parser_.get(), id, &header);
  }

  /// Descriptors; everything else is taken and has no effect.
  void on_control(std::uint64_t id, usb_redir_control_packet_header header) {
    std::vector<std::byte> bytes;
    constexpr unsigned kGetDescriptor = 6;
    if (header.requesttype == usb::kIn && header.request == kGetDescriptor) {
      const auto index = static_cast<std::uint8_t>(header.value);
      switch (header.value >> 8U) {
        case 1:
          bytes = usb::device_descriptor(description_);
          break;
        case 2:
          bytes = usb::configuration_descriptor(description_);
          break;
        case 3:
          bytes = usb::string_descriptor(description_, index).value_or(std::vector<std::byte>{});
          break;
        default:
          break;
      }
      header.status = bytes.empty() ? usb_redir_stall : usb_redir_success;
    } else {
      header.status = usb_redir_success;
    }
    if (usb::is_in(header.endpoint)) {
      if (bytes.size() > header.length) bytes.resize(header.length);
      header.length = static_cast<std::uint16_t>(bytes.size());
    }
    usbredirparser_send_control_packet(parser_.get(), id, &header, data_of(bytes),
                                       static_cast<int>(bytes.size()));
  }

  void on_bulk(std::uint64_t id, usb_redir_bulk_packet_header header) {
    if (usb::is_in(header.endpoint)) {
      waiting_.push_back(id);
    } else {
      header.status = usb_redir_success;
      usbredirparser_send_bulk_packet(parser_.get(), id, &header, nullptr, 0);
      ++owed_;
    }
    for (; owed_ > 0 && !waiting_.empty(); --owed_, waiting_.pop_front()) {
      tell_bulk(waiting_.front(), usb_redir_success, answer_);
    }
  }

  void cancel(std::uint64_t id) {
    if (std::erase(waiting_, id) > 0) tell_bulk(id, usb_redir_cancelled, {});
  }

  void tell_bulk(std::uint64_t id, std::uint8_t status, std::vector<std::byte> bytes) {
    usb_redir_bulk_packet_header header{.endpoint = usb::CdcAcm::kBulkIn,
                                        .status = status,
                                        .length = static_cast<std::uint16_t>(bytes.size())};
    usbredirparser_send_bulk_packet(parser_.get(), id, &header, data_of(bytes),
                                    static_cast<int>(bytes.size()));
  }

  /// As the library takes what it only reads.
  static std::uint8_t* data_of(std::vector<std::byte>& bytes) {
    return bytes.empty() ? nullptr : reinterpret_cast<std::uint8_t*>(bytes.data());
  }

  int socket_;
  usb::Description description_;
  std::vector<std::byte> answer_;
  std::unique_ptr<usbredirparser, DestroyEchoParser> parser_;
  std::deque<std::uint64_t> waiting_;  ///< reads
  std::size_t owed_ = 0;               ///< answers
  bool has_read_ = false;
  std::vector<std::byte> outgoing_;
};

int listen_on(const char* path) {
  const int listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{.sun_family = AF_UNIX};
  std::strncpy(address.sun_path, path, sizeof address.sun_path - 1);
  const bool is_there =
      ::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
      ::listen(listener, 1) == 0;
  return is_there ? listener : -1;
}

}  // namespace
}  // namespace armjig

int main(int argc, char** argv) {
  using namespace armjig;
  const auto number = [argv](int i) {
    return static_cast<std::uint16_t>(std::strtoul(argv[i], nullptr, 16));
  };
  const auto answer = argc == 5 ? from_hex(argv[4]) : fail(ErrorCode::kBadHex);
  const int listener = answer ? listen_on(argv[1]) : -1;
  if (listener < 0) {
    std::fputs("usage: echo SOCKET VID PID ANSWER\n", stderr);
    return 2;
  }
  const usb::CdcAcm port{{number(2), number(3), "armjig", "echo", "echo"}, {}};
  std::puts("listening");
  std::fflush(stdout);
  const int client = ::accept(listener, nullptr, nullptr);
  Echo{client, port.description(), *answer}.run();
  return 0;
}
