// SPDX-License-Identifier: Apache-2.0
#include <usbredirparser.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <set>
#include <utility>

#include "emulators/host/usb_wire.hpp"

namespace armjig {
namespace {

/// No packet of a client is longer: what a driver asks for at once is some ten KiB.
constexpr std::size_t kLongestPacket = std::size_t{1} << 20U;

struct DestroyParser {
  void operator()(usbredirparser* parser) const noexcept { usbredirparser_destroy(parser); }
};

std::uint8_t usbredir_status(usb::Status status) noexcept {
  switch (status) {
    case usb::Status::kDone:
      return usb_redir_success;
    case usb::Status::kCancelled:
      return usb_redir_cancelled;
    case usb::Status::kStalled:
      return usb_redir_stall;
    case usb::Status::kBabbled:
      return usb_redir_babble;
    case usb::Status::kInvalid:
      break;
  }
  return usb_redir_inval;
}

/// Of the transfer that waits for the next interrupt of an endpoint; clients count from 0.
std::uint64_t interrupt_id(std::uint8_t endpoint) noexcept {
  return std::numeric_limits<std::uint64_t>::max() - endpoint;
}

/// The parser counts endpoints from 0 to 31, those to the host from 16.
std::size_t place_of(std::uint8_t endpoint) noexcept {
  return (usb::is_in(endpoint) ? 16U : 0U) + (endpoint & 0x0FU);
}

class UsbredirWire final : public UsbWire {
 public:
  UsbredirWire(usb::Device& device, Cable cable)
      : device_{device}, cable_{cable}, parser_{usbredirparser_create()} {
    parser_->priv = this;
    set_callbacks(*parser_);
    std::array<std::uint32_t, USB_REDIR_CAPS_SIZE> capabilities{};
    for (const int one : {usb_redir_cap_connect_device_version, usb_redir_cap_device_disconnect_ack,
                          usb_redir_cap_ep_info_max_packet_size, usb_redir_cap_64bits_ids,
                          usb_redir_cap_32bits_bulk_length}) {
      usbredirparser_caps_set_cap(capabilities.data(), one);
    }
    usbredirparser_init(parser_.get(), "armjig", capabilities.data(), USB_REDIR_CAPS_SIZE,
                        usbredirparser_fl_usb_host);
    write();
  }

  bool receive(Instant time, Bytes bytes) override {
    time_ = time;
    incoming_ = bytes;
    while (!incoming_.empty() && !is_broken_) {
      // Who answers 0 has all that is there, and waits for more.
      if (usbredirparser_do_read(parser_.get()) != 0) is_broken_ = true;
    }
    incoming_ = {};
    write();
    return !is_broken_;
  }

  void tell(const usb::Completion& completion) override {
    const auto* const endpoint = usb::find_endpoint(device_.description(), completion.endpoint);
    if ((completion.endpoint & ~usb::kIn) == 0) {
      tell_control(completion);
    } else if (endpoint != nullptr && endpoint->kind == usb::Endpoint::Kind::kInterrupt) {
      tell_interrupt(*endpoint, completion);
    } else {
      tell_bulk(completion);
    }
    write();
  }

  bool set_cable(Cable cable) override {
    cable_ = cable;
    interrupts_.clear();
    if (!has_greeted_) return true;
    if (cable == Cable::kIn) {
      if (!is_leaving_) connect();
    } else if (is_connected_) {
      is_connected_ = false;
      usbredirparser_send_device_disconnect(parser_.get());
      // Until that is acknowledged, what comes is still for the device that is gone.
      is_leaving_ =
          usbredirparser_peer_has_cap(parser_.get(), usb_redir_cap_device_disconnect_ack) != 0;
    }
    write();
    return true;
  }

 private:
  static UsbredirWire& of(void* self) noexcept { return *static_cast<UsbredirWire*>(self); }

  /// All that a client may send: the library calls each without a look whether it is there.
  static void set_callbacks(usbredirparser& parser);

