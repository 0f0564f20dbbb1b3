// SPDX-License-Identifier: Apache-2.0
#include "cli/record.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/presented.hpp"
#include "cli/serving.hpp"
#include "cli/terminal.hpp"

namespace armjig::cli {
namespace {

constexpr auto kRecordHelp =
    "Stands between a program and a device, passes every byte on, and records it.\n"
    "\n"
    "  armjig record DEVICE --listen pty:/tmp/arm --target TARGET --out session.pcapng\n"
    "  armjig record DEVICE --listen tcp:4000 --target tcp:HOST:PORT --out session.jsonl\n"
    "  armjig record DEVICE --listen i2c:1 --target emulated: --out session.pcapng\n"
    "\n"
    "Start the program on what it prints in place of the device; on a bus with the environment\n"
    "that it prints. It is a cable: nothing is changed, held back or refused, whatever the "
    "program\n"
    "sends. With --check the program is judged as by 'armjig emulate --check'. When this process\n"
    "was late itself, it says so, and holds it against nobody. Ctrl-C ends it, with a whole file.\n"
    "\n"
    "With --shadow emulated: an emulated device hears the same program beside it. Where what they "
    "say\n"
    "parts is told at once, with the fields, and when they agree again.\n"
    "\n"
    "Exit codes: 0 recorded, 1 findings of --check or --shadow, 3 the device is not there, or "
    "gone.";

void print_lateness(const RelayStatistics& statistics) {
  const auto us = [](Duration duration) {
    return std::chrono::duration<double, std::micro>{duration}.count();
  };
  if (statistics.pieces > 0) {
    fmt::print(stderr,
               "armjig: {} pieces passed on, each held for {:.1f} us, the longest {:.1f} us\n",
               statistics.pieces, us(statistics.held) / static_cast<double>(statistics.pieces),
               us(statistics.longest_held));
  }
  if (statistics.overlooks > 0) {
    fmt::print(stderr,
               "armjig: late itself {} times, {:.3f} s together; nobody is blamed for that\n",
               statistics.overlooks, std::chrono::duration<double>{statistics.overlooked}.count());
  }
}

}  // namespace

Exit record(Devices devices, const RecordOptions& options) {
  const auto found = find_device(devices, options.device);
  if (!found) return report(found.error());
  const auto& device = **found;
  const auto target = parse_target(options.target);
  if (!target) return report(target.error());
  auto serving = parse_listen(options.listen, device);
  if (!serving) return report(serving.error());
  if (options.is_quiet) serving->how.log = [](std::string_view /*line*/) {};
  const auto check = check_if(options.wants_check, device, 1);
  if (!check) return report(check.error());
  const auto files = ReportOutputs::open(options.files, options.wants_json ? "--json" : "");
  if (!files) return report(files.error());
  const auto file = open_capture_file("--out", options.capture);
  if (!file) return report(file.error());
  auto shadow = LiveShadow::open(device, *target, options.shadow);
  if (!shadow) return report(shadow.error());
  const auto presented =
      Presented::open(device, {.target = *target,
                               .capture = *file,
                               .witness = *shadow ? &(*shadow)->overhearer() : nullptr,
                               .check = check->get()});
  if (!presented) return report(presented.error());
  std::vector<ToServe> served;
  served.push_back({(*presented)->take(), *std::move(serving)});
  const auto done =
      serve(std::move(served), {.wants_json = options.wants_json, .is_quiet = options.is_quiet});
  if (!done) return report(done.error());
  const auto& statistics = (*presented)->relayed();
  if (!options.is_quiet) print_lateness(statistics);
  auto exit =
      *check ? conclude(**check, options.wants_json, options.colour, *files) : Exit::kPassed;
  if (*shadow) {
    const auto beside = (*shadow)->conclude();
    if (exit == Exit::kPassed && beside == Exit::kFindings) exit = beside;
  }
  if (!statistics.failure) return exit;
  (void)report(
      {statistics.failure->code, options.target, "the device has gone; what passed is kept"});
  return exit == Exit::kFindings ? exit : Exit::kRig;
}

void add_record(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("record", with_example(kRecordHelp, devices));
  const auto options = std::make_shared<RecordOptions>();
  add_device_argument(*command, options->device, devices);
  command
      ->add_option("--listen", options->listen,
                   "where the program finds it: pty:[PATH], tcp:[HOST:]PORT, "
                   "rfc2217:[HOST:]PORT, i2c:N")
      ->type_name("PLACE")
      ->required();
  command->add_option("--target", options->target, "where the device is, as everywhere")
      ->type_name("TARGET")
      ->required();
  add_capture_options(*command, options->capture, "--out")->required();
  command->add_flag("--json", options->wants_json,
                    "say where it listens as one line of JSON; the report of --check too");
  add_program_check(*command, options->wants_check, options->files, options->colour);
  add_shadow_options(*command, options->shadow);
  when_chosen(*command, action, [options, devices] { return record(devices, *options); });
}

}  // namespace armjig::cli
