// SPDX-License-Identifier: Apache-2.0
// Programs with an emulator that comes in a shared object (tests/mutation/judged.hpp).
//
//   mutation_judge judge DEVICE OBJECT TARGET quick|full FOLDER...
//
// tells whether a recording in those folders tells it from the emulator of this program, and
// whether the suite of its device finds it out, in that tier. Prints a line "differs: RECORDING" or
// "same", then "killed: CASE" or "survived: N cases passed". The second is left out where the first
// says "same", unless ARMJIG_JUDGE_ALL is set.
//
//   mutation_judge wire DEVICE OBJECT TARGET SESSIONS
//
// tells whether so many sessions that consist of nothing but bytes on a link, in virtual time, tell
// it from the emulator of this program. Prints what they differ in, or "same"; then that again
// where moments count that are further apart than `armjig fuzz` lets pass of a live device.
//
//   mutation_judge reach DEVICE OBJECT TARGET quick|full AGAIN
//
// tells whether the suite finds it out as over a link, where nobody has a hand at the device but
// for its input AGAIN, which starts it again, and a guard stands between; in virtual time. Prints
// "killed: CASE" or "survived: N cases passed".
//
//   mutation_judge serve DEVICE OBJECT ARGUMENT...
//
// is the armjig program, with those arguments, that has this emulator instead of its own.
#include <dlfcn.h>
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/beside.hpp"
#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "cli/program.hpp"
#include "conformance/run.hpp"
#include "harness/capture/trace.hpp"
#include "harness/compare/rules.hpp"
#include "harness/rig/target.hpp"
#include "tests/mutation/judged.hpp"
#include "tests/within_reach/within_reach.hpp"

