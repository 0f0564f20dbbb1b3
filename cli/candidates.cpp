// SPDX-License-Identifier: Apache-2.0
#include "cli/candidates.hpp"

#include <algorithm>
#include <functional>
#include <string_view>

#include "cli/choice.hpp"
#include "cli/device.hpp"
#include "harness/arm/models.hpp"
#include "harness/rig/target_schemes.hpp"

namespace armjig::cli {
namespace {

using Words = std::vector<std::string>;

void add_names(Words& words, const auto& all, auto name_of) {
  for (const auto& one : all) words.emplace_back(std::invoke(name_of, one));
}

Words names_of_requirements(const Suite& suite) {
  Words words;
  for (const auto& chapter : suite.chapters) {
    add_names(words, chapter.requirements, &Requirement::id);
    add_names(words, chapter.cases, [](const Case& one) { return name_of(one); });
  }
  return words;
}

Words names_of_faults(const Device& device) {
  Words words;
  add_names(words, mutants_of(device.mutants(), Profile::kFirmware), &Mutant::name);
  return words;
}

/// The words of `a|b|c`, as the table of a device has them; none if it is a number or a name.
Words words_of(std::string_view values) {
  values = values.substr(0, values.find(",..."));
  return values.find('|') == std::string_view::npos ? Words{}
                                                    : CLI::detail::split(std::string{values}, '|');
}

Words with_beginning(std::string_view beginning, Words words) {
  for (auto& word : words) word.insert(0, beginning);
  return words;
}

/// `NAME=` of an option, or `NAME=VALUE`, after the last of `marks` in what is typed.
Words settings(const Device& device, const std::string& typed, std::string_view marks) {
  const auto begin = typed.find_last_of(marks) + 1;
  const auto equals = typed.find('=', begin);
  if (equals == std::string::npos) {
    Words names;
    add_names(names, device.options(),
              [](const OptionRow& row) { return std::string{row.name} + '='; });
    return with_beginning(typed.substr(0, begin), names);
  }
  const auto name = typed.substr(begin, equals - begin);
  const auto rows = device.options();
  const auto row = std::ranges::find(rows, name, &OptionRow::name);
  if (row == rows.end()) return {};
  const bool is_fault = name == "fault";
  return with_beginning(typed.substr(0, equals + 1),
                        is_fault ? names_of_faults(device) : words_of(row->values));
}

Words targets(const Device* device, const std::string& typed) {
  constexpr std::string_view kOptions = "emulated:?";
  if (device != nullptr && typed.starts_with(kOptions)) return settings(*device, typed, "?&");
  Words words;
  add_names(words, kTargetSchemes, std::identity{});
  if (device != nullptr) words.emplace_back(kOptions);
  return words;
}

Words permissions(const std::string& typed) {
  Words words;
  for (std::size_t i = 0; i < kHazardCount; ++i) {
    if (const auto hazard = static_cast<Hazard>(i); hazard != Hazard::kObserve) {
      words.emplace_back(to_string(hazard));
    }
  }
  words.emplace_back("all");
  return with_beginning(typed.substr(0, typed.rfind(',') + 1), words);
}

Words values_of(const CLI::App& command, const CLI::Option& option, Devices devices,
                const Device* device, const std::string& typed) {
  const auto name = option.get_name();
  if (auto choices = choices_of(option); !choices.empty()) return choices;
  if (name == "--target") return targets(device, typed);
  if (name == "--allow") return permissions(typed);
  Words words;
  if (name == "DEVICE") add_names(words, devices, &Device::name);
  if (name == "--listen") words = {"i2c:", "pty:", "rfc2217:", "tcp:"};
  if (name == "--arm") add_names(words, arm::models(), &arm::ModelEntry::name);
  if (device == nullptr) return words;
  if (name == "--set") return settings(*device, typed, "");
  const bool is_about_mutants = command.get_name() == "mutants";
  if (name == "--explain") return names_of_requirements(device->suite());
  if (name == "--filter") {
    return is_about_mutants ? names_of_faults(*device) : names_of_requirements(device->suite());
  }
  return words;
}

/// What stands before the word that is being typed.
struct Place {
  const CLI::App* command;
  const CLI::Option* option{};  ///< whose value comes next
  Words arguments{};            ///< of the command, without options
};

bool has_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

const CLI::Option* option_named(const CLI::App& command, const std::string& name) {
  return command.get_option_no_throw(name);
}

Place place_behind(const CLI::App& app, std::span<const std::string> words) {
  Place place{&app};
  for (const auto& word : words) {
    const auto known = subcommands_of(*place.command);
    const auto sub =
        std::ranges::find(known, word, [](const auto* one) { return one->get_name(); });
    if (place.option != nullptr) {
      place.option = nullptr;
    } else if (word.starts_with('-')) {
      const auto* const option = option_named(*place.command, word);
      if (option != nullptr && has_value(*option)) place.option = option;
    } else if (place.arguments.empty() && sub != known.end()) {
      place = {*sub};
    } else {
      place.arguments.push_back(word);
    }
  }
  return place;
}

const Device* device_among(Devices devices, const Words& words) {
  for (const auto& word : words) {
    const auto device = std::ranges::find(devices, word, &Device::name);
    if (device != devices.end()) return &*device;
  }
  return nullptr;
}

/// The options of the command, and for what stands alone subcommands and the next argument.
Words next_words(const Place& place, Devices devices, const Device* device,
                 const std::string& typed) {
  Words words;
  if (typed.starts_with('-')) {
    for (const auto* option : place.command->get_options()) {
      for (const auto& name : option->get_lnames()) words.push_back("--" + name);
    }
    return words;
  }
  if (place.arguments.empty()) {
    add_names(words, subcommands_of(*place.command),
              [](const CLI::App* sub) { return sub->get_name(); });
  }
  auto left = place.arguments.size();
  for (const auto* option :
       place.command->get_options([](const CLI::Option* one) { return one->get_positional(); })) {
    if (left-- > 0) continue;
    const auto values = values_of(*place.command, *option, devices, device, typed);
    words.insert(words.end(), values.begin(), values.end());
    break;
  }
  return words;
}

}  // namespace

std::vector<std::string> candidates(const CLI::App& app, Devices devices,
                                    std::span<const std::string> words) {
  if (words.empty()) return {};
  auto typed = words.back();
  if (typed.starts_with('\'') || typed.starts_with('"')) typed.erase(0, 1);
  const auto place = place_behind(app, words.first(words.size() - 1));
  const auto* const device = device_among(devices, place.arguments);
  const auto equals = typed.starts_with("--") ? typed.find('=') : std::string::npos;
  Words all;
  if (place.option != nullptr) {
    all = values_of(*place.command, *place.option, devices, device, typed);
  } else if (equals != std::string::npos) {
    const auto* const option = option_named(*place.command, typed.substr(0, equals));
    if (option == nullptr) return {};
    const auto value = typed.substr(equals + 1);
    all = with_beginning(typed.substr(0, equals + 1),
                         values_of(*place.command, *option, devices, device, value));
  } else {
    all = next_words(place, devices, device, typed);
  }
  std::erase_if(all, [&typed](const auto& word) { return !word.starts_with(typed); });
  std::ranges::sort(all);
  const auto repeated = std::ranges::unique(all);
  all.erase(repeated.begin(), repeated.end());
  return all;
}

}  // namespace armjig::cli
