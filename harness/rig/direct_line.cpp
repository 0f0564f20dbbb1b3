// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/direct_line.hpp"

#include "harness/link/session_stream.hpp"
#include "harness/rig/guarded_ports.hpp"

namespace armjig {
namespace {

/// The guard is the outermost layer of both kinds of port, or there is none.
template <class Guarded, class Port>
std::optional<DirectLine> line_of(Port& port) {
  auto* const guarded = dynamic_cast<Guarded*>(&port);
  if (guarded == nullptr) return std::nullopt;
  const auto lifeline = guarded->lifeline();
  if (!lifeline || !lifeline->is_plain) return std::nullopt;
  return DirectLine{lifeline->descriptor, guarded};
}

}  // namespace

std::optional<DirectLine> direct_line(StreamPort& port, const RigOptions& options) {
  if (options.capture.is_wanted() || options.impairment) return std::nullopt;
  if (auto* const connection = dynamic_cast<SessionStream*>(&port)) {
    return line_of<GuardedSession>(connection->session());
  }
  return line_of<GuardedStream>(port);
}

}  // namespace armjig
