// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string_view>
#include <vector>

#include "emulators/host/host.hpp"
#include "emulators/host/usb_export.hpp"
#include "emulators/memory/hosted.hpp"
#include "harness/core/error.hpp"
#include "harness/link/bus_port.hpp"

namespace boost::asio {
class io_context;  // NOLINT(readability-identifier-naming): theirs
}

/// The two halves of a host. Everything here runs on the thread of one io_context.
namespace armjig {

/// The half that all kinds of devices share, as the other half sees it: a device on the wall clock.
class Loop {
 public:
  Loop() = default;
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  virtual ~Loop() = default;

  [[nodiscard]] virtual boost::asio::io_context& context() noexcept = 0;
  /// Brings the device to the present, unless that takes too long: then time is lost. The device's
  /// time.
  virtual Instant catch_up() = 0;
  /// The device's time without bringing it there.
  [[nodiscard]] virtual Instant present() const = 0;
  /// When the device's time will be that, by the wall clock.
  [[nodiscard]] virtual std::chrono::steady_clock::time_point wall_time(Instant time) const = 0;
  /// The device was brought that far by others.
  virtual void reach(Instant time) = 0;
  /// Lets the device do what is due, has it forwarded, and sees to it that this happens again.
  virtual void pump() = 0;
  virtual void log(std::string_view line) const = 0;
};

/// The half that a device has with its kind: what brings its clients' bytes to it and its answers
/// to them.
class Front {
 public:
  Front() = default;
  Front(const Front&) = delete;
  Front& operator=(const Front&) = delete;
  virtual ~Front() = default;

  /// Before the clock starts. The device's time.
  [[nodiscard]] virtual Instant begin() { return {}; }
  /// Problems: those of `Host::open`.
  [[nodiscard]] virtual Outcome<void> listen(const HostOptions& options) = 0;
  /// Hands over what the device has sent.
  virtual void forward() = 0;
  /// What a hand can do to its links.
  [[nodiscard]] std::vector<DeviceInput> inputs() const { return hand_.inputs(); }
  /// False: there is no such input, or it does not take the value.
  [[nodiscard]] bool set_input(std::string_view name, std::int64_t value) {
    return hand_.set_input(name, value);
  }
  [[nodiscard]] virtual std::vector<std::string> targets() const = 0;
  [[nodiscard]] virtual LinkStatistics statistics() const = 0;
  /// The bus, for one that is one.
  [[nodiscard]] virtual BusPort* bus() noexcept { return nullptr; }

 protected:
  CableHand hand_;
};

/// How a front exports USB devices. `on_turn` is called after one was told something.
[[nodiscard]] UsbExport::Events usb_events(Loop& loop, std::function<void()> on_turn);

// The loop and the device outlive them.
[[nodiscard]] std::unique_ptr<Front> make_front(Loop& loop, HostedStream& device);
[[nodiscard]] std::unique_ptr<Front> make_front(Loop& loop, HostedServer& server);
[[nodiscard]] std::unique_ptr<Front> make_front(Loop& loop, HostedBus& bus);

}  // namespace armjig
