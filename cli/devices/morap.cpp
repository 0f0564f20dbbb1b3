// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/morap.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "cli/devices/devices.hpp"
#include "cli/devices/machines.hpp"
#include "cli/morap/commands.hpp"
#include "conformance/morap/host/check.hpp"
#include "conformance/morap/suite.hpp"
#include "emulators/morap/options.hpp"
#include "emulators/shadow/morap_figures.hpp"
#include "harness/console/morap/console.hpp"
#include "harness/latency/morap_follower.hpp"
#include "harness/latency/morap_probe.hpp"
#include "harness/rig/morap_judge.hpp"
#include "harness/wire/morap/controller_set.hpp"
#include "harness/wire/morap/dissector.hpp"

namespace armjig::morap {
namespace {

/// What depends on where in its tick a node was, parts of values among it, which are noise.
constexpr std::string_view kLiveRules = R"(
time_ms = 100
order = "free"
message = [{name = "noise", ignore = true}]
field = [
  {name = "angle", tolerance = 0.5},
  {name = "current", ignore = true},
  {name = "applied_voltage", ignore = true},
]
)";

/// The checksum of a controller set made right again, so that campaigns get past it.
void seal(std::span<std::byte> message) {
  constexpr std::size_t kBefore = 2;  // the address and the command
  if (message.size() <= kBefore || message[1] != static_cast<std::byte>(CommandId::kProgram))
    return;
  const auto set = message.subspan(kBefore);
  set.back() = static_cast<std::byte>(checksum(set.first(set.size() - 1)));
}

/// Accepted parameters wait for the next tick, and what comes to that place before is mixed with
/// them, byte by byte (docs/spec/morap.md, Parameters). A running loop ticks at its own rate.
Duration works_on(Bytes message) {
  constexpr Duration kMessage = std::chrono::milliseconds{3};
  constexpr Duration kSlowTick = std::chrono::milliseconds{20};
  constexpr std::array kProgramming{CommandId::kProgram, CommandId::kDefaultControllers,
                                    CommandId::kTune};
  const bool is_programming =
      !message.empty() &&
      std::ranges::find(kProgramming, static_cast<CommandId>(message.front())) !=
          kProgramming.end();
  return is_programming ? kMessage + kSlowTick : Duration{};
}

/// A loop with other parameters ticks elsewhere, and moves when it ticks.
bool strays(Bytes message) { return works_on(message) > Duration{}; }

}  // namespace

cli::Device device() {
  return {.name = "morap",
          .title = "MORAP motor nodes",
          .make_dissector = make_dissector,
          .port = cli::OnBus{{.make_judge = rig::make_judge,
                              .emulate = cli::hosted<emulation::make>,
                              .set_up = cli::hosted_like<replay::set_up>,
                              .make_bench = conformance::make_bench,
                              .open_console = console::open,
                              .watch = console::watch,
                              .make_probe = latency::make_probe,
                              .make_follower = latency::make_follower}},
          .options = emulation::options,
          .suite = conformance::suite,
          .mutants = conformance::mutants_entry,
          .make_listener = latency::make_listener,
          .program_check = programs::program_check(),
          .replay = {.run = replay::replay,
                     .run_plainly = replay::replay_plainly,
                     .write = replay::write,
                     .touches_of = replay::touches_of},
          .draw_session = sessions::draw,
          .live_rules = kLiveRules,
          .fuzz = {.seal = seal, .works_on = works_on, .strays = strays, .machines = machines()},
          .dissection = dissection,
          .figures = shadow::figures,
          .commands = {cli::add_i2c, cli::add_morap}};
}

}  // namespace armjig::morap