  int read_into(std::uint8_t* data, int count) {
    const auto size = std::min(incoming_.size(), static_cast<std::size_t>(count));
    unfinished_ += size;
    if (unfinished_ > kLongestPacket) return -1;
    if (size > 0) std::memcpy(data, incoming_.data(), size);
    incoming_ = incoming_.subspan(size);
    return static_cast<int>(size);
  }

  void write() {
    if (usbredirparser_has_data_to_write(parser_.get()) > 0) {
      usbredirparser_do_write(parser_.get());
    }
  }

  void greet() {
    unfinished_ = 0;
    has_greeted_ = true;
    if (cable_ == Cable::kIn) connect();
  }

  void connect() {
    is_connected_ = true;
    send_interfaces();
    send_endpoints();
    const auto& description = device_.description();
    usb_redir_device_connect_header header{
        .speed = static_cast<std::uint8_t>(
            description.speed == usb::Speed::kLow ? usb_redir_speed_low : usb_redir_speed_full),
        .device_class = description.code.main,
        .device_subclass = description.code.sub,
        .device_protocol = description.code.protocol,
        .vendor_id = description.identity.vendor,
        .product_id = description.identity.product,
        .device_version_bcd = usb::kDeviceVersion};
    usbredirparser_send_device_connect(parser_.get(), &header);
  }

  void send_interfaces() {
    usb_redir_interface_info_header header{};
    for (const auto& interface : device_.description().interfaces) {
      const auto i = header.interface_count++;
      header.interface[i] = static_cast<std::uint8_t>(i);
      header.interface_class[i] = interface.code.main;
      header.interface_subclass[i] = interface.code.sub;
      header.interface_protocol[i] = interface.code.protocol;
    }
    usbredirparser_send_interface_info(parser_.get(), &header);
  }

  void send_endpoints() {
    usb_redir_ep_info_header header{};
    std::fill(std::begin(header.type), std::end(header.type), std::uint8_t{usb_redir_type_invalid});
    const auto& description = device_.description();
    for (const auto address : {std::uint8_t{0}, usb::kIn}) {
      header.type[place_of(address)] = usb_redir_type_control;
      header.max_packet_size[place_of(address)] = description.control_packet_size;
    }
    for (std::size_t i = 0; i < description.interfaces.size(); ++i) {
      for (const auto& endpoint : description.interfaces[i].endpoints) {
        const auto place = place_of(endpoint.address);
        header.type[place] = static_cast<std::uint8_t>(endpoint.kind);
        header.interval[place] = endpoint.interval;
        header.interface[place] = static_cast<std::uint8_t>(i);
        header.max_packet_size[place] = endpoint.packet_size;
      }
    }
    usbredirparser_send_ep_info(parser_.get(), &header);
  }

  // What the client asks.

  /// A whole packet has come. False: it is for a device that is not plugged in any more.
  bool admit() {
    unfinished_ = 0;
    return is_connected_;
  }

  void submit(usb::Transfer transfer) { device_.submit(time_, std::move(transfer)); }

  std::vector<std::byte> take(std::uint8_t* data, int size) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(std::max(size, 0)));
    if (data != nullptr && !bytes.empty()) std::memcpy(bytes.data(), data, bytes.size());
    usbredirparser_free_packet_data(parser_.get(), data);
    return bytes;
  }

  void on_control(std::uint64_t id, const usb_redir_control_packet_header& header,
                  std::vector<std::byte> bytes) {
    if (!admit()) return;
    const usb::Setup setup{header.requesttype, header.request, header.value, header.index,
                           header.length};
    submit({.id = id,
            .endpoint = static_cast<std::uint8_t>(header.endpoint & usb::kIn),
            .setup = setup,
            .room = header.length,
            .bytes = std::move(bytes)});
  }

