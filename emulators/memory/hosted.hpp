// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "harness/core/device_input.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/one_client.hpp"

/// Emulated devices whose type is forgotten, so that what carries their bytes is compiled once for
/// all of them. The functions are those of the concepts in `harness/core/emulation.hpp`; times
/// given never decrease.
namespace armjig {

/// What all of them have.
class HostedDevice {
 public:
  HostedDevice() = default;
  HostedDevice(const HostedDevice&) = delete;
  HostedDevice& operator=(const HostedDevice&) = delete;
  virtual ~HostedDevice() = default;

  virtual void advance_to(Instant time) = 0;
  [[nodiscard]] virtual std::optional<Instant> next_event() const = 0;
  /// Does beside the device what no client can. False: nothing has that name and takes the value.
  [[nodiscard]] virtual bool set_input(Instant time, std::string_view name, std::int64_t value) = 0;
  /// What people see beside the device. None: nothing has that name.
  [[nodiscard]] virtual std::optional<std::int64_t> observe(Instant /*time*/,
                                                            std::string_view /*name*/) {
    return std::nullopt;
  }
  /// Whoever hosts it did not look between these times: what clients did then it gets now.
  virtual void overlook(Instant /*from*/, Instant /*to*/) {}
  /// What `set_input` knows, for people.
  [[nodiscard]] virtual std::span<const DeviceInput> inputs() const { return {}; }
  /// What the device has written to its log since the last call.
  [[nodiscard]] virtual std::vector<std::string> take_log() { return {}; }

  /// Of one that is not emulated but at the other end of a link: a file that is readable when
  /// `wake` has something to read there.
  [[nodiscard]] virtual std::optional<int> wakes_by() const { return std::nullopt; }
  virtual void wake(Instant /*time*/) {}
  /// It will never do anything again.
  [[nodiscard]] virtual bool is_gone() const { return false; }
};

/// On a byte stream.
class HostedStream : public HostedDevice {
 public:
  virtual void receive(Instant time, Bytes bytes) = 0;
  [[nodiscard]] virtual std::span<const SentBytes> sent() const = 0;
  virtual void clear_sent() = 0;
  /// Bytes that are still on their way to the device.
  [[nodiscard]] virtual std::size_t unread() const { return 0; }
  /// A snapshot; none of what cannot be copied, such as a device that somebody watches.
  [[nodiscard]] virtual std::unique_ptr<HostedStream> clone() const { return nullptr; }
};

/// That knows its connections.
class HostedServer : public HostedDevice {
 public:
  [[nodiscard]] virtual bool is_listening() const = 0;
  [[nodiscard]] virtual std::optional<ConnectionId> connect(Instant time) = 0;
  virtual void receive(Instant time, ConnectionId id, Bytes segment) = 0;
  virtual void half_close(Instant time, ConnectionId id) = 0;
  virtual void close(Instant time, ConnectionId id) = 0;
  virtual void reset(Instant time, ConnectionId id) = 0;
  [[nodiscard]] virtual std::size_t unread(ConnectionId id) const = 0;
  [[nodiscard]] virtual std::span<const ServerEvent> sent() const = 0;
  virtual void clear_sent() = 0;
  /// As `HostedStream::clone`.
  [[nodiscard]] virtual std::unique_ptr<HostedServer> clone() const { return nullptr; }
};

/// A bus with all that is on it.
class HostedBus : public HostedDevice {
 public:
  virtual BusReply start(Instant time, std::uint8_t address, bool is_read) = 0;
  virtual BusReply write(Instant time, std::byte byte) = 0;
  virtual BusReply read(Instant time) = 0;
  virtual BusReply stop(Instant time) = 0;
  virtual BusReply recover(Instant time) = 0;
  /// As `HostedStream::clone`.
  [[nodiscard]] virtual std::unique_ptr<HostedBus> clone() const { return nullptr; }
};

using AnyHosted = std::variant<std::unique_ptr<HostedStream>, std::unique_ptr<HostedServer>,
                               std::unique_ptr<HostedBus>>;

/// What all kinds of devices may have or not. `Self` is the class that is made of it.
template <class Self, class Device, class Kind>
class HostedAs : public Kind {
 public:
  explicit HostedAs(Device device) : device_{std::move(device)} {}

