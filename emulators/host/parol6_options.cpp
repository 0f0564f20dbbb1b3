// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/parol6_options.hpp"

#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {
namespace {

Outcome<std::uint32_t> parse_pass_period(const std::string& where, const std::string& text) {
  std::uint32_t value{};
  const auto* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool is_number = error == std::errc{} && stop == end;
  if (is_number && value >= 1 && value <= 1000) return value;
  return problem(ErrorCode::kBadValue, where + ", pass-us=" + text,
                 "write the main loop's period in microseconds, 1 to 1000");
}

Outcome<std::vector<Fault>> parse_faults(const std::string& where, std::string_view list) {
  std::vector<Fault> faults;
  while (!list.empty()) {
    const auto end = list.find(',');
    auto fault = parse_fault(list.substr(0, end), telemetry_fields());
    if (!fault) {
      fault.error().where = where + ", " + fault.error().where;
      return tl::unexpected{fault.error()};
    }
    faults.push_back(*fault);
    list.remove_prefix(end == std::string_view::npos ? list.size() : end + 1);
  }
  return faults;
}

}  // namespace

Outcome<Faulty<Arm>> make_arm(const DeviceOptions& options, const std::string& where) {
  ArmOptions arm;
  std::vector<Fault> faults;
  for (const auto& [name, value] : options) {
    if (name == "profile") {
      if (value == "firmware") continue;
      return problem(ErrorCode::kBadValue, where + ", profile=" + value,
                     "only profile=firmware is emulated");
    }
    if (name == "pass-us") {
      const auto period = parse_pass_period(where, value);
      if (!period) return tl::unexpected{period.error()};
      arm.timing.pass_period = std::chrono::microseconds{*period};
    } else if (name == "fault") {
      auto parsed = parse_faults(where, value);
      if (!parsed) return tl::unexpected{parsed.error()};
      faults = *std::move(parsed);
    } else {
      return problem(ErrorCode::kUnknownOption, where + ", " + name,
                     "parol6 has profile, pass-us and fault");
    }
  }
  return Faulty{Arm{arm}, std::move(faults), kCommandFrameSize};
}

}  // namespace armjig::parol6