  void on_bulk(std::uint64_t id, const usb_redir_bulk_packet_header& header,
               std::vector<std::byte> bytes) {
    if (!admit()) return;
    const auto* const endpoint = usb::find_endpoint(device_.description(), header.endpoint);
    if (endpoint == nullptr || endpoint->kind != usb::Endpoint::Kind::kBulk) {
      return tell_bulk({.id = id, .endpoint = header.endpoint, .status = usb::Status::kInvalid});
    }
    const std::size_t length = std::size_t{header.length_high} << 16U | header.length;
    submit({.id = id,
            .endpoint = header.endpoint,
            .room = usb::is_in(header.endpoint) ? length : 0,
            .bytes = std::move(bytes)});
  }

  void on_reset() {
    if (!admit()) return;
    interrupts_.clear();
    device_.reset(time_);
  }

  void on_disconnect_ack() {
    unfinished_ = 0;
    if (std::exchange(is_leaving_, false) && cable_ == Cable::kIn) connect();
  }

  void on_set_configuration(std::uint64_t id, std::uint8_t value) {
    if (!admit()) return;
    const bool is_done = device_.configure(value);
    send_configuration(id, is_done ? usb_redir_success : usb_redir_stall);
  }

  void send_configuration(std::uint64_t id, int status) {
    usb_redir_configuration_status_header header{.status = static_cast<std::uint8_t>(status),
                                                 .configuration = device_.configuration()};
    usbredirparser_send_configuration_status(parser_.get(), id, &header);
  }

  void on_setting(std::uint64_t id, std::uint8_t interface, std::uint8_t setting) {
    if (!admit()) return;
    const bool is_there = interface < device_.description().interfaces.size() && setting == 0;
    usb_redir_alt_setting_status_header header{
        .status = static_cast<std::uint8_t>(is_there ? usb_redir_success : usb_redir_inval),
        .interface = interface,
        .alt = 0};
    usbredirparser_send_alt_setting_status(parser_.get(), id, &header);
  }

  // Interrupts are asked for once and come as they happen: one transfer is always under way.

  void on_start_interrupts(std::uint64_t id, std::uint8_t endpoint) {
    if (!admit()) return;
    const auto* const found = usb::find_endpoint(device_.description(), endpoint);
    const bool is_good = found != nullptr && found->kind == usb::Endpoint::Kind::kInterrupt &&
                         usb::is_in(endpoint) && device_.configuration() != 0;
    send_interrupt_status(id, endpoint, is_good ? usb_redir_success : usb_redir_inval);
    if (is_good && interrupts_.insert(endpoint).second) await_interrupt(*found);
  }

  void on_stop_interrupts(std::uint64_t id, std::uint8_t endpoint) {
    if (!admit()) return;
    if (interrupts_.erase(endpoint) > 0) device_.cancel(interrupt_id(endpoint));
    send_interrupt_status(id, endpoint, usb_redir_success);
  }

  void send_interrupt_status(std::uint64_t id, std::uint8_t endpoint, int status) {
    usb_redir_interrupt_receiving_status_header header{.status = static_cast<std::uint8_t>(status),
                                                       .endpoint = endpoint};
    usbredirparser_send_interrupt_receiving_status(parser_.get(), id, &header);
  }

  void await_interrupt(const usb::Endpoint& endpoint) {
    submit({.id = interrupt_id(endpoint.address),
            .endpoint = endpoint.address,
            .room = endpoint.packet_size});
  }

  // None of our devices has what these ask for.

  void refuse_iso(std::uint64_t id, std::uint8_t endpoint) {
    if (!admit()) return;
    usb_redir_iso_stream_status_header header{.status = usb_redir_inval, .endpoint = endpoint};
    usbredirparser_send_iso_stream_status(parser_.get(), id, &header);
  }

  void refuse_streams(std::uint64_t id, std::uint32_t endpoints) {
    if (!admit()) return;
    usb_redir_bulk_streams_status_header header{
        .endpoints = endpoints, .no_streams = 0, .status = usb_redir_inval};
    usbredirparser_send_bulk_streams_status(parser_.get(), id, &header);
  }

