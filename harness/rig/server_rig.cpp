// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/server_rig.hpp"

#include <algorithm>
#include <utility>

#include "harness/link/tcp_session.hpp"
#include "harness/rig/session_log.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {
namespace {

Outcome<std::unique_ptr<SessionPort>> open_session(const Target& target,
                                                   OpenEmulatedSession open_emulated) {
  if (target.is_emulated()) return open_emulated(target);
  if (target.scheme == "tcp") return make_tcp_session(target.address);
  return problem(ErrorCode::kBadTarget, target.text,
                 "a server has connections: write emulated: or tcp:HOST:PORT");
}

}  // namespace

Outcome<ServerRig> ServerRig::open(std::string_view device, const RigOptions& options,
                                   OpenEmulatedSession open_emulated) {
  auto port = open_session(options.target, open_emulated);
  if (!port) return tl::unexpected{port.error()};
  ServerRig rig;
  rig.port_ = *std::move(port);
  if (!options.wire_log.empty()) {
    const auto entry = std::ranges::find(dissectors(), device, &DissectorEntry::device);
    auto log = SessionLog::create(options.wire_log, *entry);
    if (!log) return tl::unexpected{log.error()};
    rig.port_ = std::make_unique<LoggedSession>(std::move(rig.port_), *std::move(log));
  }
  if (!options.target.is_emulated()) {
    const auto judge = std::ranges::find(judges(), device, &JudgeEntry::device);
    auto guarded =
        std::make_unique<GuardedSession>(std::move(rig.port_), judge->make(), options.permissions);
    rig.guard_ = guarded.get();
    rig.port_ = std::move(guarded);
  }
  if (options.impairment) {
    auto impaired = std::make_unique<ImpairedSession>(std::move(rig.port_), *options.impairment);
    rig.impaired_ = impaired.get();
    rig.port_ = std::move(impaired);
  }
  return rig;
}

std::optional<Refusal> ServerRig::last_refusal() const {
  return guard_ == nullptr ? std::nullopt : guard_->last_refusal();
}

std::optional<ImpairmentStatistics> ServerRig::impairments() const {
  if (impaired_ == nullptr) return std::nullopt;
  return impaired_->statistics();
}

}  // namespace armjig
