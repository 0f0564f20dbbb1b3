// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "emulators/usb/function.hpp"

namespace armjig::usb {

/// Something that the host wants done. It is done once, or cancelled.
struct Transfer {
  std::uint64_t id{};              ///< the host's
  std::uint8_t endpoint{};         ///< with `kIn`; 0 and `kIn` are the control endpoint
  Setup setup{};                   ///< of the control endpoint
  std::size_t room{};              ///< for what the device sends
  std::vector<std::byte> bytes{};  ///< for the device
};

enum class Status : std::uint8_t {
  kDone,
  kCancelled,
  kStalled,  ///< the device refuses
  kBabbled,  ///< the device sent more than there is room for
  kInvalid,  ///< there is no such endpoint, or the device is not configured
};

/// The end of a transfer.
struct Completion {
  std::uint64_t id{};
  std::uint8_t endpoint{};
  Setup setup{};
  Status status{};
  std::size_t size{};              ///< bytes that passed, in either direction
  std::vector<std::byte> bytes{};  ///< from the device
};

/// A USB device: takes transfers and ends each exactly once, those of an endpoint in their order.
/// One thread; the function may call `advance` while it is asked something.
class Device {
 public:
  /// So many transfers wait at most, and so many of their bytes; more are ended as `kInvalid`.
  static constexpr std::size_t kMostTransfers = 1024;
  static constexpr std::size_t kMostBytes = std::size_t{4} << 20U;

  /// `function` outlives it.
  explicit Device(Function& function) noexcept : function_{function} {}

  [[nodiscard]] const Description& description() const noexcept { return function_.description(); }

  void submit(Instant time, Transfer transfer);
  /// Ends a transfer as `kCancelled` whose end nobody was told yet, if it is on its way to a
  /// function or waits for its time. False: there is none of that kind.
  bool cancel(std::uint64_t id);
  /// Goes on with what waits, since the function may take or give now.
  void advance();
  /// The host has reset the bus: what waits ends as `kCancelled`.
  void reset(Instant time);
  /// The cable was pulled out: nobody is told of any end.
  void unplug(Instant time);

  /// False: there is no configuration of that value; 0 is none.
  bool configure(std::uint8_t value);
  [[nodiscard]] std::uint8_t configuration() const noexcept { return configuration_; }

  /// The next transfer that has ended by `time`, if there is one; each is told once.
  [[nodiscard]] std::optional<Completion> next(Instant time);
  /// When the next one will have ended, if that is known.
  [[nodiscard]] std::optional<Instant> next_due() const;

 private:
  struct Waiting {
    Transfer transfer;
    std::size_t passed = 0;             ///< of `transfer.bytes`
    std::vector<std::byte> received{};  ///< from the device
  };
  struct Ended {
    Completion completion;
    Instant due{};
  };
  using Queue = std::deque<Waiting>;

  void control(Instant time, const Transfer& transfer);
  [[nodiscard]] std::optional<ControlReply> answer(Instant time, const Transfer& transfer);
  [[nodiscard]] std::optional<ControlReply> standard(const Setup& setup);
  [[nodiscard]] std::optional<ControlReply> descriptor(const Setup& setup) const;
  [[nodiscard]] std::optional<ControlReply> status(const Setup& setup) const;
  [[nodiscard]] bool feature(const Setup& setup);
  [[nodiscard]] bool has_room_for(const Transfer& transfer) const;
  [[nodiscard]] bool step(const Endpoint& endpoint, Queue& queue);
  [[nodiscard]] bool step_out(const Endpoint& endpoint, Queue& queue);
  [[nodiscard]] bool step_in(const Endpoint& endpoint, Queue& queue);
  void end(const Transfer& transfer, Status status, std::size_t size = 0,
           std::vector<std::byte> bytes = {}, Instant due = {});
  void end_all(Queue& queue, Status status);

  Function& function_;
  std::uint8_t configuration_ = 0;
  std::map<std::uint8_t, Queue> queues_;  ///< by endpoint
  std::set<std::uint8_t> halted_;         ///< endpoints
  std::deque<Ended> ended_;
  bool is_advancing_ = false;
  bool is_asked_again_ = false;  ///< to advance
};

}  // namespace armjig::usb
