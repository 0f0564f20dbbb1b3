// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/parol6.hpp"

#include <array>
#include <string_view>

#include "cli/devices/devices.hpp"
#include "cli/devices/machines.hpp"
#include "cli/parol6/commands.hpp"
#include "conformance/parol6/host/check.hpp"
#include "conformance/parol6/suite.hpp"
#include "emulators/parol6/options.hpp"
#include "emulators/shadow/parol6_figures.hpp"
#include "harness/console/parol6/console.hpp"
#include "harness/latency/parol6_follower.hpp"
#include "harness/latency/parol6_probe.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {
namespace {

/// What depends on the microsecond at which a frame came: how long ago the one before it did, and
/// how far joints have moved meanwhile.
constexpr std::string_view kLiveRules = R"(
time_ms = 100
order = "free"
field = [
  {name = "timing", ignore = true},
  {name = "position.j1", tolerance = 1000}, {name = "position.j2", tolerance = 1000},
  {name = "position.j3", tolerance = 1000}, {name = "position.j4", tolerance = 1000},
  {name = "position.j5", tolerance = 1000}, {name = "position.j6", tolerance = 1000},
]
)";

/// Where a joint is, a campaign knows to a thousand steps, and so not when it meets its switch.
bool strays(Bytes message) {
  if (message.size() != kCommandFrameSize) return false;
  const auto code = decode_command(body_of(message.first<kCommandFrameSize>())).command;
  return code == Command::kHome || code == Command::kDemo;
}
constexpr std::array<std::string_view, 13> kAstrayFields{
    "homed",       "position.j1", "position.j2", "position.j3", "position.j4",
    "position.j5", "position.j6", "speed.j1",    "speed.j2",    "speed.j3",
    "speed.j4",    "speed.j5",    "speed.j6"};

}  // namespace

cli::Device device() {
  return {.name = "parol6",
          .title = "PAROL6 control board",
          .make_dissector = make_dissector,
          .port = cli::OnStream{{.make_judge = rig::make_judge,
                                 .emulate = cli::hosted<emulation::make>,
                                 .set_up = cli::hosted_like<replay::set_up>,
                                 .make_bench = conformance::make_bench,
                                 .open_console = console::open,
                                 .watch = console::watch,
                                 .make_probe = latency::make_probe,
                                 .make_follower = latency::make_follower},
                                std::nullopt,
                                UsbId{0x0483, 0x5740}},
          .options = emulation::options,
          .suite = conformance::suite,
          .mutants = conformance::mutants_entry,
          .make_listener = latency::make_listener,
          .program_check = programs::program_check(),
          .replay = {.run = replay::replay,
                     .run_plainly = replay::replay_plainly,
                     .touches_of = replay::touches_of},
          .draw_session = sessions::draw,
          .live_rules = kLiveRules,
          .fuzz = {.strays = strays,
                   .astray_fields = kAstrayFields,
                   .told_interval = {{.message = "telemetry",
                                      .field = "timing",
                                      .ticks_per_second = kTicksPerSecond}},
                   .machines = machines()},
          .dissection = dissection,
          .figures = shadow::figures,
          .watch_rate = 100,
          .commands = {cli::add_plan, cli::add_run, cli::add_script}};
}

}  // namespace armjig::parol6
