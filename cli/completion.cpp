// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/choice.hpp"
#include "cli/command.hpp"

namespace armjig::cli {
namespace {

constexpr auto kCompletionHelp =
    "Prints a completion script for a shell.\n"
    "\n"
    "  source <(armjig completion bash)\n"
    "  source <(armjig completion zsh)       behind compinit\n"
    "  armjig completion fish | source\n"
    "\n"
    "It completes subcommands, options, devices, targets and names of requirements.";

/// A shell, and the script that asks the program (`armjig __complete WORD...`) what may come.
/// Where the program knows nothing, files are offered. What may go on gets no blank after it.
struct Shell {
  std::string_view name;
  std::string_view script;
};

// Bash takes a colon or an equals sign for the end of a word, and wants only what comes after it.
constexpr std::string_view kBash = R"(_armjig() {
  local line=${COMP_LINE:0:COMP_POINT} typed
  local -a words
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=('')
  typed=${words[-1]}
  mapfile -t COMPREPLY < <("${words[0]}" __complete "${words[@]:1}" 2>/dev/null)
  if [[ $typed != [\'\"]* && $COMP_WORDBREAKS == *:* ]]; then
    COMPREPLY=("${COMPREPLY[@]#"${typed%"${typed##*[:=]}"}"}")
  fi
  [[ ${COMPREPLY[0]-} != *[:=?] ]] || compopt -o nospace
}
complete -o default -F _armjig armjig
)";

constexpr std::string_view kZsh = R"(#compdef armjig
_armjig() {
  local -a replies whole open
  replies=("${(@f)$(${words[1]} __complete "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  whole=(${replies:#*[:=?]})
  open=(${(M)replies:#*[:=?]})
  if (( ! $#whole && ! $#open )); then
    _files
    return
  fi
  compadd -a whole
  compadd -S '' -a open
}
if [[ ${funcstack[1]} == _armjig ]]; then
  _armjig "$@"
else
  compdef _armjig armjig
fi
)";

constexpr std::string_view kFish = R"(function __armjig_complete
    set -l words (commandline -opc)
    set -l replies ($words[1] __complete $words[2..-1] (commandline -ct) 2>/dev/null)
    if test (count $replies) -gt 0
        printf '%s\n' $replies
    else
        __fish_complete_path (commandline -ct)
    end
end
complete -c armjig -f -a '(__armjig_complete)'
)";

constexpr std::array kShells{Shell{"bash", kBash}, Shell{"zsh", kZsh}, Shell{"fish", kFish}};

}  // namespace

void add_completion(CLI::App& app, Devices /*devices*/, Action& action) {
  auto* completion = app.add_subcommand("completion", kCompletionHelp);
  const auto wanted = std::make_shared<std::string>();
  std::vector<std::string> names;
  for (const auto& shell : kShells) names.emplace_back(shell.name);
  completion->add_option("SHELL", *wanted, "which one")->required()->check(one_of(names));
  when_chosen(*completion, action, [wanted] {
    for (const auto& shell : kShells) {
      if (shell.name == *wanted) fmt::print("{}", shell.script);
    }
    return Exit::kPassed;
  });
}

}  // namespace armjig::cli
