// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/device_input.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/time.hpp"

namespace armjig::i2c {

/// Any `EmulatedBusDevice`, as a value. Besides what the concept asks for, a device may have
///
/// - `start(Instant, bool is_read)`: its address was matched;
/// - `stop(Instant)`: a stop or a repeated start ended its transaction;
/// - `advance_to(Instant)`: time goes on without traffic;
/// - `restart(Instant)`: power fails and comes back;
/// - `set_input(Instant, name, value)`: does what no bus can, or answers false;
/// - `observe(Instant, name)`: what is to be seen at it, or none;
/// - `stretch()`: for how long it holds the clock after the byte that it just had.
class BusDevice {
 public:
  // Copying is asked about before the concept is: the concept would ask for copying.
  template <class Device>
    requires(!std::same_as<Device, BusDevice>) && EmulatedBusDevice<Device>
  explicit BusDevice(Device device) : model_{std::make_unique<Model<Device>>(std::move(device))} {}

  BusDevice(const BusDevice& other) : model_{other.model_->clone()} {}
  BusDevice& operator=(const BusDevice& other) {
    model_ = other.model_->clone();
    return *this;
  }
  BusDevice(BusDevice&&) noexcept = default;
  BusDevice& operator=(BusDevice&&) noexcept = default;
  ~BusDevice() = default;

  [[nodiscard]] bool acknowledges(std::uint8_t address) { return model_->acknowledges(address); }
  void start(Instant time, bool is_read) { model_->start(time, is_read); }
  [[nodiscard]] bool write(Instant time, std::byte byte) { return model_->write(time, byte); }
  [[nodiscard]] std::byte read(Instant time) { return model_->read(time); }
  void stop(Instant time) { model_->stop(time); }
  void advance_to(Instant time) { model_->advance_to(time); }
  void restart(Instant time) { model_->restart(time); }
  [[nodiscard]] Duration stretch() const { return model_->stretch(); }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) {
    return model_->set_input(time, name, value);
  }
  [[nodiscard]] std::optional<std::int64_t> observe(Instant time, std::string_view name) {
    return model_->observe(time, name);
  }

  /// The device itself; nullptr if it is none of that type.
  template <class Device>
  [[nodiscard]] Device* as() noexcept {
    auto* model = dynamic_cast<Model<Device>*>(model_.get());
    return model == nullptr ? nullptr : &model->device;
  }

 private:
  struct Concept {
    Concept() = default;
    Concept(const Concept&) = delete;
    Concept& operator=(const Concept&) = delete;
    virtual ~Concept() = default;
    [[nodiscard]] virtual std::unique_ptr<Concept> clone() const = 0;
    [[nodiscard]] virtual bool acknowledges(std::uint8_t address) = 0;
    virtual void start(Instant time, bool is_read) = 0;
    [[nodiscard]] virtual bool write(Instant time, std::byte byte) = 0;
    [[nodiscard]] virtual std::byte read(Instant time) = 0;
    virtual void stop(Instant time) = 0;
    virtual void advance_to(Instant time) = 0;
    virtual void restart(Instant time) = 0;
    [[nodiscard]] virtual Duration stretch() const = 0;
    [[nodiscard]] virtual bool set_input(Instant time, std::string_view name,
                                         std::int64_t value) = 0;
    [[nodiscard]] virtual std::optional<std::int64_t> observe(Instant time,
                                                              std::string_view name) = 0;
  };

  template <class Device>
  struct Model final : Concept {
    explicit Model(Device value) : device{std::move(value)} {}
    std::unique_ptr<Concept> clone() const override { return std::make_unique<Model>(device); }
    bool acknowledges(std::uint8_t address) override { return device.acknowledges(address); }
    void start(Instant time, bool is_read) override {
      if constexpr (requires { device.start(time, is_read); }) device.start(time, is_read);
    }
    bool write(Instant time, std::byte byte) override { return device.write(time, byte); }
    std::byte read(Instant time) override { return device.read(time); }
    void stop(Instant time) override {
      if constexpr (requires { device.stop(time); }) device.stop(time);
    }
    void advance_to(Instant time) override {
      if constexpr (requires { device.advance_to(time); }) device.advance_to(time);
    }
    void restart(Instant time) override {
      if constexpr (requires { device.restart(time); }) device.restart(time);
    }
    Duration stretch() const override {
      if constexpr (requires { device.stretch(); }) return device.stretch();
      return {};
    }
    bool set_input(Instant time, std::string_view name, std::int64_t value) override {
      if constexpr (requires { device.set_input(time, name, value); }) {
        return device.set_input(time, name, value);
      }
      return false;
    }
    std::optional<std::int64_t> observe(Instant time, std::string_view name) override {
      if constexpr (requires { device.observe(time, name); }) return device.observe(time, name);
      return std::nullopt;
    }
    Device device;
  };

