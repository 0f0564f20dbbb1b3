// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <optional>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/rig/judge.hpp"

namespace armjig {

/// Something that was measured or computed besides round trips.
struct Figure {
  std::string name;
  double value{};
  std::string unit;
  std::string rests_on;  ///< what it was computed from
};

/// What the figures of a device may need of the run.
struct RunFacts {
  std::optional<Duration> period;  ///< between requests; none: closed loop
  Duration median{};               ///< of the round trips
};

/// What of a device is needed to measure how long it takes to answer: one harmless request, and how
/// its answer is told. On a bus, messages are as of `StreamLink`.
///
/// `request`, `receive` and `answered` are called between two measurements or inside one, so they
/// allocate nothing.
class Probe {
 public:
  Probe() = default;
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;
  virtual ~Probe() = default;

  /// What is measured, as in `idle frame to telemetry`.
  [[nodiscard]] virtual std::string_view exchange() const noexcept = 0;
  /// What the user has to agree to for the request; at least that the device answers.
  [[nodiscard]] virtual Hazard hazard() const noexcept { return Hazard::kObserve; }

  /// From now on another one is measured, which the device has besides the first. Problems:
  /// `kBadValue` with the names that there are.
  [[nodiscard]] virtual Outcome<void> choose(std::string_view name) {
    return problem(ErrorCode::kBadValue, fmt::format("--exchange {}", name),
                   fmt::format("this device has one exchange only: {}", exchange()));
  }

  /// The next request: what is written one after the other. Valid until the next call.
  [[nodiscard]] virtual Messages request() = 0;
  /// It leaves now.
  virtual void leaves(Instant /*now*/) {}
  /// No answer comes to those that have left and were not answered.
  virtual void lost() {}
  /// Takes what came, however it was cut. How many answers end in there, in the order of the
  /// requests; what the device says by itself is none.
  [[nodiscard]] virtual std::size_t receive(Instant now, Bytes bytes) = 0;
  /// The next of the answers that `receive` counted belongs to a request that was sent then; none:
  /// to nothing. If the answer tells: by how much more than the host the device counted between
  /// this request and the one before.
  virtual std::optional<Duration> answered(std::optional<Instant> /*sent*/, Instant /*received*/) {
    return std::nullopt;
  }

  /// In a recording, where others asked: takes what was sent, however it was cut. How many requests
  /// end in there to which an answer is due.
  [[nodiscard]] virtual std::size_t requested(Instant /*now*/, Bytes /*bytes*/) { return 0; }
  /// How long what came still took after the time that a recording has for it.
  [[nodiscard]] virtual Duration rest_of(Bytes /*bytes*/) const { return {}; }

  /// How long the bits of an exchange take on its link; none if nobody can know.
  [[nodiscard]] virtual std::optional<Duration> time_on_wire() const { return std::nullopt; }
  /// The device's own, after the run.
  [[nodiscard]] virtual std::vector<Figure> figures(const RunFacts& /*facts*/) const { return {}; }
};

}  // namespace armjig
