// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/emulated_target.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <utility>
#include <vector>

#include "emulators/demo/demo.hpp"
#include "harness/link/memory_stream.hpp"
#include "harness/wire/parol6/fields.hpp"

namespace armjig {
namespace {

Outcome<std::unique_ptr<StreamPort>> open_demo(const Target& target) {
  if (!target.options.empty()) {
    return problem(ErrorCode::kUnknownOption, target.text, "the demo device has no options");
  }
  return std::make_unique<MemoryStream<demo::StreamDevice>>(demo::StreamDevice{});
}

Outcome<std::unique_ptr<StreamPort>> open_parol6(const Target& target) {
  auto arm = parol6::make_arm(target.options, target.text);
  if (!arm) return tl::unexpected{arm.error()};
  return std::make_unique<MemoryStream<Faulty<parol6::Arm>>>(*std::move(arm));
}

constexpr std::array kEmulatedTargets{
    EmulatedTarget{"demo", open_demo},
    EmulatedTarget{"parol6", open_parol6},
};

}  // namespace

std::span<const EmulatedTarget> emulated_targets() noexcept { return kEmulatedTargets; }

const EmulatedTarget& emulated_target(std::string_view device) noexcept {
  return *std::ranges::find(kEmulatedTargets, device, &EmulatedTarget::device);
}

namespace parol6 {
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

}  // namespace parol6
}  // namespace armjig