  [[nodiscard]] std::unique_ptr<Kind> clone() const final {
    return std::make_unique<Self>(device_);
  }

  void advance_to(Instant time) final {
    if constexpr (requires { device_.advance_to(time); }) device_.advance_to(time);
  }
  [[nodiscard]] std::optional<Instant> next_event() const final {
    if constexpr (requires { device_.next_event(); }) return device_.next_event();
    return std::nullopt;
  }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) final {
    if constexpr (requires { device_.set_input(time, name, value); }) {
      return device_.set_input(time, name, value);
    }
    return false;
  }
  [[nodiscard]] std::optional<std::int64_t> observe(Instant time, std::string_view name) final {
    if constexpr (requires { device_.observe(time, name); }) return device_.observe(time, name);
    return std::nullopt;
  }
  [[nodiscard]] std::span<const DeviceInput> inputs() const final {
    if constexpr (requires { device_.inputs(); }) return device_.inputs();
    return {};
  }
  [[nodiscard]] std::vector<std::string> take_log() final {
    if constexpr (requires { device_.take_log(); }) return device_.take_log();
    return {};
  }

 protected:
  Device device_;
};

template <EmulatedStream Device>
[[nodiscard]] std::unique_ptr<HostedStream> make_hosted(Device device) {
  class Hosted final : public HostedAs<Hosted, Device, HostedStream> {
   public:
    using Hosted::HostedAs::HostedAs;
    void receive(Instant time, Bytes bytes) override { this->device_.receive(time, bytes); }
    [[nodiscard]] std::span<const SentBytes> sent() const override { return this->device_.sent(); }
    void clear_sent() override { this->device_.clear_sent(); }
  };
  return std::make_unique<Hosted>(std::move(device));
}

template <EmulatedMultiServer Device>
[[nodiscard]] std::unique_ptr<HostedServer> make_hosted(Device device) {
  class Hosted final : public HostedAs<Hosted, Device, HostedServer> {
   public:
    using Hosted::HostedAs::HostedAs;
    [[nodiscard]] bool is_listening() const override { return this->device_.is_listening(); }
    [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
      return this->device_.connect(time);
    }
    void receive(Instant time, ConnectionId id, Bytes segment) override {
      this->device_.receive(time, id, segment);
    }
    void half_close(Instant time, ConnectionId id) override { this->device_.half_close(time, id); }
    void close(Instant time, ConnectionId id) override { this->device_.close(time, id); }
    void reset(Instant time, ConnectionId id) override { this->device_.reset(time, id); }
    [[nodiscard]] std::size_t unread(ConnectionId id) const override {
      return this->device_.unread(id);
    }
    [[nodiscard]] std::span<const ServerEvent> sent() const override {
      return this->device_.sent();
    }
    void clear_sent() override { this->device_.clear_sent(); }
  };
  return std::make_unique<Hosted>(std::move(device));
}

/// A second client is refused while there is one.
template <EmulatedServer Device>
[[nodiscard]] std::unique_ptr<HostedServer> make_hosted(Device device) {
  return make_hosted(OneClient<Device>{std::move(device)});
}

template <EmulatedBus Device>
[[nodiscard]] std::unique_ptr<HostedBus> make_hosted(Device device) {
  class Hosted final : public HostedAs<Hosted, Device, HostedBus> {
   public:
    using Hosted::HostedAs::HostedAs;
    BusReply start(Instant time, std::uint8_t address, bool is_read) override {
      return this->device_.start(time, address, is_read);
    }
    BusReply write(Instant time, std::byte byte) override {
      return this->device_.write(time, byte);
    }
    BusReply read(Instant time) override { return this->device_.read(time); }
    BusReply stop(Instant time) override { return this->device_.stop(time); }
    BusReply recover(Instant time) override { return this->device_.recover(time); }
  };
  return std::make_unique<Hosted>(std::move(device));
}

/// Alone on a bus of its own.
template <EmulatedBusDevice Device>
[[nodiscard]] std::unique_ptr<HostedBus> make_hosted(Device device) {
  i2c::Bus bus;
  bus.attach(std::move(device));
  return make_hosted(std::move(bus));
}

}  // namespace armjig
