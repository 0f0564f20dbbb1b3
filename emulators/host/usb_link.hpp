// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "emulators/host/client_link.hpp"
#include "emulators/host/host.hpp"
#include "emulators/host/loop.hpp"
#include "emulators/host/usb_export.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// A byte stream as a USB serial port (`usb::CdcAcm`). A client is a program that has opened the
/// port on the machine at the other end of the cable.
class UsbLink : public ClientLink {
 public:
  virtual void set_cable(Cable cable) = 0;
};

/// `loop` outlives it. Problems: those of `export_usb`.
[[nodiscard]] Outcome<std::unique_ptr<UsbLink>> open_usb_link(Loop& loop, const UsbOptions& options,
                                                              LinkEvents events);

}  // namespace armjig
