// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/parol6_options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "emulators/parol6/profile.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {
namespace {

/// One value of an option, and what it means.
template <class Meaning>
struct Choice {
  std::string_view name;
  Meaning meaning;
};

constexpr std::array kProfiles{Choice<BoardProfile>{"firmware", kFirmwareBoard},
                               Choice<BoardProfile>{"documented", kDocumentedBoard}};
constexpr std::array kCheckPolicies{
    Choice<CheckPolicy>{"ignore", CheckPolicy::kIgnore},
    Choice<CheckPolicy>{"d4", CheckPolicy::kBoardOnly},
    Choice<CheckPolicy>{"d4-or-e4", CheckPolicy::kBoardOrHost},
};
constexpr std::array kEstops{Choice<bool>{"report", false}, Choice<bool>{"disable", true}};
constexpr std::array kBounds{Choice<bool>{"none", false}, Choice<bool>{"stop", true}};

/// Reads one option's value after the other; remembers the first problem.
class OptionReader {
 public:
  OptionReader(const DeviceOptions& options, const std::string& where)
      : options_{options}, where_{where} {
    for (const auto& [name, value] : options) {
      constexpr std::array<std::string_view, 6> kNames{"bounds", "crc",     "estop",
                                                       "fault",  "pass-us", "profile"};
      if (std::ranges::find(kNames, name) != kNames.end()) continue;
      complain(ErrorCode::kUnknownOption, name,
               "parol6 has profile, crc, estop, bounds, pass-us and fault");
    }
  }

  /// Changes `meaning` if the option is there.
  template <class Meaning, std::size_t count>
  void choose(std::string_view name, const std::array<Choice<Meaning>, count>& choices,
              Meaning& meaning) {
    const auto option = options_.find(name);
    if (option == options_.end()) return;
    const auto choice = std::ranges::find(choices, option->second, &Choice<Meaning>::name);
    if (choice != choices.end()) {
      meaning = choice->meaning;
      return;
    }
    std::string known = "there are:";
    for (const auto& one : choices) known.append(" ").append(one.name);
    complain(ErrorCode::kBadValue, option->first + "=" + option->second, known);
  }

  void read_pass_period(std::chrono::microseconds& period) {
    const auto option = options_.find("pass-us");
    if (option == options_.end()) return;
    const auto& text = option->second;
    std::uint32_t value{};
    const auto* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const bool is_number = error == std::errc{} && stop == end;
    if (is_number && value >= 1 && value <= 1000) {
      period = std::chrono::microseconds{value};
    } else {
      complain(ErrorCode::kBadValue, "pass-us=" + text,
               "write the main loop's period in microseconds, 1 to 1000");
    }
  }

  void read_faults(ArmOptions& arm, Defects& defects, std::vector<Fault>& sent) {
    const auto option = options_.find("fault");
    if (option == options_.end()) return;
    std::string_view list = option->second;
    while (!list.empty()) {
      const auto end = list.find(',');
      const auto added = add_fault(list.substr(0, end), arm, defects, sent);
      if (!added) return complain(added.error().code, added.error().where, added.error().hint);
      list.remove_prefix(end == std::string_view::npos ? list.size() : end + 1);
    }
  }

  [[nodiscard]] const std::optional<Problem>& problem() const noexcept { return problem_; }

 private:
  void complain(ErrorCode code, const std::string& what, std::string hint) {
    if (!problem_) problem_ = Problem{code, where_ + ", " + what, std::move(hint)};
  }

  const DeviceOptions& options_;
  const std::string& where_;
  std::optional<Problem> problem_;
};

}  // namespace

Outcome<Faulty<DefectiveArm>> make_arm(const DeviceOptions& options, const std::string& where) {
  ArmOptions arm;
  Defects defects;
  std::vector<Fault> sent;
  OptionReader reader{options, where};
  reader.choose("profile", kProfiles, arm.profile);
  reader.choose("crc", kCheckPolicies, arm.profile.check);
  reader.choose("estop", kEstops, arm.profile.disables_at_estop);
  reader.choose("bounds", kBounds, arm.profile.stops_at_bounds);
  reader.read_pass_period(arm.timing.pass_period);
  reader.read_faults(arm, defects, sent);
  if (reader.problem()) return tl::unexpected{*reader.problem()};
  return Faulty{DefectiveArm{arm, std::move(defects)}, std::move(sent), kCommandFrameSize};
}

}  // namespace armjig::parol6