  std::unique_ptr<Concept> model_;
};

/// Something that goes wrong once, at one byte of a transaction.
struct Trouble {
  enum class Kind : std::uint8_t {
    kNack,             ///< nobody acknowledges the byte, and no device sees it
    kStretch,          ///< the clock is held for `duration`
    kArbitrationLost,  ///< another master wins; the transaction is over
    kDataHeld,         ///< the data line stays low until `clocks` more clocks
    kDeviceRestarts,   ///< power of the addressed devices fails behind the byte
  };
  Kind kind{};
  std::optional<std::uint8_t> address{};  ///< none: any
  std::size_t byte = 0;                   ///< 0 is the address, then data bytes
  Duration duration{};
  int clocks = 1;
};

/// `0x12`.
[[nodiscard]] std::string name_at(std::uint8_t address);

/// A bus at 100 kHz with its devices: who answers, how long everything takes, what can go wrong
/// with two wires. Devices with the same address answer together: one acknowledgement is enough, a
/// zero bit wins.
class Bus {
 public:
  static constexpr Duration kBit = std::chrono::microseconds{10};
  static constexpr Duration kByte = 9 * kBit;

  /// Its number is that of `device`. `name`: how inputs are told from those of others, usually
  /// `name_at` the address that it has now.
  template <EmulatedBusDevice Device>
  std::size_t attach(Device device, std::string name = {}) {
    devices_.emplace_back(std::move(device));
    names_.push_back(std::move(name));
    return devices_.size() - 1;
  }
  /// Requires a device of that type with that number.
  template <class Device>
  [[nodiscard]] Device& device(std::size_t number) {
    return *devices_.at(number).template as<Device>();
  }
  [[nodiscard]] std::size_t device_count() const noexcept { return devices_.size(); }

  /// Each trouble comes once, at the first byte that fits.
  void expect(Trouble trouble) { troubles_.push_back(trouble); }

  /// A start condition, repeated inside a transaction, and the address.
  BusReply start(Instant time, std::uint8_t address, bool is_read);
  BusReply write(Instant time, std::byte byte);
  /// Devices give a byte when it begins. Ones if nobody is addressed.
  BusReply read(Instant time);
  BusReply stop(Instant time);
  /// Nine clocks and a stop, which free a data line that a device holds in the middle of a byte.
  BusReply recover(Instant time);
  void advance_to(Instant time);
  /// What people can do to all that is on it.
  [[nodiscard]] static std::span<const DeviceInput> inputs() noexcept;
  /// One of `inputs`; or of the device that the name begins with, as in `0x12.power`, else of the
  /// first one that has such an input. False: none has.
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value);
  /// As for `set_input`. None: no device has such a thing.
  [[nodiscard]] std::optional<std::int64_t> observe(Instant time, std::string_view name);

 private:
  /// The device that the name begins with, and what follows there.
  [[nodiscard]] std::optional<std::pair<std::size_t, std::string_view>> named(
      std::string_view name) const;
  [[nodiscard]] std::optional<Trouble> take_trouble(Trouble::Kind kind);
  [[nodiscard]] BusReply finish(Instant end, BusReply::Outcome outcome, std::byte byte = {});
  [[nodiscard]] Instant when_clock_is_free(Instant time) const noexcept;
  void leave_devices(Instant time);

  std::vector<BusDevice> devices_;
  std::vector<std::string> names_;      ///< of them; empty: it has none
  std::vector<std::size_t> addressed_;  ///< who takes part in the transaction
  std::vector<Trouble> troubles_;
  std::uint8_t address_ = 0;
  std::size_t byte_ = 0;       ///< of the transaction
  int clocks_to_release_ = 0;  ///< until the data line is free
  Instant clock_held_until_{};
};

}  // namespace armjig::i2c
