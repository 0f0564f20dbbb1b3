// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "emulators/replay/demo.hpp"
#include "emulators/replay/kinovazed.hpp"
#include "emulators/replay/kinovazed_rules.hpp"
#include "emulators/replay/morap.hpp"
#include "emulators/replay/parol6.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "harness/wire/demo/demo.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "harness/wire/parol6/dissector.hpp"

namespace armjig::test {

/// What recordings of a device need, for programs without the entries of `cli/devices`.
struct RecordedDevice {
  std::string_view name;
  MakeDissector make_dissector;
  Replay replay;
};

inline constexpr std::array kRecordedDevices{
    RecordedDevice{"demo", demo::make_dissector, {.run = demo::replay::replay}},
    RecordedDevice{"kinovazed",
                   kinovazed::make_dissector,
                   {.run = kinovazed::replay::replay,
                    .compare = kinovazed::replay::session_difference,
                    .write = kinovazed::replay::write}},
    RecordedDevice{"morap",
                   morap::make_dissector,
                   {.run = morap::replay::replay,
                    .run_plainly = morap::replay::replay_plainly,
                    .write = morap::replay::write}},
    RecordedDevice{"parol6",
                   parol6::make_dissector,
                   {.run = parol6::replay::replay, .run_plainly = parol6::replay::replay_plainly}},
};

/// The device of a recording, or its family: `morap-node` is recorded of morap. nullptr: neither.
[[nodiscard]] inline const RecordedDevice* recorded_device(const Trace& trace) {
  const auto family = std::string_view{trace.device}.substr(0, trace.device.find('-'));
  const auto* const found = std::ranges::find(kRecordedDevices, family, &RecordedDevice::name);
  return found == kRecordedDevices.end() ? nullptr : found;
}

}  // namespace armjig::test
