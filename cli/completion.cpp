// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/command.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
    "Prints a completion script for a shell.\n"
    "\n"
    "  source <(armjig completion bash)";

/// The words that may follow the (sub)command `app`.
std::string words_after(const CLI::App& app) {
  std::string words;
  for (const auto* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    words += sub->get_name() + ' ';
  }
  for (const auto* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) words += "--" + name + ' ';
  }
  if (!words.empty()) words.pop_back();
  return words;
}

/// Calls `visit(path, app)` for `armjig` and every subcommand below it.
void for_each_command(const CLI::App& app, const std::string& path, const auto& visit) {
  visit(path, app);
  for (const auto* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    for_each_command(*sub, path + ' ' + sub->get_name(), visit);
  }
}

/// The script follows the words that are subcommands, then offers what may come behind them, and
/// files. Zsh reads it through its own compatibility layer.
void print_script(const CLI::App& app, const std::string& shell) {
  if (shell == "zsh") fmt::print("autoload -U +X bashcompinit && bashcompinit\n");
  fmt::print(
      "_armjig() {{\n"
      "  local -A after\n");
  for_each_command(app, "armjig", [](const std::string& path, const CLI::App& command) {
    fmt::print("  after['{}']='{}'\n", path, words_after(command));
  });
  fmt::print(
      "  local path=armjig word\n"
      "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n"
      "    [[ -v after[\"$path $word\"] ]] && path+=\" $word\"\n"
      "  done\n"
      "  COMPREPLY=($(compgen -W \"${{after[$path]}}\" -f -- \"${{COMP_WORDS[COMP_CWORD]}}\"))\n"
      "}}\n"
      "complete -o filenames -F _armjig armjig\n");
}

}  // namespace

void add_completion(CLI::App& app, Devices /*devices*/, Action& action) {
  auto* completion = app.add_subcommand("completion", kHelp);
  const auto shell = std::make_shared<std::string>();
  completion->add_option("SHELL", *shell, "bash or zsh")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  completion->callback([&app, shell, &action] {
    action = [&app, shell] {
      print_script(app, *shell);
      return Exit::kPassed;
    };
  });
}

}  // namespace armjig::cli
