// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/options.hpp"

#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include "emulators/kinovazed/bench_arm.hpp"
#include "emulators/kinovazed/defects/faults.hpp"
#include "emulators/kinovazed/jaco_arm.hpp"

namespace armjig::kinovazed::emulation {
namespace {

struct Settings {
  OptionFiles files;
  Plant plant = JacoArm{};
  ServerOptions server;
  std::vector<Quirk> quirks;
};

// Later rows change what earlier ones have set.
constexpr auto kTable = std::to_array<DeviceOption<Settings>>({
    {{"profile", "firmware|documented",
      "the server as shipped (the default), or as its document promises"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.server.behaviour, {kFirmwareBehaviour, kDocumentedBehaviour});
     }},
    {{"plant", "jaco|bench", "a realistic arm (the default), or that of the recordings"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.plant, {JacoArm{}, BenchArm{}});
     }},
    {{"objectives", "FILE",
      "the way-points, as the server's own JSON file; the published set if not given"},
     [](Settings& to, const OptionValue& value) {
       std::string path;
       return value.take(path)
           .and_then([&] { return to.files.read_text(path); })
           .and_then([&](const std::string& text) { return parse_objectives(text, path); })
           .map([&](ObjectiveSet objectives) { to.server.objectives = std::move(objectives); });
     }},
    {{"on-death", "stay|restart",
      "when the original's process would end: refuse connections from then on (the default), or "
      "come back after two seconds"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.server.on_death, {OnDeath::kStay, OnDeath::kRestart});
     }},
    {{"race", "reply|event|random",
      "what comes first when an action is over the moment it is asked for; the reply if not "
      "given"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.server.race,
                           {RaceOrder::kReplyFirst, RaceOrder::kEventFirst, RaceOrder::kRandom});
     }},
    {{"call-us",
      "0..500000",
      "length of a call to the arm in microseconds; 600 if not given",
      {50, 50'000, 600, FitRange::Scale::kRatio, true}},
     [](Settings& to, const OptionValue& value) {
       std::chrono::microseconds time{};
       return value.take(time).map([&] { to.server.call_time = time; });
     }},
    {{"fault", "FAULT,...",
      "defects, as `armjig conformance mutants kinovazed --list` names them, as in "
      "missing:Unfolded"},
     [](Settings& to, const OptionValue& value) {
       return value.take_each(
           [&](std::string_view text) { return add_fault(text, to.server, to.quirks); });
     }},
});
constexpr auto kRows = rows_of(kTable);

}  // namespace

std::span<const OptionRow> options() noexcept { return kRows; }

Outcome<DefectiveServer> make(const DeviceOptions& options, const std::string& where,
                              const OptionFiles& files) {
  return read_options("kinovazed", kTable, options, where, Settings{files})
      .map([](Settings settings) {
        return DefectiveServer{Server{ArmPort{settings.plant}, std::move(settings.server)},
                               std::move(settings.quirks)};
      });
}

}  // namespace armjig::kinovazed::emulation
