// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "harness/core/emulation.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::emulation {

/// Which library the board of the pen was built with; nobody recorded which it was.
enum class PenLibrary : std::uint8_t {
  kBuffered,  ///< a whole write is handled at its stop; the recordings are of this one
  kPerByte,   ///< every byte is a command of its own, so that a position is never understood
};

struct PenSetup {
  PenLibrary library = PenLibrary::kBuffered;
  bool hangs_on_surplus = true;  ///< after bytes that a command does not need it never reacts again

  // The rest is the board's; a pen with others is a faulty one (defects/).
  std::uint8_t address = pen::kAddress;
  int degrees_at_boot = pen::kRetractedDegrees;
  int (*degrees)(Bytes command) = pen::servo_degrees;  ///< of at least one byte
  bool retracts_when_poked = false;                    ///< by a write of nothing
  bool has_lamp1 = true;
  Duration poll_period = std::chrono::milliseconds{50};  ///< of the buttons
};

/// The pen end-effector: a servo, two lamps, two push buttons, a serial console. An
/// `EmulatedBusDevice`.
class Pen {
 public:
  explicit Pen(const PenSetup& setup = {}) noexcept
      : setup_{setup}, next_poll_{setup.poll_period}, degrees_{setup.degrees_at_boot} {}

  [[nodiscard]] bool acknowledges(std::uint8_t address) const noexcept {
    return address == setup_.address;
  }
  void start(Instant time, bool is_read);
  [[nodiscard]] bool write(Instant time, std::byte byte);
  /// Nobody should; what a real one answers depends on its library.
  [[nodiscard]] std::byte read(Instant time) noexcept;
  void stop(Instant time);
  void advance_to(Instant time) noexcept;
  void restart(Instant time) noexcept;

  /// Buttons deploy and retract without the bus; looked at every 50 ms, the first wins.
  void press(Instant time, bool deploys, bool retracts) noexcept;

  /// What no bus can: `deploy` and `retract`, 1: that button is held, 0: let go; `pen-power`: off
  /// and on. False: there is no such thing.
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value);

  /// What is to be seen: `servo` in degrees, `lamp1` and `lamp2`. None: there is no such thing.
  [[nodiscard]] std::optional<std::int64_t> observe(Instant time, std::string_view name) noexcept;

  [[nodiscard]] int servo_degrees() const noexcept { return degrees_; }
  [[nodiscard]] bool lamp1() const noexcept { return lamp1_; }  ///< turns over with each command
  [[nodiscard]] bool lamp2() const noexcept;                    ///< nearer to deployed
  [[nodiscard]] bool hangs() const noexcept { return hangs_; }
  /// What it printed since the last call.
  [[nodiscard]] std::string take_console() { return std::exchange(console_, {}); }

 private:
  void obey(Bytes data);

  PenSetup setup_;
  BoundedBytes<32> received_;  ///< as much as the library keeps
  bool is_written_ = false;
  Instant next_poll_;
  bool deploys_ = false;
  bool retracts_ = false;
  int degrees_;
  bool lamp1_ = false;
  bool hangs_ = false;
  std::string console_;
};
static_assert(EmulatedBusDevice<Pen>);

}  // namespace armjig::morap::emulation
