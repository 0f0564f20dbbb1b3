// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/core/error.hpp"
#include "harness/files/user_file.hpp"
#include "harness/wire/dissector.hpp"

/// Recordings that other programs wrote: pcapng, classic pcap, and what passes on an interface.
namespace armjig {

/// A device that may be found in one.
struct ForeignDevice {
  std::string name;
  LinkKind kind{};  ///< a stream, a session or a bus
  MakeDissector make_dissector{};
  bool is_usb{};  ///< it is looked for in bulk transfers
};

/// Who listens on a port of TCP.
struct ForeignPort {
  std::uint16_t port{};
  std::size_t device{};  ///< of `ForeignHow::devices`
};

/// As Linux numbers it.
struct UsbPlace {
  std::uint32_t bus{};
  std::uint32_t device{};
};

struct ForeignHow {
  std::vector<ForeignDevice> devices;
  std::vector<ForeignPort> ports;
  std::optional<UsbPlace> usb;  ///< none: by what is said there
};

/// Whether the file begins like a recording of any format.
[[nodiscard]] bool is_capture(UserFile& file);

/// A recording of any format. Problems as for `CaptureReader::open`.
[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> open_foreign(UserFile file,
                                                                   const std::string& path,
                                                                   const ForeignHow& how);

/// What passes on an interface of this machine from now on. It ends when `must_end` says so, asked
/// several times a second. Problems: `kNotFound` with the names that there are, `kCannotRead`.
[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> open_interface(
    const std::string& name, const ForeignHow& how, std::function<bool()> must_end);

}  // namespace armjig
