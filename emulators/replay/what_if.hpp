// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/replay/kept_record.hpp"
#include "emulators/replay/perturbed.hpp"
#include "emulators/replay/recorded_host.hpp"
#include "harness/core/error.hpp"
#include "harness/core/overhearer.hpp"

/// What a link could do to a talk so that it goes wrong: single pieces lost, doubled, late or
/// swapped, first one, then two, until a rule is broken that was not broken before.
namespace armjig {

/// A rule that was broken.
struct Breakage {
  Instant time{};
  std::string rule;  ///< the id of a requirement, or `device`, `program`, `apart`
  std::string what;  ///< one sentence
};

/// Judges what passes in one trial.
class TrialJudge : public Overhearer {
 public:
  /// Nothing more will pass. What was broken, in order of time.
  [[nodiscard]] virtual std::vector<Breakage> finish() = 0;
};
using MakeTrialJudge = std::function<std::unique_ptr<TrialJudge>()>;

/// What the device said: bytes that left together, on a connection or from an address.
struct SaidPiece {
  Instant time{};
  std::uint32_t lane{};
  std::vector<std::byte> bytes;
};

/// A talk, perturbed or not.
struct TrialResult {
  std::vector<PassedPiece> passed;  ///< of which a perturbation can be made
  std::vector<SaidPiece> said;      ///< the whole of it, or from a little before it was perturbed
  std::vector<Breakage> broken;
};

/// Has the talk with these perturbations. From any thread, many at once, if the search is told to
/// do so.
using Trial = std::function<Outcome<TrialResult>(const std::vector<Perturbation>& wanted)>;

/// For how long a device says something else than without the perturbation.
struct Apart {
  Instant from{};
  Instant to{};
  bool is_to_the_end = false;       ///< still when the recording ends
  std::vector<std::string> fields;  ///< of the first that differ, `NAME: WITHOUT, WITH`
};

/// Compares what was said last at each time; none: it is always the same.
[[nodiscard]] std::optional<Apart> apart(const std::vector<SaidPiece>& without,
                                         const std::vector<SaidPiece>& with,
                                         MakeDissector make_dissector);

struct WhatIfHow {
  /// How long what is late is held back.
  Duration delay = std::chrono::milliseconds{100};
  std::size_t most = 2;   ///< perturbations together, 1 or 2
  std::size_t reach = 8;  ///< the second of two is among so many pieces after the first
  /// What is found has to be found so many times more; for talks that are not always the same.
  int confirmations = 0;
  std::set<std::string, std::less<>> ignored;  ///< rules that may be broken
  /// Asked before each trial.
  std::function<bool()> must_stop = [] { return false; };
  /// Calls the second with 0 to `count - 1`, on any threads.
  std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)> for_each =
      [](std::size_t count, const std::function<void(std::size_t)>& work) {
        for (std::size_t i = 0; i < count; ++i) work(i);
      };
};

struct WhatIfAnswer {
  struct Found {
    std::vector<Perturbation> perturbations;
    std::vector<Instant> times;  ///< of their pieces when nothing is perturbed
    Breakage broken;             ///< the first rule
    TrialResult after;
  };
  TrialResult undisturbed;
  std::optional<Found> found;  ///< the shortest; of those losses first, and the earliest
  std::size_t tried{};
  bool is_complete = true;  ///< false: it was stopped before all was tried
};

/// Rules that are broken without any perturbation do not count. Problems: those of a trial.
[[nodiscard]] Outcome<WhatIfAnswer> what_if(const Trial& trial, const WhatIfHow& how);

/// `one lost 'command' of the host at 12.400 s`, two with `and` between.
[[nodiscard]] std::string describe(const WhatIfAnswer::Found& found);

/// A recorded talk that begins again and again a little before it is perturbed, from copies of the
/// device.
class RecordedTalk {
 public:
  /// `make_judge` may answer nullptr: then only the device's own bytes are judged. Problems:
  /// `kUnsupported` for a device that cannot be copied.
  [[nodiscard]] static Outcome<RecordedTalk> begin(RecordedHost host,
                                                   std::vector<KeptRecord> records,
                                                   MakeDissector make_dissector,
                                                   MakeTrialJudge make_judge);

  RecordedTalk(RecordedTalk&&) noexcept;
  RecordedTalk& operator=(RecordedTalk&&) noexcept;
  RecordedTalk(const RecordedTalk&) = delete;
  RecordedTalk& operator=(const RecordedTalk&) = delete;
  ~RecordedTalk();

  /// `longest_apart`: a device that says something else for longer than that has broken `apart`.
  /// Any number of threads may ask.
  [[nodiscard]] TrialResult operator()(const std::vector<Perturbation>& wanted,
                                       std::optional<Duration> longest_apart = {}) const;
  /// What the device says then, beside what it says otherwise.
  [[nodiscard]] std::optional<Apart> apart_after(const std::vector<Perturbation>& wanted) const;
  /// What it says when nothing is perturbed.
  [[nodiscard]] const TrialResult& undisturbed() const noexcept;
  /// How many copies of the device are kept.
  [[nodiscard]] std::size_t copies() const noexcept;

 private:
  class Impl;
  explicit RecordedTalk(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

/// Tells a judge what passes, and keeps what the device says. Bytes of it that are no message, and
/// a connection that it ends, break `device`.
class TrialWitness final : public Overhearer {
 public:
  /// `judge` may be nullptr. It has to outlive this.
  TrialWitness(MakeDissector make_dissector, TrialJudge* judge);

  void to_device(Instant time, Bytes bytes) override;
  void from_device(Instant time, Bytes bytes) override;
  void on_connection(const ConnectionEvent& event) override;
  void on_bus(const BusPart& part) override;
  void on_input(Instant time, std::string_view name, std::int64_t value) override;
  void wait_until(Instant time) override;
  void overlook(Instant from, Instant to) override;

  [[nodiscard]] std::vector<SaidPiece> take_said() { return std::move(said_); }
  [[nodiscard]] std::vector<Breakage> finish();
  [[nodiscard]] std::size_t said() const noexcept { return said_.size(); }

 private:
  void look_at(Instant time, std::uint32_t lane, Direction direction, Bytes bytes);

  MakeDissector make_dissector_;
  TrialJudge* judge_;
  std::map<std::uint32_t, std::unique_ptr<Dissector>> dissectors_;
  std::vector<Message> messages_;
  std::vector<SaidPiece> said_;
  std::vector<Breakage> broken_;
};

}  // namespace armjig
