// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "conformance/program_checker.hpp"
#include "emulators/memory/hosted.hpp"
#include "harness/report/report.hpp"

namespace armjig {

/// Judges the program that talks to an emulated device, by what passes between them. Not to be
/// moved once it watches one; what it watches may run in another thread.
class ProgramCheck {
 public:
  /// `on_offence` is told of each as it happens.
  ProgramCheck(const ProgramCheckEntry& entry, const LinkNoise& noise,
               std::function<void(const Offence&)> on_offence);

  /// The same device, overheard, perhaps in another thread. `this` must outlive it. Of a bus the
  /// checker hears each message when it is over: the byte with address and direction, then the data
  /// bytes, of both what was acknowledged.
  [[nodiscard]] std::unique_ptr<HostedStream> watch(std::unique_ptr<HostedStream> device);
  [[nodiscard]] std::unique_ptr<HostedServer> watch(std::unique_ptr<HostedServer> server);
  [[nodiscard]] std::unique_ptr<HostedBus> watch(std::unique_ptr<HostedBus> bus);

  /// Ends the session: a row for each requirement, in the order of the catalogue.
  [[nodiscard]] Report finish();

  /// How often the requirement of that id was broken so far.
  [[nodiscard]] std::size_t count(std::string_view requirement) const;

 private:
  template <class Hosted>
  class Overheard;
  template <class Hosted>
  class OverheardSender;
  class OverheardStream;
  class OverheardServer;
  class OverheardBus;
  struct Record {
    std::size_t count = 0;
    std::vector<Offence> first;
  };

  template <class Show>
  void hear(Show show);
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
