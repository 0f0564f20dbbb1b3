// SPDX-License-Identifier: Apache-2.0
#include "cli/device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/beside.hpp"
#include "harness/core/nearest.hpp"

namespace armjig::cli {
namespace {

/// A part of an entry, and whether it is there.
struct Part {
  std::string_view name;
  bool is_there;
};

}  // namespace

std::vector<std::string_view> missing_parts(const Device& device) {
  std::vector<Part> parts{{"name", !device.name.empty()},
                          {"title", !device.title.empty()},
                          {"make_dissector", device.make_dissector != nullptr},
                          {"options", device.options != nullptr},
                          {"suite", device.suite != nullptr},
                          {"mutants", device.mutants != nullptr},
                          {"replay", device.replay.run != nullptr}};
  std::visit(
      [&parts](const auto& kind) {
        parts.insert(parts.end(), {{"make_judge", kind.make_judge != nullptr},
                                   {"emulate", kind.emulate != nullptr},
                                   {"make_bench", kind.make_bench != nullptr},
                                   {"open_console", kind.open_console != nullptr},
                                   {"watch", kind.watch != nullptr},
                                   {"make_probe", kind.make_probe != nullptr}});
      },
      device.port);
  std::vector<std::string_view> missing;
  for (const auto& part : parts) {
    if (!part.is_there) missing.push_back(part.name);
  }
  return missing;
}

Outcome<double> take_clock_rate(DeviceOptions& options, const std::string& where) {
  const auto said = options.find(kClock.name);
  if (said == options.end()) return 1;
  double percent = 0;
  const auto taken = OptionValue{kClock, said->second, where}.take(percent);
  options.erase(said);
  return taken.map([percent] { return 1 + percent / 100; });
}

std::string names_of(Devices devices) {
  std::string names;
  for (const auto& device : devices) {
    names.append(names.empty() ? "" : ", ").append(device.name);
  }
  return names;
}

Outcome<const Device*> find_device(Devices devices, std::string_view name) {
  const auto found = std::ranges::find(devices, name, &Device::name);
  if (found != devices.end()) return &*found;
  return problem(ErrorCode::kUnknownDevice, fmt::format("'{}'", name),
                 did_you_mean(name, devices, &Device::name) + "there are: " + names_of(devices));
}

const Device* find_recorded_device(Devices devices, std::string_view name) {
  auto found = std::ranges::find(devices, name, &Device::name);
  if (found == devices.end()) {
    found = std::ranges::find(devices, name.substr(0, name.find('-')), &Device::name);
  }
  return found == devices.end() ? nullptr : &*found;
}

std::vector<KnownBoard> known_boards(Devices devices) {
  std::vector<KnownBoard> boards;
  for (const auto& device : devices) {
    const auto* const stream = std::get_if<OnStream>(&device.port);
    if (stream != nullptr && stream->usb) boards.push_back({device.name, *stream->usb});
  }
  return boards;
}

Outcome<std::unique_ptr<DeviceConsole>> open_console(const Device& device, const RigOptions& how,
                                                     const std::string& target, Say say) {
  return with_rig(device, how, [&](const auto& kind, auto rig) {
    return kind.open_console(std::move(rig), target, std::move(say));
  });
}

Outcome<std::unique_ptr<Watched>> open_watched(const Device& device, const RigOptions& how,
                                               Duration period) {
  return with_rig(device, how, [&](const auto& kind, auto rig) {
    return kind.watch(std::move(rig), how.target.text, WatchHow{period, how.when_gone});
  });
}

Outcome<ProbedLink> open_probe(const Device& device, const RigOptions& how) {
  const auto& target = how.target.text;
  return with_rig(device, how, [&target](const auto& kind, auto rig) -> Outcome<ProbedLink> {
    auto probe = kind.make_probe(rig.port(), target);
    if (!probe) return tl::unexpected{probe.error()};
    const auto together = [&probe](StreamLink link) {
      return ProbedLink{std::move(link), *std::move(probe)};
    };
    if constexpr (std::is_same_v<decltype(rig), Rig<SessionSource>>) {
      return StreamLink::connect(std::move(rig), target).map(together);
    } else {
      return together(StreamLink{std::move(rig)});
    }
  });
}

Outcome<std::unique_ptr<Follower>> open_follower(const Device& device, const RigOptions& how) {
  using Opened = Outcome<std::unique_ptr<Follower>>;
  if (!how.target.is_emulated()) return bad_target(how.target.text, "only emulated joints are led");
  return with_rig(device, how, [&device](const auto& kind, auto rig) -> Opened {
    if (kind.make_follower != nullptr) return kind.make_follower(std::move(rig));
    return problem(ErrorCode::kUnsupported, std::string{device.name},
                   "it has no loop that jitter could cost anything");
  });
}

Outcome<std::unique_ptr<Bench>> open_bench(const Device& device, const RigOptions& how) {
  auto bench = with_rig(device, how, [&how](const auto& kind, auto rig) {
    return kind.make_bench(std::move(rig), how);
  });
  if (bench && how.target.is_emulated() && !how.impairment) {
    (*bench)->know_sessions(sessions_beside(device, how.target, device));
  }
  return bench;
}

}  // namespace armjig::cli
