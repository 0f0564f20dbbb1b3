// SPDX-License-Identifier: Apache-2.0
#include "cli/choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "harness/core/nearest.hpp"

namespace armjig::cli {
namespace {

std::string complaint_of_option(const CLI::App& command, std::string_view written) {
  const auto name = written.substr(0, written.find('='));
  std::vector<std::string> names;
  for (const auto* option : command.get_options()) {
    for (const auto& one : option->get_lnames()) names.push_back("--" + one);
  }
  return fmt::format("there is no option {}; {}", name, did_you_mean(name, names, std::identity{}));
}

std::string complaint_of_subcommand(const std::vector<const CLI::App*>& known,
                                    std::string_view word) {
  std::vector<std::string> names;
  for (const auto* sub : known) names.push_back(sub->get_name());
  return fmt::format("there is no subcommand '{}'; {}there are: {}; ", word,
                     did_you_mean(word, names, std::identity{}), fmt::join(names, " "));
}

}  // namespace

CLI::Validator one_of(std::vector<std::string> words) {
  const auto shown = fmt::format("{{{}}}", fmt::join(words, ","));
  return {[words = std::move(words)](const std::string& word) {
            if (std::ranges::find(words, word) != words.end()) return std::string{};
            return fmt::format("there is no '{}'; {}write {}", word,
                               did_you_mean(word, words, std::identity{}),
                               fmt::join(words, " or "));
          },
          shown};
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  const auto type = option.get_type_name();
  const auto begin = type.find('{');
  if (begin == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 1, type.find('}') - begin - 1), ',');
}

std::string complaint_of_rest(const CLI::App& command) {
  const auto rest = command.remaining();
  if (rest.empty()) return {};
  const auto option =
      std::ranges::find_if(rest, [](const auto& word) { return word.starts_with('-'); });
  if (option != rest.end()) return complaint_of_option(command, *option);
  const auto known = subcommands_of(command);
  const bool takes_words =
      !command.get_options([](const CLI::Option* one) { return one->get_positional(); }).empty();
  return known.empty() || takes_words ? fmt::format("'{}' is one word too many; ", rest.front())
                                      : complaint_of_subcommand(known, rest.front());
}

std::vector<const CLI::App*> subcommands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
}

}  // namespace armjig::cli
