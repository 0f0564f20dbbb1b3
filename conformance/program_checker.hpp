// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// A program broke a requirement of role host.
struct Offence {
  Instant time{};
  std::string_view requirement;
  std::string what;  ///< one sentence: what it did, with the numbers
};

/// Judges the program at the other end of a device's link by what passes both ways, without any
/// I/O. Times never decrease. One for each session of a device, from its power-up.
class ProgramChecker {
 public:
  ProgramChecker() = default;
  ProgramChecker(const ProgramChecker&) = delete;
  ProgramChecker& operator=(const ProgramChecker&) = delete;
  virtual ~ProgramChecker() = default;

  virtual void to_device(Instant time, Bytes bytes) = 0;
  virtual void from_device(Instant time, Bytes bytes) = 0;
  /// Nothing more will come.
  virtual void finish(Instant time) = 0;

  /// Whole messages that the program has sent.
  [[nodiscard]] virtual std::size_t messages() const noexcept = 0;

  /// What was found since the last call, oldest first.
  [[nodiscard]] std::vector<Offence> take_offences() { return std::exchange(offences_, {}); }

 protected:
  void add(Instant time, std::string_view requirement, std::string what) {
    offences_.push_back({time, requirement, std::move(what)});
  }

 private:
  std::vector<Offence> offences_;
};

/// What a link adds to the times at which a program's bytes are seen; zero in virtual time.
struct LinkNoise {
  Duration most{};
};

}  // namespace armjig
