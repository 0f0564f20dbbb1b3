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

/// Layers that make a hosted device of another thing that has such functions, or of some of them.
/// Beneath them lies a core, derived from the kind: it has `device()`, that other thing, and
/// `act(time, work)`, which does `work(time)` to it, by whatever time it is there, and looks at
/// what came of that.
namespace hosted_by {

/// What all kinds of devices may have or not.
template <class Core>
class Common : public Core {
 public:
  using Core::Core;

  void advance_to(Instant time) override {
    this->act(time, [&](Instant now) {
      if constexpr (requires { this->device().advance_to(now); }) this->device().advance_to(now);
    });
  }
  [[nodiscard]] std::optional<Instant> next_event() const override {
    if constexpr (requires { this->device().next_event(); }) return this->device().next_event();
    return std::nullopt;
  }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    return this->act(time, [&](Instant now) {
      if constexpr (requires { this->device().set_input(now, name, value); }) {
        return this->device().set_input(now, name, value);
      }
      return false;
    });
  }
  [[nodiscard]] std::optional<std::int64_t> observe(Instant time, std::string_view name) override {
    return this->act(time, [&](Instant now) -> std::optional<std::int64_t> {
      if constexpr (requires { this->device().observe(now, name); }) {
        return this->device().observe(now, name);
      }
      return std::nullopt;
    });
  }
  void overlook(Instant from, Instant to) override {
    if constexpr (requires { this->device().overlook(from, to); }) {
      this->device().overlook(from, to);
    }
  }
  [[nodiscard]] std::span<const DeviceInput> inputs() const override {
    if constexpr (requires { this->device().inputs(); }) return this->device().inputs();
    return {};
  }
  [[nodiscard]] std::vector<std::string> take_log() override {
    if constexpr (requires { this->device().take_log(); }) return this->device().take_log();
    return {};
  }
  [[nodiscard]] std::optional<int> wakes_by() const override {
    if constexpr (requires { this->device().wakes_by(); }) return this->device().wakes_by();
    return std::nullopt;
  }
  void wake(Instant time) override {
    this->act(time, [&](Instant now) {
      if constexpr (requires { this->device().wake(now); }) this->device().wake(now);
    });
  }
  [[nodiscard]] bool is_gone() const override {
    if constexpr (requires { this->device().is_gone(); }) return this->device().is_gone();
    return false;
  }
};

/// What is sent is what `device()` has sent.
template <class Core>
class Sender : public Core {
 public:
  using Core::Core;

  [[nodiscard]] auto sent() const
      -> decltype(std::declval<const typename Core::Hosted&>().sent()) override {
    return this->device().sent();
  }
  void clear_sent() override { this->device().clear_sent(); }
};

template <class Core>
class Stream : public Common<Core> {
 public:
  using Common<Core>::Common;

  void receive(Instant time, Bytes bytes) override {
    this->act(time, [&](Instant now) { this->device().receive(now, bytes); });
  }
  [[nodiscard]] std::size_t unread() const override {
    if constexpr (requires { this->device().unread(); }) return this->device().unread();
    return 0;
  }
};

template <class Core>
class Server : public Common<Core> {
 public:
  using Common<Core>::Common;

  [[nodiscard]] bool is_listening() const override { return this->device().is_listening(); }
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
    return this->act(time, [&](Instant now) { return this->device().connect(now); });
  }
  void receive(Instant time, ConnectionId id, Bytes segment) override {
    this->act(time, [&](Instant now) { this->device().receive(now, id, segment); });
  }
  void half_close(Instant time, ConnectionId id) override {
    this->act(time, [&](Instant now) { this->device().half_close(now, id); });
  }
  void close(Instant time, ConnectionId id) override {
    this->act(time, [&](Instant now) { this->device().close(now, id); });
  }
  void reset(Instant time, ConnectionId id) override {
    this->act(time, [&](Instant now) { this->device().reset(now, id); });
  }
  [[nodiscard]] std::size_t unread(ConnectionId id) const override {
    return this->device().unread(id);
  }
};

template <class Core>
class Bus : public Common<Core> {
 public:
  using Common<Core>::Common;

  BusReply start(Instant time, std::uint8_t address, bool is_read) override {
    return this->act(time,
                     [&](Instant now) { return this->device().start(now, address, is_read); });
  }
  BusReply write(Instant time, std::byte byte) override {
    return this->act(time, [&](Instant now) { return this->device().write(now, byte); });
  }
  BusReply read(Instant time) override {
    return this->act(time, [&](Instant now) { return this->device().read(now); });
  }
  BusReply stop(Instant time) override {
    return this->act(time, [&](Instant now) { return this->device().stop(now); });
  }
  BusReply recover(Instant time) override {
    return this->act(time, [&](Instant now) { return this->device().recover(now); });
  }
};

/// A core that has an emulated device of any type.
template <class Device, class KindOfPort>
class Owner : public KindOfPort {
 public:
  using Hosted = KindOfPort;
  explicit Owner(Device device) : device_{std::move(device)} {}

 protected:
  [[nodiscard]] Device& device() noexcept { return device_; }
  [[nodiscard]] const Device& device() const noexcept { return device_; }
  template <class Work>
  auto act(Instant time, Work work) {
    return work(time);
  }

 private:
  Device device_;
};

/// That can be copied.
template <class Layers>
class Copied final : public Layers {
 public:
  using Layers::Layers;

  [[nodiscard]] std::unique_ptr<typename Layers::Hosted> clone() const override {
    return std::make_unique<Copied>(this->device());
  }
};

}  // namespace hosted_by

template <EmulatedStream Device>
[[nodiscard]] std::unique_ptr<HostedStream> make_hosted(Device device) {
  using Owner = hosted_by::Owner<Device, HostedStream>;
  return std::make_unique<hosted_by::Copied<hosted_by::Stream<hosted_by::Sender<Owner>>>>(
      std::move(device));
}

template <EmulatedMultiServer Device>
[[nodiscard]] std::unique_ptr<HostedServer> make_hosted(Device device) {
  using Owner = hosted_by::Owner<Device, HostedServer>;
  return std::make_unique<hosted_by::Copied<hosted_by::Server<hosted_by::Sender<Owner>>>>(
      std::move(device));
}

/// A second client is refused while there is one.
template <EmulatedServer Device>
[[nodiscard]] std::unique_ptr<HostedServer> make_hosted(Device device) {
  return make_hosted(OneClient<Device>{std::move(device)});
}

template <EmulatedBus Device>
[[nodiscard]] std::unique_ptr<HostedBus> make_hosted(Device device) {
  using Owner = hosted_by::Owner<Device, HostedBus>;
  return std::make_unique<hosted_by::Copied<hosted_by::Bus<Owner>>>(std::move(device));
}

/// Alone on a bus of its own.
template <EmulatedBusDevice Device>
[[nodiscard]] std::unique_ptr<HostedBus> make_hosted(Device device) {
  i2c::Bus bus;
  bus.attach(std::move(device));
  return make_hosted(std::move(bus));
}

}  // namespace armjig
