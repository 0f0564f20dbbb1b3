// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/rig.hpp"

#include <type_traits>
#include <vector>

#include "harness/link/impaired_bus.hpp"
#include "harness/link/impaired_session.hpp"
#include "harness/link/impaired_stream.hpp"
#include "harness/link/reopening_ports.hpp"
#include "harness/link/session_stream.hpp"
#include "harness/rig/logged_ports.hpp"

namespace armjig {
namespace {

constexpr Duration kConnectPatience = std::chrono::seconds{2};

auto problem_of_guard(const Target& target, const Error& error) {
  const auto* const hint = error.code == ErrorCode::kSystem
                               ? "the process that watches over the arm cannot be started"
                               : "it does not take what it is sent";
  return problem(error.code, target.text, hint);
}

bool reopens(const RigOptions& options) {
  return options.when_gone == WhenGone::kReopen && !options.target.is_emulated();
}

/// A person has to look at an arm that was gone, before it moves.
std::optional<Problem> problem_of_reopening(const RigOptions& options) {
  if (!reopens(options) || !options.permissions.allow_motion()) return std::nullopt;
  return Problem{ErrorCode::kBadValue, "--reconnect with --allow",
                 "an arm that was gone and may move has to be looked at by a person first"};
}

// Each layer for each kind of port.

template <class Port>
Outcome<std::unique_ptr<Port>> open_once(const Wiring<Port>& wiring, const RigOptions& options) {
  if (options.target.is_emulated()) return wiring.open_emulated(options.target);
  if (wiring.open_real != nullptr) return wiring.open_real(options.target, wiring.line);
  return problem(ErrorCode::kUnsupported, options.target.text,
                 "this program has no real links: write emulated:");
}

template <class Port>
using ReopeningPort =
    std::conditional_t<std::is_same_v<Port, StreamPort>, ReopeningStream, ReopeningBus>;

/// Connections to a server are begun again by `connect`.
template <class Port>
Outcome<std::unique_ptr<Port>> open_port(const Wiring<Port>& wiring, const RigOptions& options) {
  auto port = open_once(wiring, options);
  if constexpr (!std::is_same_v<Port, SessionSource>) {
    if (port && reopens(options)) {
      return std::make_unique<ReopeningPort<Port>>(
          *std::move(port), [wiring, options] { return open_once(wiring, options); });
    }
  }
  return port;
}

template <class Port>
using GuardedPort = std::conditional_t<std::is_same_v<Port, StreamPort>, GuardedStream, GuardedBus>;

template <class Port>
Result<std::unique_ptr<Port>> guard_port(const Wiring<Port>& wiring, std::unique_ptr<Port> port,
                                         const RigOptions& options,
                                         const std::shared_ptr<GuardState>& watch) {
  if constexpr (std::is_same_v<Port, SessionSource>) {
    return std::make_unique<GuardedSource>(std::move(port), wiring.make_judge, options.permissions,
                                           watch);
  } else {
    return GuardedPort<Port>::guard(std::move(port), wiring.make_judge(), options.permissions,
                                    watch);
  }
}

using Count = std::function<ImpairmentStatistics()>;

Outcome<std::unique_ptr<StreamPort>> impair_port(std::unique_ptr<StreamPort> port,
                                                 const Impairment& impairment, Count& count) {
  auto impaired = std::make_unique<ImpairedStream>(std::move(port), impairment);
  count = [stream = impaired.get()] { return stream->statistics(); };
  return impaired;
}
/// Every port to the server is bad in the same way.
Outcome<std::unique_ptr<SessionSource>> impair_port(std::unique_ptr<SessionSource> port,
                                                    const Impairment& impairment, Count& count) {
  auto all = std::make_shared<std::vector<std::shared_ptr<ImpairedPaths>>>();
  count = [all] {
    ImpairmentStatistics sum;
    for (const auto& paths : *all) {
      sum.out += paths->out.statistics();
      sum.in += paths->in.statistics();
    }
    return sum;
  };
  return std::make_unique<SourceAround>(
      std::move(port), [all, impairment](std::unique_ptr<SessionPort> session) {
        all->push_back(std::make_shared<ImpairedPaths>(impairment));
        return std::make_unique<ImpairedSession>(std::move(session), all->back());
      });
}
Outcome<std::unique_ptr<BusPort>> impair_port(std::unique_ptr<BusPort> port,
                                              const Impairment& impairment, Count& count) {
  auto impaired = ImpairedBus::make(std::move(port), impairment);
  if (!impaired) return tl::unexpected{impaired.error()};
  count = [bus = impaired->get()] { return bus->statistics(); };
  return *std::move(impaired);
}

}  // namespace

template <class Port>
Outcome<Rig<Port>> Rig<Port>::open(const Wiring<Port>& wiring, const RigOptions& options) {
  if (auto refused = problem_of_reopening(options)) return tl::unexpected{*std::move(refused)};
  auto port = open_port(wiring, options);
  if (!port) return tl::unexpected{port.error()};
  Rig rig{*std::move(port)};
  if (options.capture.is_wanted()) {
    auto log = WireLog::create(
        options.capture,
        {.device = wiring.device,
         .make_dissector = wiring.make_dissector,
         .target = options.target.text,
         .epoch_ns = options.target.is_emulated() ? 0 : epoch_of(rig.port_->now())});
    if (!log) return tl::unexpected{log.error()};
    rig.port_ = put_log_on(std::move(rig.port_), *std::move(log));
  }
  if (!options.target.is_emulated()) {
    rig.watch_ = std::make_shared<GuardState>();
    rig.watch_->when_left = options.when_left;
    auto guarded = guard_port(wiring, std::move(rig.port_), options, rig.watch_);
    if (!guarded) return problem_of_guard(options.target, guarded.error());
    rig.port_ = *std::move(guarded);
  }
  if (options.impairment) {
    auto impaired = impair_port(std::move(rig.port_), *options.impairment, rig.count_);
    if (!impaired) return tl::unexpected{impaired.error()};
    rig.port_ = *std::move(impaired);
  }
  if (options.must_stop && !options.target.is_emulated()) {
    rig.port_ = make_stoppable(std::move(rig.port_), options.must_stop);
  }
  return rig;
}

template class Rig<StreamPort>;
template class Rig<SessionSource>;
template class Rig<BusPort>;

Outcome<Rig<StreamPort>> connect(Rig<SessionSource> server, const std::string& target,
                                 WhenGone when_gone) {
  const std::shared_ptr<SessionSource> source = std::move(server.port_);
  const auto connect = [source, target]() -> Outcome<std::unique_ptr<StreamPort>> {
    auto connected = SessionStream::connect(source, kConnectPatience);
    if (connected) return *std::move(connected);
    return problem(connected.error().code, target, "is the server running?");
  };
  auto port = connect();
  if (!port) return tl::unexpected{port.error()};
  Rig<StreamPort> rig{*std::move(port)};
  if (when_gone == WhenGone::kReopen) {
    rig.port_ = std::make_unique<ReopeningStream>(std::move(rig.port_), connect);
  }
  rig.watch_ = std::move(server.watch_);
  rig.count_ = std::move(server.count_);
  return rig;
}

}  // namespace armjig
