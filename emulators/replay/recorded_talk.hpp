// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "emulators/replay/kept_record.hpp"
#include "emulators/replay/recorded_host.hpp"
#include "emulators/replay/what_if.hpp"

namespace armjig {

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

}  // namespace armjig