  void refuse_interrupt(std::uint64_t id, std::uint8_t endpoint) {
    if (!admit()) return;
    usb_redir_interrupt_packet_header header{
        .endpoint = endpoint, .status = usb_redir_inval, .length = 0};
    usbredirparser_send_interrupt_packet(parser_.get(), id, &header, nullptr, 0);
  }

  // What the client is told.

  static std::uint8_t* data_of(const usb::Completion& completion) noexcept;
  static int size_of(const usb::Completion& completion) noexcept {
    return static_cast<int>(completion.bytes.size());
  }

  void tell_interrupt(const usb::Endpoint& endpoint, const usb::Completion& completion) {
    if (completion.status != usb::Status::kDone || !interrupts_.contains(endpoint.address)) return;
    usb_redir_interrupt_packet_header header{
        .endpoint = completion.endpoint,
        .status = usb_redir_success,
        .length = static_cast<std::uint16_t>(completion.bytes.size())};
    usbredirparser_send_interrupt_packet(parser_.get(), next_interrupt_++, &header,
                                         data_of(completion), size_of(completion));
    await_interrupt(endpoint);
  }

  void tell_control(const usb::Completion& completion) {
    const auto& setup = completion.setup;
    usb_redir_control_packet_header header{.endpoint = completion.endpoint,
                                           .request = setup.request,
                                           .requesttype = setup.type,
                                           .status = usbredir_status(completion.status),
                                           .value = setup.value,
                                           .index = setup.index,
                                           .length = static_cast<std::uint16_t>(completion.size)};
    usbredirparser_send_control_packet(parser_.get(), completion.id, &header, data_of(completion),
                                       size_of(completion));
  }

  void tell_bulk(const usb::Completion& completion) {
    usb_redir_bulk_packet_header header{
        .endpoint = completion.endpoint,
        .status = usbredir_status(completion.status),
        .length = static_cast<std::uint16_t>(completion.size & 0xFFFFU),
        .stream_id = 0,
        .length_high = static_cast<std::uint16_t>(completion.size >> 16U)};
    usbredirparser_send_bulk_packet(parser_.get(), completion.id, &header, data_of(completion),
                                    size_of(completion));
  }

  usb::Device& device_;
  Cable cable_;
  std::unique_ptr<usbredirparser, DestroyParser> parser_;
  Instant time_{};
  Bytes incoming_;
  std::size_t unfinished_ = 0;  ///< bytes since the last whole packet
  bool has_greeted_ = false;
  bool is_connected_ = false;
  bool is_leaving_ = false;  ///< a disconnection is not acknowledged yet
  bool is_broken_ = false;
  std::set<std::uint8_t> interrupts_;  ///< the endpoints of which they are asked for
  std::uint64_t next_interrupt_ = 0;
};

/// Its data, as the library takes what it only reads.
std::uint8_t* UsbredirWire::data_of(const usb::Completion& completion) noexcept {
  auto* const bytes = const_cast<std::byte*>(completion.bytes.data());
  return completion.bytes.empty() ? nullptr : reinterpret_cast<std::uint8_t*>(bytes);
}