namespace armjig::mutation {
namespace {

constexpr int kWrongUsage = 2;

/// What the object gives. Entries of devices have plain functions, which cannot keep it.
const Judged* judged = nullptr;

template <class Hosted>
Outcome<std::unique_ptr<Hosted>> emulate_judged(const DeviceOptions& options,
                                                const std::string& where) {
  return judged->emulate(options, where).map([](AnyHosted hosted) {
    return std::get<std::unique_ptr<Hosted>>(std::move(hosted));
  });
}

/// The device with the emulator of the object.
cli::Device with_judged(cli::Device device) {
  device.replay.run = judged->replay;
  std::visit(
      [](auto& kind) {
        kind.emulate = emulate_judged<typename std::remove_cvref_t<decltype(kind)>::Hosted>;
      },
      device.port);
  return device;
}

/// The recording that tells the two apart; empty if none does. Those that are soon replayed come
/// first, and one that cannot be replayed does so, too.
Outcome<std::string> told_apart_by(const cli::Device& device,
                                   const std::vector<std::string>& folders) {
  auto files = find_traces(folders);
  if (!files) return tl::unexpected{files.error()};
  std::ranges::sort(*files, {}, [](const auto& path) {
    return std::pair{std::filesystem::file_size(path), path};
  });
  for (const auto& path : *files) {
    const auto trace = read_trace(path);
    if (!trace) return tl::unexpected{trace.error()};
    const auto difference = verify(*trace, device.replay);
    if (!difference || difference->has_value()) return path;
  }
  return std::string{};
}

/// Nobody reads what they differ in, so it is not made shorter.
PlaySessions sessions_as_they_are(const cli::Device& device, const Target& target,
                                  const cli::Device& own) {
  return cli::sessions_beside(device, target, own, {.most_attempts = 0});
}

/// What the suite says: the first case that fails, or how many passed.
std::string judgement(const cli::Device& device, Bench& bench, Tier tier) {
  RunOptions run;
  run.selection.tier = tier;
  run.stops_at_first_failure = true;
  run.permissions = Permissions::all();
  const auto report = run_suite(device.suite(), bench, run, [](const ReportRow&) {});
  for (const auto& row : report.rows) {
    if (row.verdict == Verdict::kFail || row.verdict == Verdict::kError) {
      return "killed: " + row.name;
    }
  }
  return fmt::format("survived: {} cases passed",
                     std::ranges::count(report.rows, Verdict::kPass, &ReportRow::verdict));
}

/// The same with all that an emulated device offers. `own` has the emulator of this program.
std::string judgement_in_memory(const cli::Device& device, const cli::Device& own,
                                const Target& target, Tier tier) {
  const auto bench = cli::open_bench(device, {.target = target});
  if (!bench) return "killed: the start, " + describe(bench.error());
  (*bench)->know_sessions(sessions_as_they_are(device, target, own));
  return judgement(device, **bench, tier);
}

/// The same as over a link.
std::string judgement_within_reach(const cli::Device& device, const Target& target, Tier tier,
                                   std::string_view again) {
  const auto bench = test::bench_within_reach(
      device, target, [again](std::string_view input) { return input == again; });
  if (!bench) return "killed: the start, " + describe(bench.error());
  return judgement(device, **bench, tier);
}

Outcome<void> judge(const cli::Device& device, const cli::Device& own, const Target& target,
                    Tier tier, const std::vector<std::string>& folders) {
  const auto where = told_apart_by(device, folders);
  if (!where) return tl::unexpected{where.error()};
  fmt::print("{}\n", where->empty() ? "same" : "differs: " + *where);
  std::fflush(stdout);
  if (where->empty() && std::getenv("ARMJIG_JUDGE_ALL") == nullptr) return {};
  fmt::print("{}\n", judgement_in_memory(device, own, target, tier));
  return {};
}

/// What sessions on a link would show of it, exactly and apart from moments that a live device is
/// forgiven; one that cannot be opened shows that.
Outcome<void> judge_on_wire(const cli::Device& device, const cli::Device& own, const Target& target,
                            std::uint64_t count) {
  constexpr std::uint64_t kSeed = 1;
  const auto live = ComparisonRules::parse(device.live_rules, "the device's live rules");
  if (!live) return tl::unexpected{live.error()};
  for (const auto tolerance : {Duration{}, live->time_tolerance}) {
    const auto play = cli::sessions_beside(
        device, target, own,
        {.most_attempts = 0, .has_hands = false, .are_ends_told = false, .tolerance = tolerance});
    const auto difference = play(kSeed, count);
    fmt::print("{}\n", difference ? difference->value_or("same") : describe(difference.error()));
    std::fflush(stdout);
  }
  return {};
}

int exit_code_of(const Outcome<void>& done) {
  if (done) return 0;
  fmt::print(stderr, "{}\n", describe(done.error()));
  return kWrongUsage;
}

int serve(const cli::Device& device, char* program, std::span<char*> arguments) {
  std::vector<char*> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const std::vector<cli::Device> devices{device};
  return cli::run_program(static_cast<int>(words.size()), words.data(), devices);
}

int run(std::span<char*> arguments) {
  if (arguments.size() < 5) return kWrongUsage;
  const auto found = cli::find_device(cli::shipped_devices(), arguments[2]);
  if (!found) return kWrongUsage;
  void* const object = dlopen(arguments[3], RTLD_NOW | RTLD_LOCAL);
  if (object == nullptr) {
    fmt::print(stderr, "{}\n", dlerror());
    return kWrongUsage;
  }
  judged = reinterpret_cast<const Judged* (*)()>(dlsym(object, kEntry))();
  const auto device = with_judged(**found);
  if (std::string_view{arguments[1]} == "serve") {
    return serve(device, arguments[0], arguments.subspan(4));
  }
  if (arguments.size() < 6) return kWrongUsage;
  const auto target = parse_target(arguments[4]);
  if (!target) return kWrongUsage;
  if (std::string_view{arguments[1]} == "wire") {
    return exit_code_of(
        judge_on_wire(device, **found, *target, std::strtoull(arguments[5], nullptr, 10)));
  }
  const auto tier = std::string_view{arguments[5]} == "quick" ? Tier::kQuick : Tier::kFull;
  if (std::string_view{arguments[1]} == "reach") {
    if (arguments.size() < 7) return kWrongUsage;
    fmt::print("{}\n", judgement_within_reach(device, *target, tier, arguments[6]));
    return 0;
  }
  const auto folders = arguments.subspan(6);
  return exit_code_of(judge(device, **found, *target, tier, {folders.begin(), folders.end()}));
}

}  // namespace
}  // namespace armjig::mutation

int main(int argc, char** argv) {
  return armjig::mutation::run({argv, static_cast<std::size_t>(argc)});
}
