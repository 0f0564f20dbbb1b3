// SPDX-License-Identifier: Apache-2.0
#include "cli/verifying.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "cli/device.hpp"
#include "emulators/replay/on_port.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/nesting.hpp"
#include "harness/core/text_member.hpp"
#include "harness/files/user_file.hpp"
#include "harness/rig/target.hpp"

namespace armjig::cli {
namespace {

/// The device of a table; nullptr if none here has tables.
const Device* device_of_table(const std::string& text, Devices devices) {
  const auto table = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  const auto name = table.is_object() ? table.value("device", nlohmann::json{}) : nlohmann::json{};
  for (const auto& device : devices) {
    const bool is_named = !name.is_string() || name.get<std::string>() == device.name;
    if (is_named && device.replay.verify_table != nullptr) return &device;
  }
  return nullptr;
}

Outcome<TableVerdict> verdict_of_table(const std::string& path, Devices devices) {
  const auto text = read_user_file(path);
  if (!text) return tl::unexpected{text.error()};
  if (is_too_deep(*text)) return problem(ErrorCode::kMalformed, path, std::string{kTooDeep});
  const auto* const device = device_of_table(*text, devices);
  if (device != nullptr) return device->replay.verify_table(*text, path);
  return problem(ErrorCode::kUnsupported, path,
                 "no emulator here is verified by tables of that device");
}

Outcome<Verified> verify_table(const std::string& path, Devices devices) {
  return verdict_of_table(path, devices).map([](const TableVerdict& verdict) {
    Verified verified{.is_identical = verdict.differences.empty(), .cells = verdict.cells};
    for (const auto& [cell, recorded, actual] : verdict.differences) {
      verified.what +=
          fmt::format("  {}\n    recorded {}\n    emulated {}\n", cell, recorded, actual);
    }
    return verified;
  });
}

/// Of the header; empty if it has none.
std::string title_of(const Trace& trace) {
  const auto header = nlohmann::json::parse(trace.header, nullptr, /*allow_exceptions=*/false);
  return text_member(header, "title");
}

/// By a device like the one that was recorded, on a port in memory.
Outcome<std::optional<TraceDifference>> verify_capture(const Trace& trace, const Device& device) {
  const auto text = emulated_target_of(trace);
  if (!text) return tl::unexpected{text.error()};
  const auto target = parse_target(*text);
  if (!target) return tl::unexpected{target.error()};
  return std::visit(
      [&](const auto& kind) -> Outcome<std::optional<TraceDifference>> {
        const auto port = wiring_of(device, kind).open_emulated(*target);
        if (!port) return tl::unexpected{port.error()};
        const auto replayed = replay_on(**port, trace);
        if (!replayed) return tl::unexpected{replayed.error()};
        if (replayed->recorded.empty()) {
          return problem(ErrorCode::kMalformed, trace.path, "no answer is in there to be verified");
        }
        return first_difference(replayed->recorded, replayed->actual);
      },
      device.port);
}

Outcome<const Device*> device_of(const Trace& trace, Devices devices) {
  const auto* const device = find_recorded_device(devices, trace.device);
  if (device != nullptr) return device;
  return problem(ErrorCode::kUnknownDevice, trace.path,
                 fmt::format("no emulator replays '{}' here", trace.device));
}

struct KnownTrace {
  Trace trace;
  const Device* device{};
};

Outcome<KnownTrace> read_known(const std::string& path, Devices devices) {
  auto trace = read_trace(path);
  if (!trace) return tl::unexpected{trace.error()};
  return device_of(*trace, devices).map([&](const Device* device) {
    return KnownTrace{*std::move(trace), device};
  });
}

}  // namespace

Outcome<Verified> verify_recording(const std::string& path, Devices devices) {
  if (path.ends_with(".json")) return verify_table(path, devices);
  return read_known(path, devices).and_then([](const KnownTrace& known) -> Outcome<Verified> {
    const auto& [trace, device] = known;
    const bool is_captured = is_of_capture(trace.header);
    const auto difference =
        is_captured ? verify_capture(trace, *device) : verify(trace, device->replay);
    if (!difference) return tl::unexpected{difference.error()};
    return Verified{
        .is_identical = !*difference,
        .device = trace.device,
        .title = title_of(trace),
        .what = *difference ? describe(**difference, trace, device->make_dissector) : "",
        .is_of_capture = is_captured};
  });
}

Outcome<std::string> renewed_recording(const std::string& path, Devices devices) {
  return read_known(path, devices).and_then([](KnownTrace known) {
    return record(stimulus_of(std::move(known.trace)), known.device->replay);
  });
}

Outcome<std::string> target_of_recording(const std::string& path) {
  return read_trace(path).and_then(emulated_target_of);
}

}  // namespace armjig::cli
