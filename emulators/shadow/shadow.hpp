// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emulators/memory/hosted.hpp"
#include "harness/compare/recording_diff.hpp"
#include "harness/compare/rules.hpp"
#include "harness/core/overhearer.hpp"

namespace armjig {

/// Where a device and its twin say different things.
struct Divergence {
  Change change{};   ///< `kChanged`; `kMissing`: only the twin says it; `kExtra`: only the device
  std::string lane;  ///< the connection or the address; empty on a stream
  Instant time{};
  std::optional<Message> device;
  std::optional<Message> twin;
  std::vector<std::string> what;  ///< `NAME: DEVICE, TWIN`
};

/// `0.512 s: 'telemetry' differs: speed.j1: 500 steps/s, 0 steps/s`, the device's side first.
[[nodiscard]] std::string describe(const Divergence& divergence);

struct ShadowCounts {
  std::size_t messages{};  ///< of the device, but for those that the rules ignore
  std::size_t divergences{};
  std::size_t agreements{};  ///< how often they agreed again after that
};

/// Leads an emulated device by what it overhears of another one. Messages of both are paired in
/// each lane: with an equal one within the tolerance of time, before which those of the twin are
/// missing; else with the next of the same name, which is changed, unless each field says what the
/// twin says at some time within that tolerance. A host acts on what the device said, so before the
/// twin hears it, the twin goes on until it has said that, too, if that is within the tolerance.
class Shadow final : public Overhearer {
 public:
  struct Listener {
    std::function<void(const Divergence&)> on_divergence = [](const Divergence&) {};
    /// They agree again, after so many divergences in that lane.
    std::function<void(Instant time, const std::string& lane, std::size_t after)> on_agreement =
        [](Instant, const std::string&, std::size_t) {};
  };

  /// Times of the twin begin at 0, as those that it overhears.
  Shadow(AnyHosted twin, MakeDissector make_dissector, ComparisonRules rules, Listener listener);

  void to_device(Instant time, Bytes bytes) override;
  void from_device(Instant time, Bytes bytes) override;
  void on_connection(const ConnectionEvent& event) override;
  void on_bus(const BusPart& part) override;
  void on_input(Instant time, std::string_view name, std::int64_t value) override;
  void wait_until(Instant time) override;

  /// Nothing more comes. What is not told by the time of the last thing is not missed.
  void finish();
  [[nodiscard]] const ShadowCounts& counts() const noexcept { return counts_; }

 private:
  struct Side {
    std::unique_ptr<Dissector> dissector;
    std::deque<RecordedMessage> said;
  };
  struct Lane {
    std::string name;
    Side device;
    Side twin;
    std::deque<RecordedMessage> paired;  ///< of the twin, lately
    std::size_t apart = 0;               ///< divergences since they agreed last
  };

  Lane& lane_of(std::uint32_t id);
  void hear_host(Instant time, std::uint32_t id, Bytes bytes);
  void hear(Side& side, Instant time, Direction direction, Bytes bytes, const std::string& note);
  void lead_to(Instant time);
  void catch_up();
  [[nodiscard]] std::optional<Instant> owes_until() const;
  template <class Device>
  void take_sent(Device& device);
  void match(Lane& lane, Instant now);
  bool match_first(Lane& lane, Instant now);
  void take_pair(Lane& lane, const std::deque<RecordedMessage>::iterator& twin);
  void agree(Lane& lane, Instant time);
  void tell(Lane& lane, Change change, const RecordedMessage* device, const RecordedMessage* twin,
            std::vector<std::string> what = {});

  AnyHosted twin_;
  MakeDissector make_dissector_;
  ComparisonRules rules_;
  Listener listener_;
  Instant now_{};
  std::map<std::uint32_t, Lane> lanes_;
  std::map<std::uint32_t, ConnectionId> connections_;  ///< of the twin, by those of the device
  std::map<ConnectionId, std::uint32_t> devices_;      ///< the other way round
  ShadowCounts counts_;
};

}  // namespace armjig
