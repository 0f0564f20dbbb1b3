// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/kinovazed.hpp"

#include <array>
#include <chrono>
#include <string_view>

#include "cli/devices/devices.hpp"
#include "cli/devices/machines.hpp"
#include "conformance/kinovazed/host/check.hpp"
#include "conformance/kinovazed/suite.hpp"
#include "emulators/kinovazed/options.hpp"
#include "emulators/replay/kinovazed_matrix.hpp"
#include "emulators/replay/kinovazed_rules.hpp"
#include "emulators/shadow/kinovazed_figures.hpp"
#include "harness/console/kinovazed/console.hpp"
#include "harness/latency/kinovazed_probe.hpp"
#include "harness/rig/kinovazed_judge.hpp"
#include "harness/wire/kinovazed/dissector.hpp"

namespace armjig::kinovazed {
namespace {

using namespace std::chrono_literals;

/// When in a second a server beats, it alone knows.
constexpr std::string_view kLiveRules = R"(
time_ms = 100
order = "free"
message = [{name = "Heartbeat", ignore = true}]
)";

/// How long an objective takes says where the arm was; what comes after it has to be waited for.
constexpr std::array<std::string_view, 3> kWayHome{
    "RunObjective:Home\r\n", "GetAbsolutePosition\r\n", "GetAbsolutePosition\r\n"};

}  // namespace

cli::Device device() {
  return {.name = "kinovazed",
          .title = "KinovaZED server",
          .make_dissector = make_dissector,
          .port = cli::OnServer{{.make_judge = rig::make_judge,
                                 .emulate = cli::hosted<emulation::make>,
                                 .set_up = cli::hosted_like<replay::set_up>,
                                 .make_bench = conformance::make_bench,
                                 .open_console = console::open,
                                 .watch = console::watch,
                                 .make_probe = latency::make_probe},
                                51717},
          .options = emulation::options,
          .suite = conformance::suite,
          .mutants = conformance::mutants_entry,
          .make_listener = latency::make_listener,
          .program_check = programs::program_check(),
          .replay = {.run = replay::replay,
                     .compare = replay::session_difference,
                     .write = replay::write,
                     .touches_of = replay::touches_of,
                     .verify_table = replay::verify_matrix},
          .draw_session = sessions::draw,
          .live_rules = kLiveRules,
          .fuzz = {.epilogue = {kWayHome, 2s}, .machines = machines()},
          .dissection = dissection,
          .figures = shadow::figures};
}

}  // namespace armjig::kinovazed
