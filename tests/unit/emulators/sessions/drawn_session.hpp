// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

#include "emulators/replay/replay.hpp"
#include "emulators/sessions/sessions.hpp"
#include "tests/portable/recorded_devices.hpp"

namespace armjig::test {

struct DrawnDevice {
  std::string_view name;
  DrawSession draw;
  std::uint64_t hash;  ///< of the first forty sessions, one behind the other
};
inline std::ostream& operator<<(std::ostream& out, const DrawnDevice& device) {
  return out << device.name;
}

inline constexpr std::array kDrawnDevices{
    DrawnDevice{"parol6", parol6::sessions::draw, 0xFC5781E6D7119390U},
    DrawnDevice{"morap", morap::sessions::draw, 0x87B41FCB10477912U},
    DrawnDevice{"kinovazed", kinovazed::sessions::draw, 0x89AEF6F3D35BB976U}};

[[nodiscard]] inline Outcome<std::string> recording_of(const DrawnDevice& device,
                                                       const Roll& roll) {
  return parse_trace("drawn", device.draw(roll)).and_then([](const Trace& stimulus) {
    return record(stimulus, recorded_device(stimulus)->replay);
  });
}

[[nodiscard]] inline std::string words(const std::optional<TraceDifference>& difference,
                                       const Trace& trace) {
  if (!difference) return "";
  return describe(*difference, trace, recorded_device(trace)->make_dissector);
}

/// What is wrong with the recording of a session; empty if it verifies.
[[nodiscard]] inline std::string complaint_about_recording(const DrawnDevice& device,
                                                           const Roll& roll) {
  const auto text = recording_of(device, roll);
  if (!text) return describe(text.error());
  const auto trace = parse_trace("drawn", *text);
  if (!trace) return describe(trace.error());
  const auto difference = verify(*trace, recorded_device(*trace)->replay);
  return difference ? words(*difference, *trace) : describe(difference.error());
}

/// Where the emulator and its plain model differ in a session; empty if they do not, or if there is
/// no such model.
[[nodiscard]] inline std::string complaint_about_plain_model(const DrawnDevice& device,
                                                             const Roll& roll) {
  const auto stimulus = parse_trace("drawn", device.draw(roll));
  if (!stimulus) return describe(stimulus.error());
  const auto& replay = recorded_device(*stimulus)->replay;
  if (replay.run_plainly == nullptr) return "";
  const auto fast = replay.run(*stimulus);
  const auto plain = replay.run_plainly(*stimulus);
  if (!fast || !plain) return "not a session";
  return words(first_difference(plain->actual, fast->actual), *stimulus);
}

}  // namespace armjig::test
