// SPDX-License-Identifier: Apache-2.0
// What users write and files hold: any text is read, or refused with what to do. What the command
// line prints of it, it makes printable.
//
// Input: one byte that chooses the kind of text, then the text.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "emulators/kinovazed/objectives.hpp"
#include "emulators/kinovazed/options.hpp"
#include "emulators/morap/options.hpp"
#include "emulators/parol6/options.hpp"
#include "fuzz/require.hpp"
#include "harness/compare/rules.hpp"
#include "harness/config/toml_table.hpp"
#include "harness/drive/morap/parameter_file.hpp"
#include "harness/link/impairment.hpp"
#include "harness/rig/target.hpp"
#include "harness/urdf/urdf.hpp"

namespace armjig::fuzz::texts {
namespace {

/// Passes on what was read.
template <class Read>
bool check(const Outcome<Read>& read) {
  if (read) return true;
  require(!read.error().hint.empty(), "a problem says what to do");
  return false;
}

void check_target(std::string_view text) {
  const auto target = parse_target(text);
  if (!check(target)) return;
  require(target->text == text, "a target is called as it was written");
  if (!target->is_emulated()) return;
  (void)check(parol6::emulation::make(target->options, target->text));
  (void)check(morap::emulation::make(target->options, target->text, {}));
  (void)check(kinovazed::emulation::make(target->options, target->text, {}));
}

void check_impairment(std::string_view text) {
  const auto impairment = parse_impairment(text);
  if (!check(impairment)) return;
  const auto again = parse_impairment(to_string(*impairment));
  require(again && *again == *impairment, "an impairment can be written and read again");
}

void check_rules(std::string_view text) { (void)check(ComparisonRules::parse(text, "input")); }

void check_tables(std::string_view text) {
  auto table = TomlTable::parse(text, "input");
  if (check(table)) (void)check(table->groups());
}

void check_objectives(std::string_view text) {
  (void)check(kinovazed::emulation::parse_objectives(text, "input"));
}

void check_parameters(std::string_view text) {
  (void)check(morap::drive::parse_parameters(text, "input"));
}

void check_urdf(std::string_view text) {
  (void)check(arm::arm_from_urdf("input", std::string{text}));
}

constexpr std::array kChecks{check_target,     check_impairment, check_rules, check_tables,
                             check_objectives, check_parameters, check_urdf};

}  // namespace
}  // namespace armjig::fuzz::texts

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using armjig::fuzz::texts::kChecks;
  if (size == 0) return 0;
  kChecks[data[0] % kChecks.size()]({reinterpret_cast<const char*>(data + 1), size - 1});
  return 0;
}
