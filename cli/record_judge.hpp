// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "emulators/replay/kept_record.hpp"
#include "harness/rig/judge.hpp"

namespace armjig::cli {

/// Tells what the guard of a device would refuse of records, before any of them is played: what was
/// asked for and not agreed to, as far as it does not depend on where the device is.
class RecordJudge {
 public:
  using MakeJudge = std::unique_ptr<Judge> (*)();
  explicit RecordJudge(MakeJudge make_judge) : make_judge_{make_judge} {}

  /// Records in order of time. What is not refused counts as passed.
  [[nodiscard]] std::optional<Refusal> refusal_of(const KeptRecord& record,
                                                  const Permissions& granted);

 private:
  MakeJudge make_judge_;
  std::map<std::uint32_t, std::unique_ptr<Judge>> judges_;  ///< of each connection
};

}  // namespace armjig::cli
