// SPDX-License-Identifier: Apache-2.0
// Whatever stands in a recording: it is read or refused with a place and a reason, and what was
// read can be replayed.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "emulators/replay/replay.hpp"
#include "fuzz/require.hpp"
#include "harness/capture/trace.hpp"
#include "tests/portable/recorded_devices.hpp"

namespace armjig::fuzz {
namespace {

/// Long virtual times are legal, but cost real time: a replay is tried when no number in the header
/// reaches a second's microseconds.
bool is_quickly_replayed(std::string_view header) {
  constexpr std::ptrdiff_t kMostDigits = 6;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (auto it = header.begin(); it != header.end();) {
    it = std::find_if(it, header.end(), is_digit);
    const auto* const end = std::find_if_not(it, header.end(), is_digit);
    if (end - it > kMostDigits) return false;
    it = end;
  }
  return true;
}

void check_trace(std::string_view text) {
  const auto trace = parse_trace("input", text);
  if (!trace) {
    require(trace.error().where.starts_with("input:"), "a problem names its line");
    require(!trace.error().hint.empty(), "a problem says what is wrong");
    return;
  }
  const auto* const device = test::recorded_device(*trace);
  const auto make_dissector = device != nullptr ? device->make_dissector : nullptr;
  const auto all_missing = first_difference(trace->events, {});
  require(all_missing.has_value() == !trace->events.empty(), "missing events are a difference");
  if (all_missing) (void)describe(*all_missing, *trace, make_dissector);
  if (device == nullptr || !is_quickly_replayed(trace->header)) return;
  const auto difference = verify(*trace, device->replay);
  if (difference && *difference) (void)describe(**difference, *trace, make_dissector);
}

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::check_trace({reinterpret_cast<const char*>(data), size});
  return 0;
}