void UsbredirWire::set_callbacks(usbredirparser& parser) {
  parser.log_func = [](void* /*self*/, int /*level*/, const char* /*line*/) {};
  parser.read_func = [](void* self, std::uint8_t* data, int count) {
    return of(self).read_into(data, count);
  };
  parser.write_func = [](void* self, std::uint8_t* data, int count) {
    const auto* const bytes = reinterpret_cast<const std::byte*>(data);
    auto& out = of(self).outgoing_;
    out.insert(out.end(), bytes, bytes + count);
    return count;
  };
  parser.hello_func = [](void* self, usb_redir_hello_header* /*hello*/) { of(self).greet(); };
  parser.reset_func = [](void* self) { of(self).on_reset(); };
  parser.set_configuration_func = [](void* self, std::uint64_t id,
                                     usb_redir_set_configuration_header* header) {
    of(self).on_set_configuration(id, header->configuration);
  };
  parser.get_configuration_func = [](void* self, std::uint64_t id) {
    if (of(self).admit()) of(self).send_configuration(id, usb_redir_success);
  };
  parser.set_alt_setting_func = [](void* self, std::uint64_t id,
                                   usb_redir_set_alt_setting_header* header) {
    of(self).on_setting(id, header->interface, header->alt);
  };
  parser.get_alt_setting_func = [](void* self, std::uint64_t id,
                                   usb_redir_get_alt_setting_header* header) {
    of(self).on_setting(id, header->interface, 0);
  };
  parser.start_iso_stream_func = [](void* self, std::uint64_t id,
                                    usb_redir_start_iso_stream_header* header) {
    of(self).refuse_iso(id, header->endpoint);
  };
  parser.stop_iso_stream_func = [](void* self, std::uint64_t id,
                                   usb_redir_stop_iso_stream_header* header) {
    of(self).refuse_iso(id, header->endpoint);
  };
  parser.start_interrupt_receiving_func = [](void* self, std::uint64_t id,
                                             usb_redir_start_interrupt_receiving_header* header) {
    of(self).on_start_interrupts(id, header->endpoint);
  };
  parser.stop_interrupt_receiving_func = [](void* self, std::uint64_t id,
                                            usb_redir_stop_interrupt_receiving_header* header) {
    of(self).on_stop_interrupts(id, header->endpoint);
  };
  parser.alloc_bulk_streams_func = [](void* self, std::uint64_t id,
                                      usb_redir_alloc_bulk_streams_header* header) {
    of(self).refuse_streams(id, header->endpoints);
  };
  parser.free_bulk_streams_func = [](void* self, std::uint64_t id,
                                     usb_redir_free_bulk_streams_header* header) {
    of(self).refuse_streams(id, header->endpoints);
  };
  parser.cancel_data_packet_func = [](void* self, std::uint64_t id) {
    if (of(self).admit()) of(self).device_.cancel(id);
  };
  parser.filter_reject_func = [](void* self) { of(self).unfinished_ = 0; };
  parser.filter_filter_func = [](void* self, usbredirfilter_rule* rules, int /*count*/) {
    of(self).unfinished_ = 0;
    std::free(rules);  // NOLINT(*-no-malloc,*-owning-memory): the library's, given to us
  };
  parser.device_disconnect_ack_func = [](void* self) { of(self).on_disconnect_ack(); };
  parser.start_bulk_receiving_func = [](void* self, std::uint64_t /*id*/,
                                        usb_redir_start_bulk_receiving_header* /*header*/) {
    of(self).is_broken_ = true;  // we have not said that we can
  };
  parser.stop_bulk_receiving_func = [](void* self, std::uint64_t /*id*/,
                                       usb_redir_stop_bulk_receiving_header* /*header*/) {
    of(self).is_broken_ = true;
  };
  parser.control_packet_func =
      [](void* self, std::uint64_t id, usb_redir_control_packet_header* header, std::uint8_t* data,
         int size) { of(self).on_control(id, *header, of(self).take(data, size)); };
  parser.bulk_packet_func = [](void* self, std::uint64_t id, usb_redir_bulk_packet_header* header,
                               std::uint8_t* data, int size) {
    of(self).on_bulk(id, *header, of(self).take(data, size));
  };
  parser.iso_packet_func = [](void* self, std::uint64_t id, usb_redir_iso_packet_header* header,
                              std::uint8_t* data, int size) {
    (void)of(self).take(data, size);
    of(self).refuse_iso(id, header->endpoint);
  };
  parser.interrupt_packet_func = [](void* self, std::uint64_t id,
                                    usb_redir_interrupt_packet_header* header, std::uint8_t* data,
                                    int size) {
    (void)of(self).take(data, size);
    of(self).refuse_interrupt(id, header->endpoint);
  };
}

}  // namespace

std::unique_ptr<UsbWire> make_usbredir_wire(usb::Device& device, Cable cable) {
  return std::make_unique<UsbredirWire>(device, cable);
}

}  // namespace armjig
