// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/demo.hpp"
#include "cli/devices/devices.hpp"
#include "conformance/demo/suite.hpp"
#include "emulators/demo/options.hpp"
#include "harness/console/generic.hpp"
#include "harness/latency/generic_probe.hpp"
#include "harness/rig/demo_judge.hpp"
#include "harness/wire/demo/demo.hpp"

namespace armjig::demo {
namespace {

Outcome<std::unique_ptr<DeviceConsole>> open_console(Rig<StreamPort> rig, const std::string& target,
                                                     Say say) {
  return generic::open(StreamLink{std::move(rig)}, make_dissector(), target, std::move(say));
}

Outcome<std::unique_ptr<Watched>> watch(Rig<StreamPort> rig, const std::string& /*target*/,
                                        const WatchHow& /*how*/) {
  const auto query = encode(Operation::kQuery);
  return generic::watch(StreamLink{std::move(rig)}, make_dissector(),
                        {{query.begin(), query.end()}});
}

std::unique_ptr<Probe> make_listener() {
  const auto query = encode(Operation::kQuery);
  return generic::make_probe("query to reply", {query.begin(), query.end()}, kMessageSize);
}

Outcome<std::unique_ptr<Probe>> make_probe(StreamPort& /*port*/, const std::string& /*target*/) {
  return make_listener();
}

}  // namespace

cli::Device device() {
  return {.name = "demo",
          .title = "the worked example, a device that nobody built",
          .make_dissector = make_dissector,
          .port = cli::OnStream{{.make_judge = rig::make_judge,
                                 .emulate = cli::hosted<emulation::make>,
                                 .make_bench = conformance::make_bench,
                                 .open_console = open_console,
                                 .watch = watch,
                                 .make_probe = make_probe}},
          .options = emulation::options,
          .suite = conformance::suite,
          .mutants = conformance::mutants_entry,
          .make_listener = make_listener,
          .replay = {.run = replay::replay},
          .dissection = dissection};
}

}  // namespace armjig::demo
