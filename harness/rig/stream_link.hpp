// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "harness/core/error.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/rig/rig.hpp"

namespace armjig {

/// A device on the jig as a byte stream: a board, the only connection of a server, or a bus.
class StreamLink {
 public:
  explicit StreamLink(Rig<StreamPort> rig) : rig_{std::move(rig)} {}

  /// What is written is one transaction: the address shifted left by one, and the data; or the
  /// same plus 1, and how many bytes to read. Each that was acknowledged, its answer included, is
  /// read at once, as dissectors take it. Writing fails with `kNotFound` if it was not.
  explicit StreamLink(Rig<BusPort> rig);

  /// Connects within two seconds. When the connection has ended, so has the stream (`kFail`), or it
  /// is begun again (`kReopen`; not in virtual time). `target` is for messages.
  [[nodiscard]] static Outcome<StreamLink> connect(Rig<SessionSource> rig,
                                                   const std::string& target,
                                                   WhenGone when_gone = WhenGone::kFail);

  [[nodiscard]] StreamPort& port() noexcept {
    return adapter_ == nullptr ? std::get<Rig<StreamPort>>(rig_).port() : *adapter_;
  }
  /// Whether what is written can be read, too.
  [[nodiscard]] bool is_bus() const noexcept { return std::holds_alternative<Rig<BusPort>>(rig_); }

  /// As of the rig.
  [[nodiscard]] std::optional<Refusal> last_refusal() const;
  [[nodiscard]] std::optional<ImpairmentStatistics> impairments() const;

 private:
  std::variant<Rig<StreamPort>, Rig<BusPort>> rig_;
  std::unique_ptr<StreamPort> adapter_;  ///< if its port is no stream
};

}  // namespace armjig
