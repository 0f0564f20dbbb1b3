// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/device.hpp"
#include "harness/rig/doctor.hpp"

namespace armjig::cli {
namespace {

constexpr auto kDoctorHelp =
    "Looks for what is in the way of talking to a real arm in time, and says how to fix it.\n"
    "\n"
    "  armjig doctor\n"
    "  armjig doctor --json                             for scripts\n"
    "  armjig doctor --udev-rules                       prints the rules that it may ask for\n"
    "\n"
    "Changes nothing. Exit code 1 says that there is a problem; advice is none.";

struct DoctorOptions {
  bool wants_json = false;
  bool wants_rules = false;
};

void print_text(const std::vector<Finding>& findings) {
  for (const auto& finding : findings) {
    fmt::print("{:<8} {:<17} {}\n", to_string(finding.state), finding.check, finding.text);
    if (!finding.fix.empty()) fmt::print("{:26} fix: {}\n", "", finding.fix);
  }
}

void print_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json json{{"schema", "armjig.doctor/1"},
                              {"findings", nlohmann::ordered_json::array()}};
  for (const auto& finding : findings) {
    json["findings"].push_back({{"check", finding.check},
                                {"state", to_string(finding.state)},
                                {"text", finding.text},
                                {"fix", finding.fix}});
  }
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

Exit doctor(Devices devices, const DoctorOptions& options) {
  const auto boards = known_boards(devices);
  if (options.wants_rules) {
    fmt::print("{}", udev_rules(boards));
    return Exit::kPassed;
  }
  auto system = this_system();
  if (const auto* const home = std::getenv("HOME")) system.home = home;
  const auto findings = examine(system, boards);
  options.wants_json ? print_json(findings) : print_text(findings);
  const bool is_well = std::ranges::none_of(
      findings, [](const Finding& finding) { return finding.state == Finding::State::kProblem; });
  return is_well ? Exit::kPassed : Exit::kFindings;
}

}  // namespace

void add_doctor(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("doctor", kDoctorHelp);
  const auto options = std::make_shared<DoctorOptions>();
  command->add_flag("--json", options->wants_json, "as one JSON object");
  command->add_flag("--udev-rules", options->wants_rules, "print udev rules for our boards");
  when_chosen(*command, action, [options, devices] { return doctor(devices, *options); });
}

}  // namespace armjig::cli
