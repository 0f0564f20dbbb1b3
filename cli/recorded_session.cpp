// SPDX-License-Identifier: Apache-2.0
#include "cli/recorded_session.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "cli/foreign_options.hpp"
#include "emulators/replay/on_port.hpp"
#include "harness/compare/recording_diff.hpp"

namespace armjig::cli {
namespace {

Outcome<Session> read_session(const std::string& path, const ForeignHow& how) {
  const auto reader = open_recording(path, how);
  if (!reader) return tl::unexpected{reader.error()};
  std::optional<Session> session;
  std::vector<KeptRecord> before;
  const auto read = for_each_record(**reader, [&](const CaptureRecord& record) -> Outcome<void> {
    const auto& link = *record.link;
    if (is_talk(link.kind)) {
      if (!session) {
        session = Session{link, {link.device, link.device, LinkKind::kEvents}, {}, false};
        session->records.swap(before);
      } else if (link != session->link) {
        return problem(ErrorCode::kUnsupported, path,
                       fmt::format("it has two links, '{}' and '{}': cut one out with armjig trace "
                                   "cut --device",
                                   session->link.name, link.name));
      }
    }
    auto& records = session ? session->records : before;
    if (records.size() >= RecordedMessages::kMost) {
      return problem(ErrorCode::kUnsupported, path, "it is too long; cut it with armjig trace cut");
    }
    records.push_back(KeptRecord::from(record));
    return {};
  });
  if (!read) return tl::unexpected{read.error()};
  print_warning_of(**reader);
  if (session) {
    session->is_of_capture = is_of_capture((*reader)->header().json);
    return *std::move(session);
  }
  return problem(ErrorCode::kMalformed, path, "nothing passed on a link in there");
}

/// The device that it is of. Problems: nobody here knows it, or it was on another kind of link.
Outcome<const Device*> device_of(Devices devices, const std::string& path, const Session& session) {
  const auto* const device = find_recorded_device(devices, session.link.device);
  if (device == nullptr) {
    return problem(
        ErrorCode::kUnknownDevice, path,
        fmt::format("it is of '{}'; known are {}", session.link.device, names_of(devices)));
  }
  constexpr std::array kKinds{LinkKind::kStream, LinkKind::kSession, LinkKind::kBus};
  if (kKinds.at(device->port.index()) != session.link.kind) {
    return problem(ErrorCode::kUnsupported, path, "it is of another kind of link");
  }
  return device;
}

}  // namespace

bool is_talk(LinkKind kind) {
  return kind == LinkKind::kStream || kind == LinkKind::kSession || kind == LinkKind::kBus;
}

Outcome<KnownSession> read_known_session(Devices devices, const std::string& path,
                                         const ForeignHow& how) {
  auto session = read_session(path, how);
  if (!session) return tl::unexpected{session.error()};
  return device_of(devices, path, *session).map([&](const Device* device) {
    return KnownSession{*std::move(session), device};
  });
}

}  // namespace armjig::cli
