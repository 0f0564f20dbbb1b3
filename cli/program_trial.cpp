// SPDX-License-Identifier: Apache-2.0
#include "cli/program_trial.hpp"

#include <fmt/core.h>

#include <chrono>
#include <string_view>
#include <utility>
#include <variant>

#include "cli/serving.hpp"
#include "conformance/program_check.hpp"
#include "emulators/host/served.hpp"
#include "emulators/lab/device_nodes.hpp"
#include "emulators/lab/run_program.hpp"
#include "emulators/memory/clocked.hpp"
#include "emulators/memory/overheard.hpp"
#include "emulators/replay/recorded_host.hpp"
#include "emulators/replay/trial_witness.hpp"

namespace armjig::cli {
namespace {

/// What is demanded of programs, as a judge of trials.
class CheckedTrial final : public TrialJudge {
 public:
  CheckedTrial(const ProgramCheckEntry& entry, const LinkNoise& noise)
      : check_{entry, noise, [this](const Offence& offence) {
                 broken_.push_back({offence.time, std::string{offence.requirement}, offence.what});
               }} {}

  void to_device(Instant time, Bytes bytes) override { check_.to_device(time, bytes); }
  void from_device(Instant time, Bytes bytes) override { check_.from_device(time, bytes); }
  void on_connection(const ConnectionEvent& event) override { check_.on_connection(event); }
  void on_bus(const BusPart& part) override { check_.on_bus(part); }
  void wait_until(Instant time) override { check_.wait_until(time); }
  void overlook(Instant from, Instant to) override { check_.overlook(from, to); }
  std::vector<Breakage> finish() override {
    (void)check_.finish();
    return std::move(broken_);
  }

 private:
  std::vector<Breakage> broken_;
  ProgramCheck check_;
};

/// Where a program finds a device.
struct Place {
  std::string target;  ///< as `--target` has it
  std::vector<std::string> environment;
};

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

std::vector<std::string> words_of(const std::vector<std::string>& command,
                                  const std::string& target) {
  const auto place = target.substr(target.find(':') + 1);
  const auto port = target.substr(target.rfind(':') + 1);
  std::vector<std::string> words;
  for (const auto& word : command) {
    words.push_back(replaced(replaced(word, "{port}", port), "{}", place));
  }
  return words;
}

HostOptions how_to_host(const AnyHosted& hosted, double speed) {
  HostOptions how;
  how.speed = speed;
  if (std::holds_alternative<std::unique_ptr<HostedServer>>(hosted)) {
    how.tcp.emplace();
  } else {
    how.pty.emplace();
  }
  return how;
}

/// Serves the device while `work(Place)` is done, whose answer it is.
template <class Work>
auto with_place(AnyHosted hosted, double speed, Work work) -> decltype(work(Place{})) {
  const bool is_bus = std::holds_alternative<std::unique_ptr<HostedBus>>(hosted);
  auto how = is_bus ? HostOptions{} : how_to_host(hosted, speed);
  auto host = Host::open(std::move(hosted), std::move(how));
  if (!host) return tl::unexpected{host.error()};
  const auto served = serve_aside(*std::move(host));
  if (!is_bus) return work(Place{served->target(), {}});
  DeviceNodes nodes;
  const auto node = nodes.add_bus(1, served->host());
  if (!node) return tl::unexpected{node.error()};
  return work(Place{"i2c:" + *node, nodes.environment()});
}

double seconds_of(Duration duration) { return std::chrono::duration<double>{duration}.count(); }

}  // namespace

std::unique_ptr<TrialJudge> make_trial_judge(const Device& device, const LinkNoise& noise) {
  if (!device.program_check) return nullptr;
  return std::make_unique<CheckedTrial>(*device.program_check, noise);
}

Outcome<TrialResult> ProgramTrial::operator()(const std::vector<Perturbation>& wanted) {
  const auto judge = make_trial_judge(device, link_noise_of(device, speed));
  TrialWitness witness{device.make_dissector, judge.get()};
  Gate gate{device.make_dissector, wanted};
  auto hosted = std::visit(
      [&](auto copy) -> AnyHosted {
        auto clocked = put_on_clock(std::move(copy), {.begin = begin});
        return overhear(put_behind(gate, std::move(clocked)), witness);
      },
      clone(emulated));
  const auto end = with_place(std::move(hosted), speed, [this](Place place) {
    place.environment.push_back("ARMJIG_TARGET=" + place.target);
    return run_program_silently(words_of(command, place.target), place.environment, patience);
  });
  if (!end) return tl::unexpected{end.error()};
  if (wanted.empty() && !*end) {
    return problem(ErrorCode::kTimedOut, command.front(),
                   fmt::format("even undisturbed it does not end within {:.1f} s; let it do less, "
                               "or say --patience",
                               seconds_of(patience)));
  }
  if (wanted.empty()) usual_end = *end;
  TrialResult result{
      .passed = gate.passed(), .said = witness.take_said(), .broken = witness.finish()};
  const auto last = gate.passed().empty() ? Instant{} : gate.passed().back().time;
  if (!*end) {
    result.broken.push_back(
        {last, "program", fmt::format("it does not end within {:.1f} s", seconds_of(patience))});
  } else if (*end != usual_end) {
    result.broken.push_back(
        {last, "program", fmt::format("it ends with {} and not with {}", **end, *usual_end)});
  }
  return result;
}

}  // namespace armjig::cli
