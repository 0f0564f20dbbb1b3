// SPDX-License-Identifier: Apache-2.0
#include "cli/hand_options.hpp"

#include <fmt/core.h>

#include <vector>

#include "emulators/lab/run_program.hpp"

namespace armjig::cli {
namespace {

/// What it prints is no result of ours.
bool run(const std::string& command, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"/bin/sh", "-c", fmt::format("({} \"$@\") >&2", command), "sh"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const auto code = run_program(words, {});
  return code && *code == 0;
}

/// The command that is for nothing but this input; empty: there is none.
const std::string& own_command(const HandOptions& options, std::string_view input) {
  static const std::string kNone;
  if (input == "restart") return options.restart;
  return input == "power" ? options.power_cycle : kNone;
}

}  // namespace

void add_hand_options(CLI::App& app, HandOptions& options) {
  app.add_option("--hand", options.hand,
                 "sets an input of a device that is not emulated: called with the input's name "
                 "and value, as emulated devices have them")
      ->type_name("COMMAND");
  app.add_option("--restart", options.restart, "starts the device's program again")
      ->type_name("COMMAND");
  app.add_option("--power-cycle", options.power_cycle, "switches the device off and on")
      ->type_name("COMMAND");
}

Hand hand_of(const HandOptions& options) {
  return {.has =
              [options](std::string_view input) {
                return !options.hand.empty() || !own_command(options, input).empty();
              },
          .set =
              [options](std::string_view input, std::int64_t value) {
                const auto& own = own_command(options, input);
                if (!own.empty()) return run(own, {});
                return !options.hand.empty() &&
                       run(options.hand, {std::string{input}, std::to_string(value)});
              }};
}

std::string to_arguments(const HandOptions& options) {
  std::string text;
  if (!options.hand.empty()) text += fmt::format(" --hand '{}'", options.hand);
  if (!options.restart.empty()) text += fmt::format(" --restart '{}'", options.restart);
  if (!options.power_cycle.empty()) text += fmt::format(" --power-cycle '{}'", options.power_cycle);
  return text;
}

}  // namespace armjig::cli
