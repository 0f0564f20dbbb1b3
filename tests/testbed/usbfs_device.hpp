// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <umockdev.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <string>

#include "harness/link/usb_control.hpp"
#include "tests/testbed/usb_bench.hpp"

namespace armjig::testing {

/// A USB device without a kernel driver, as programs see it that bring their own: entries in /sys
/// and a node in /dev/bus/usb whose ioctls carry control transfers. Vendor requests to its
/// interface go to a `UsbControl`, a request that this one refuses is stalled.
class UsbfsDevice {
 public:
  struct Identity {
    std::uint8_t number;  ///< on its bus
    UsbId numbers;
    std::string serial_number;
  };

  /// Plugs it in. `bench` and `control` have to outlive it.
  UsbfsDevice(const UsbBench& bench, const Identity& identity, UsbControl& control);
  UsbfsDevice(const UsbfsDevice&) = delete;
  UsbfsDevice& operator=(const UsbfsDevice&) = delete;
  ~UsbfsDevice();

  /// Whoever has it open does not get it back.
  void pull_out();
  /// The following transfers end with an error number, as the kernel has them; 0: as they should.
  void end_transfers_with(int error);
  /// The following transfers do not end until somebody takes them back.
  void fall_silent();

  /// The file behind its node.
  [[nodiscard]] std::string file() const;

 private:
  static gboolean on_ioctl(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer device);

  // These run on a thread of the library. They return an error number.
  int answer(UMockdevIoctlClient* client);
  int submit(UMockdevIoctlData* argument);
  int write_at_once(UMockdevIoctlData* argument);
  int discard(UMockdevIoctlData* argument);
  int reap(UMockdevIoctlData* argument);
  /// The bytes that were moved, or minus an error number.
  int transfer(std::span<std::byte> setup_and_data);
  int read_string(std::uint8_t index, std::span<std::byte> into) const;

  const UsbBench& bench_;
  Identity identity_;
  UsbControl& control_;
  std::string node_;
  std::string entry_;  ///< in /sys
  UMockdevIoctlBase* ioctls_;

  std::mutex guard_;          ///< of all that follows
  std::deque<gulong> ended_;  ///< addresses of transfers that nobody fetched yet
  int error_ = 0;
  bool is_silent_ = false;
  bool is_claimed_ = false;
  bool is_gone_ = false;
};

}  // namespace armjig::testing
