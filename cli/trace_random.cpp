// SPDX-License-Identifier: Apache-2.0
#include "cli/trace_random.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <limits>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "harness/capture/trace.hpp"
#include "harness/report/output_file.hpp"

namespace armjig::cli {
namespace {

constexpr auto kTraceRandomHelp =
    "Writes sessions that nobody wrote: recordings of an emulated device of profile firmware and\n"
    "of clients that do everything, also what is wrong, in an order and at times drawn at random.\n"
    "\n"
    "  armjig trace random DEVICE --out sessions               one session\n"
    "  armjig trace random DEVICE --out sessions --count 100   of seeds 1 to 100\n"
    "\n"
    "A seed gives the same file on every machine. 'armjig trace verify' finds no difference in it\n"
    "until an emulator changes.";

constexpr std::uint64_t kMostSessions = 1'000'000;

struct TraceRandomOptions {
  std::string device;
  std::uint64_t seed = 1;
  std::uint64_t count = 1;
  std::string folder;
};

Outcome<void> write_session(const Device& device, std::uint64_t seed,
                            const std::filesystem::path& folder) {
  const auto path = (folder / fmt::format("{}-{}.jsonl", device.name, seed)).string();
  const auto recording =
      parse_trace(path, device.draw_session(seed)).and_then([&](const Trace& stimulus) {
        return record(stimulus, device.replay);
      });
  if (!recording) return tl::unexpected{recording.error()};
  return OutputFile::open(path).and_then([&](const auto& file) { return file->put(*recording); });
}

Exit write_sessions(const TraceRandomOptions& options, Devices devices) {
  const auto device = find_device(devices, options.device);
  if (!device) return report(device.error());
  if ((*device)->draw_session == nullptr) {
    return report(
        Problem{ErrorCode::kUnsupported, options.device, "no sessions are drawn of that device"});
  }
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) return report(Problem{ErrorCode::kCannotWrite, options.folder, error.message()});
  for (std::uint64_t i = 0; i < options.count; ++i) {
    const auto written = write_session(**device, options.seed + i, options.folder);
    if (!written) return report(written.error());
  }
  fmt::print("sessions: {} of seeds {} to {}\n", options.count, options.seed,
             options.seed + options.count - 1);
  return Exit::kPassed;
}

}  // namespace

void add_trace_random(CLI::App& trace, Devices devices, Action& action) {
  auto* random = trace.add_subcommand("random", with_example(kTraceRandomHelp, devices));
  const auto options = std::make_shared<TraceRandomOptions>();
  add_device_argument(*random, options->device, devices);
  random->add_option("--seed", options->seed, "of the first session; 1 if not given")
      ->transform(whole(0, std::numeric_limits<std::uint64_t>::max()));
  random->add_option("--count", options->count, "how many; the seeds follow each other")
      ->transform(whole(1, kMostSessions));
  random->add_option("--out", options->folder, "the folder they go to")->required();
  when_chosen(*random, action, [options, devices] { return write_sessions(*options, devices); });
}

}  // namespace armjig::cli
