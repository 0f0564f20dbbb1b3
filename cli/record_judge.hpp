// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "emulators/replay/kept_record.hpp"
#include "harness/rig/judge.hpp"

namespace armjig::cli {

/// Tells what the guard of a device would refuse of records, before any of them is played.
class RecordJudge {
 public:
  using MakeJudge = std::unique_ptr<Judge> (*)();
  explicit RecordJudge(MakeJudge make_judge) : make_judge_{make_judge} {}

  /// Records in order of time. What was asked for and not agreed to, as far as it does not depend
  /// on where the device is. What is not refused counts as passed.
  [[nodiscard]] std::optional<Refusal> refusal_of(const KeptRecord& record,
                                                  const Permissions& granted);

  /// Leaves out of a script what would be refused at that moment if the device says that, and all
  /// that follows if it were stopped.
  void leave_out_refused(std::vector<KeptRecord>& script, const std::vector<KeptRecord>& said,
                         const Permissions& granted);

 private:
  /// The same, whatever it depends on.
  [[nodiscard]] std::optional<Refusal> any_refusal_of(const KeptRecord& record,
                                                      const Permissions& granted);
  /// Lets the judge hear what the device says, or what a bus carries.
  void observe(const KeptRecord& record);
  [[nodiscard]] Judge& judge_of(const KeptRecord& record);
  [[nodiscard]] bool must_stop();

  MakeJudge make_judge_;
  std::map<std::uint32_t, std::unique_ptr<Judge>> judges_;  ///< of each connection
};

}  // namespace armjig::cli
