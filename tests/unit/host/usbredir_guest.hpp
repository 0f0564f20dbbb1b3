// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <usbredirparser.h>

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "emulators/usb/function.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/hex.hpp"

namespace armjig {

/// The guest's side of usbredir, as QEMU has it: what it has heard, and bytes for the other side.
class UsbredirGuest {
 public:
  /// An answer with an id.
  struct Answer {
    int status = -1;
    std::size_t length = 0;
    std::string data;  ///< hexadecimal
  };

  UsbredirGuest() : parser_{usbredirparser_create()} {
    parser_->priv = this;
    set_callbacks(*parser_);
    std::uint32_t capabilities[USB_REDIR_CAPS_SIZE] = {};
    for (const int one : {usb_redir_cap_connect_device_version, usb_redir_cap_device_disconnect_ack,
                          usb_redir_cap_ep_info_max_packet_size, usb_redir_cap_64bits_ids,
                          usb_redir_cap_32bits_bulk_length}) {
      usbredirparser_caps_set_cap(capabilities, one);
    }
    usbredirparser_init(parser_.get(), "test", capabilities, USB_REDIR_CAPS_SIZE, 0);
    write();
  }

  /// Whether the library takes it.
  bool receive(Bytes bytes) {
    incoming_ = bytes;
    int result = 0;
    while (!incoming_.empty() && result == 0) result = usbredirparser_do_read(parser_.get());
    write();
    return result == 0;
  }

  void configure(std::uint64_t id, std::uint8_t value) {
    usb_redir_set_configuration_header header{.configuration = value};
    usbredirparser_send_set_configuration(parser_.get(), id, &header);
    write();
  }
  void control(std::uint64_t id, const usb::Setup& setup, const std::string& hex = "") {
    usb_redir_control_packet_header header{
        .endpoint = static_cast<std::uint8_t>(setup.type & 0x80U),
        .request = setup.request,
        .requesttype = setup.type,
        .status = 0,
        .value = setup.value,
        .index = setup.index,
        .length = setup.length};
    auto data = from_hex(hex).value();
    usbredirparser_send_control_packet(parser_.get(), id, &header, pointer(data),
                                       static_cast<int>(data.size()));
    write();
  }
  void bulk(std::uint64_t id, std::uint8_t endpoint, std::size_t length,
            const std::string& hex = "") {
    usb_redir_bulk_packet_header header{.endpoint = endpoint,
                                        .status = 0,
                                        .length = static_cast<std::uint16_t>(length),
                                        .stream_id = 0,
                                        .length_high = 0};
    auto data = from_hex(hex).value();
    usbredirparser_send_bulk_packet(parser_.get(), id, &header, pointer(data),
                                    static_cast<int>(data.size()));
    write();
  }
  void start_interrupts(std::uint64_t id, std::uint8_t endpoint) {
    usb_redir_start_interrupt_receiving_header header{.endpoint = endpoint};
    usbredirparser_send_start_interrupt_receiving(parser_.get(), id, &header);
    write();
  }
  void cancel(std::uint64_t id) {
    usbredirparser_send_cancel_data_packet(parser_.get(), id);
    write();
  }
  void reset() {
    usbredirparser_send_reset(parser_.get());
    write();
  }

  /// The answer with that id; fails if there is not exactly one.
  [[nodiscard]] Answer answer(std::uint64_t id) const {
    const auto found = answers.find(id);
    return found != answers.end() && found->second.size() == 1 ? found->second.front() : Answer{};
  }

  std::vector<std::byte> outgoing;
  int connections = 0;
  int disconnections = 0;
  // They are packed, and tests bind references to their members.
  alignas(8) usb_redir_device_connect_header device{};
  alignas(8) usb_redir_interface_info_header interfaces{};
  alignas(8) usb_redir_ep_info_header endpoints{};
  std::map<std::uint64_t, std::vector<Answer>> answers;
  std::vector<std::string> interrupts;

 private:
  struct Destroy {
    void operator()(usbredirparser* parser) const noexcept { usbredirparser_destroy(parser); }
  };

  static UsbredirGuest& of(void* self) noexcept { return *static_cast<UsbredirGuest*>(self); }
  static std::uint8_t* pointer(std::vector<std::byte>& bytes) {
    return bytes.empty() ? nullptr : reinterpret_cast<std::uint8_t*>(bytes.data());
  }

  void write() {
    if (usbredirparser_has_data_to_write(parser_.get()) > 0) {
      usbredirparser_do_write(parser_.get());
    }
  }

  void note(std::uint64_t id, int status, std::size_t length, std::uint8_t* data, int size) {
    const auto* const bytes = reinterpret_cast<const std::byte*>(data);
    answers[id].push_back({status, length, to_hex({bytes, static_cast<std::size_t>(size)})});
    if (data != nullptr) usbredirparser_free_packet_data(parser_.get(), data);
  }

  static void set_callbacks(usbredirparser& parser) {
    parser.log_func = [](void*, int, const char*) {};
    parser.read_func = [](void* self, std::uint8_t* data, int count) {
      auto& in = of(self).incoming_;
      const auto size = std::min(in.size(), static_cast<std::size_t>(count));
      if (size > 0) std::memcpy(data, in.data(), size);
      in = in.subspan(size);
      return static_cast<int>(size);
    };
    parser.write_func = [](void* self, std::uint8_t* data, int count) {
      const auto* const bytes = reinterpret_cast<const std::byte*>(data);
      auto& out = of(self).outgoing;
      out.insert(out.end(), bytes, bytes + count);
      return count;
    };
    parser.device_connect_func = [](void* self, usb_redir_device_connect_header* header) {
      ++of(self).connections;
      of(self).device = *header;
    };
    parser.device_disconnect_func = [](void* self) { ++of(self).disconnections; };
    parser.interface_info_func = [](void* self, usb_redir_interface_info_header* header) {
      of(self).interfaces = *header;
    };
    parser.ep_info_func = [](void* self, usb_redir_ep_info_header* header) {
      of(self).endpoints = *header;
    };
    parser.configuration_status_func = [](void* self, std::uint64_t id,
                                          usb_redir_configuration_status_header* header) {
      of(self).note(id, header->status, header->configuration, nullptr, 0);
    };
    parser.interrupt_receiving_status_func =
        [](void* self, std::uint64_t id, usb_redir_interrupt_receiving_status_header* header) {
          of(self).note(id, header->status, 0, nullptr, 0);
        };
    parser.iso_stream_status_func = [](void* self, std::uint64_t id,
                                       usb_redir_iso_stream_status_header* header) {
      of(self).note(id, header->status, 0, nullptr, 0);
    };
    parser.control_packet_func = [](void* self, std::uint64_t id,
                                    usb_redir_control_packet_header* header, std::uint8_t* data,
                                    int size) {
      of(self).note(id, header->status, header->length, data, size);
    };
    parser.bulk_packet_func = [](void* self, std::uint64_t id, usb_redir_bulk_packet_header* header,
                                 std::uint8_t* data, int size) {
      of(self).note(id, header->status, header->length, data, size);
    };
    parser.interrupt_packet_func = [](void* self, std::uint64_t, usb_redir_interrupt_packet_header*,
                                      std::uint8_t* data, int size) {
      const auto* const bytes = reinterpret_cast<const std::byte*>(data);
      of(self).interrupts.push_back(to_hex({bytes, static_cast<std::size_t>(size)}));
      usbredirparser_free_packet_data(of(self).parser_.get(), data);
    };
  }

  std::unique_ptr<usbredirparser, Destroy> parser_;
  Bytes incoming_;
};

}  // namespace armjig
