// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/program_checker.hpp"
#include "emulators/memory/overheard.hpp"
#include "harness/core/overhearer.hpp"
#include "harness/report/report.hpp"

namespace armjig {

/// Judges the program that talks to a device, by what passes between them: `overhear` has an
/// emulated device tell it. May be told in one thread and asked in another.
class ProgramCheck final : public Overhearer {
 public:
  /// `on_offence` is told of each as it happens.
  ProgramCheck(const ProgramCheckEntry& entry, const LinkNoise& noise,
               std::function<void(const Offence&)> on_offence);

  /// The same device, overheard. `this` must outlive it.
  template <class Hosted>
  [[nodiscard]] std::unique_ptr<Hosted> watch(std::unique_ptr<Hosted> device) {
    return overhear(std::move(device), *this);
  }

  // What passes. Of a bus the checker hears each message when it is over: the byte with address and
  // direction, then the data bytes, of both what was acknowledged.
  void to_device(Instant time, Bytes bytes) override;
  void from_device(Instant time, Bytes bytes) override;
  void on_connection(const ConnectionEvent& event) override;
  void on_bus(const BusPart& part) override;
  void wait_until(Instant time) override;
  void overlook(Instant from, Instant to) override;

  /// Ends the session: a row for each requirement, in the order of the catalogue.
  [[nodiscard]] Report finish();

  /// How often the requirement of that id was broken so far.
  [[nodiscard]] std::size_t count(std::string_view requirement) const;

 private:
  struct Record {
    std::size_t count = 0;
    std::vector<Offence> first;
  };

  template <class Show>
  void hear(Show show);
  /// What the program did at that time.
  template <class Show>
  void hear_program(Instant time, Show show);
  void take_offences();
  [[nodiscard]] ReportRow row_of(const Requirement& requirement) const;

  mutable std::mutex guard_;
  ProgramCheckEntry entry_;
  std::unique_ptr<ProgramChecker> checker_;
  std::function<void(const Offence&)> on_offence_;
  Instant now_{};
  std::map<std::string_view, Record> records_;  ///< by requirement
};

}  // namespace armjig
