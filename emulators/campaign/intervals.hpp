// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "harness/compare/recording_diff.hpp"

namespace armjig::campaign {

/// A field of answers that tells how long before what is answered the message before it came.
struct ToldInterval {
  std::string_view message;  ///< the kind of the answer
  std::string_view field;    ///< unsigned; begins at 0 again after its greatest value
  double ticks_per_second{};
};

/// Where the target tells an interval that cannot have been, however late something came: both
/// messages came after they were due, which is not long before the first of the models answers, and
/// before the target answered them. Allowed are 1 ms and a fiftieth beyond that, for a clock that
/// is not exact. Nothing where models, or the target, answer less often than others, or where
/// models do not keep to it themselves. The messages belong to the target and the first model.
[[nodiscard]] std::vector<RecordingDifference> false_intervals(
    const ToldInterval& told, const std::vector<RecordedMessages>& models,
    const RecordedMessages& target);

}  // namespace armjig::campaign
