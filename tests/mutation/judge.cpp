// SPDX-License-Identifier: Apache-2.0
// Tells whether an emulator in a shared object is the one of this program, and whether the suite of
// its device finds it out.
//
//   mutation_judge DEVICE OBJECT RECORDINGS SESSIONS TARGET
//
// Prints a line "differs: WHERE" or "same", then "killed: CASE" or "survived: N cases passed". The
// second is left out where the first says "same".
#include <dlfcn.h>
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "conformance/run.hpp"
#include "harness/capture/trace.hpp"
#include "harness/rig/target.hpp"
#include "tests/mutation/judged.hpp"

namespace armjig::mutation {
namespace {

bool differs(const Trace& trace, const cli::Device& device, const Judged& judged) {
  auto replay = device.replay;
  replay.run = judged.replay;
  const auto difference = verify(trace, replay);
  return !difference || difference->has_value();
}

/// The recording or session that tells the two apart; empty if none does.
std::string told_apart_by(const cli::Device& device, const Judged& judged,
                          const std::string& recordings, std::uint64_t sessions) {
  const auto files = find_traces({recordings});
  for (const auto& path : files.value_or(std::vector<std::string>{})) {
    const auto trace = read_trace(path);
    if (trace && differs(*trace, device, judged)) return path.substr(recordings.size() + 1);
  }
  for (std::uint64_t seed = 1; seed <= sessions; ++seed) {
    const auto recording =
        parse_trace("", device.draw_session(seed)).and_then([&](const Trace& stimulus) {
          return record(stimulus, device.replay);
        });
    const auto trace = parse_trace("", recording.value_or(""));
    if (trace && differs(*trace, device, judged)) return fmt::format("session {}", seed);
  }
  return "";
}

/// What the suite says: the first case that fails, or how many passed.
Outcome<std::string> judgement(const cli::Device& device, const Judged& judged,
                               std::string_view text) {
  return std::visit(
      [&](const auto& kind) -> Outcome<std::string> {
        using Kind = std::remove_cvref_t<decltype(kind)>;
        using Hosted = std::unique_ptr<typename Kind::Hosted>;
        auto judged_kind = kind;
        auto wiring = cli::wiring_of(device, judged_kind);
        wiring.open_emulated = [&](const Target& target) {
          return judged.emulate(target.options, target.text).map([](AnyHosted hosted) {
            return open_in_memory(std::get<Hosted>(std::move(hosted)));
          });
        };
        auto target = parse_target(text);
        if (!target) return tl::unexpected{target.error()};
        const RigOptions how{.target = *std::move(target)};
        auto rig = Rig<typename Kind::Port>::open(wiring, how);
        if (!rig) return tl::unexpected{rig.error()};
        auto bench = kind.make_bench(*std::move(rig), how);
        if (!bench) return tl::unexpected{bench.error()};
        RunOptions run;
        run.stops_at_first_failure = true;
        run.permissions = Permissions::all();
        const auto report = run_suite(device.suite(), **bench, run, [](const ReportRow&) {});
        for (const auto& row : report.rows) {
          if (row.verdict == Verdict::kFail || row.verdict == Verdict::kError) {
            return "killed: " + row.name;
          }
        }
        const auto passed = std::ranges::count(report.rows, Verdict::kPass, &ReportRow::verdict);
        return fmt::format("survived: {} cases passed", passed);
      },
      device.port);
}

int judge(std::span<char*> arguments) {
  const auto devices = cli::shipped_devices();
  const auto device = cli::find_device(devices, arguments[1]);
  if (!device) return 2;
  void* const object = dlopen(arguments[2], RTLD_NOW | RTLD_LOCAL);
  if (object == nullptr) {
    fmt::print(stderr, "{}\n", dlerror());
    return 2;
  }
  const auto entry = reinterpret_cast<const Judged* (*)()>(dlsym(object, kEntry));
  const auto& judged = *entry();
  const auto where =
      told_apart_by(**device, judged, arguments[3], std::strtoull(arguments[4], nullptr, 10));
  fmt::print("{}\n", where.empty() ? "same" : "differs: " + where);
  std::fflush(stdout);
  if (where.empty() && std::getenv("ARMJIG_JUDGE_ALL") == nullptr) return 0;
  const auto found = judgement(**device, judged, arguments[5]);
  if (!found) {
    fmt::print(stderr, "{}\n", describe(found.error()));
    return 2;
  }
  fmt::print("{}\n", *found);
  return 0;
}

}  // namespace
}  // namespace armjig::mutation

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  return armjig::mutation::judge({argv, static_cast<std::size_t>(argc)});
}
