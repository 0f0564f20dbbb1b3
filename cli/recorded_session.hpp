// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/device.hpp"
#include "emulators/replay/kept_record.hpp"
#include "harness/capture/capture.hpp"
#include "harness/foreign/foreign.hpp"

namespace armjig::cli {

/// What a host says and hears in a recording: one link, and what was beside it.
struct Session {
  CaptureLink link;
  CaptureLink events;
  std::vector<KeptRecord> records;
  bool is_of_capture = false;
};

/// On a stream, a server or a bus, not beside them.
[[nodiscard]] bool is_talk(LinkKind kind);

/// A session and whose it is.
struct KnownSession {
  Session session;
  const Device* device;
};

/// Reads all of it. Problems: of the file; `kUnsupported` for two links, another kind of link than
/// the device has, or too much; `kUnknownDevice`.
[[nodiscard]] Outcome<KnownSession> read_known_session(Devices devices, const std::string& path,
                                                       const ForeignHow& how);

}  // namespace armjig::cli
