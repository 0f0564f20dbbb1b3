// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "conformance/program_checker.hpp"
#include "conformance/requirement.hpp"
#include "emulators/host/hosted_server.hpp"
#include "emulators/host/hosted_stream.hpp"
#include "harness/report/report.hpp"

namespace armjig {

/// What is demanded of programs that talk to a device, and who judges it.
struct ProgramCheckEntry {
  std::string_view device;
  std::span<const Requirement> (*requirements)() noexcept;
  std::unique_ptr<ProgramChecker> (*make)(const LinkNoise& noise);
};

/// Devices whose programs can be judged.
[[nodiscard]] std::span<const ProgramCheckEntry> program_checks() noexcept;

/// Judges the program that talks to an emulated device. Not to be moved once it watches one.
class ProgramCheck {
 public:
  /// `on_offence` is told of each as it happens.
  ProgramCheck(const ProgramCheckEntry& entry, const LinkNoise& noise,
               std::function<void(const Offence&)> on_offence);

  /// The same device, overheard. `this` must outlive it.
  [[nodiscard]] std::unique_ptr<HostedStream> watch(std::unique_ptr<HostedStream> device);
  [[nodiscard]] std::unique_ptr<HostedServer> watch(std::unique_ptr<HostedServer> server);

  /// What passed on a link that is no byte stream, in the order of time; as much at a time as the
  /// checker of the device wants to see.
  void to_device(Instant time, Bytes bytes);
  void from_device(Instant time, Bytes bytes);

  /// Ends the session: a row for each requirement, in the order of the catalogue.
  [[nodiscard]] Report finish();

  /// How often the requirement of that id was broken so far.
  [[nodiscard]] std::size_t count(std::string_view requirement) const noexcept;

 private:
  class Overheard;
  class OverheardServer;
  struct Record {
    std::size_t count = 0;
    std::vector<Offence> first;
  };

  void take_offences();
  [[nodiscard]] ReportRow row_of(const Requirement& requirement) const;

  const ProgramCheckEntry& entry_;
  std::unique_ptr<ProgramChecker> checker_;
  std::function<void(const Offence&)> on_offence_;
  Instant now_{};
  std::map<std::string_view, Record> records_;  ///< by requirement
};

}  // namespace armjig
