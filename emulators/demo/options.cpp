// SPDX-License-Identifier: Apache-2.0
#include "emulators/demo/options.hpp"

#include <array>
#include <utility>
#include <vector>

namespace armjig::demo::emulation {
namespace {

struct Settings {
  bool is_documented{};  ///< both profiles are the same device
  std::vector<Fault> faults;
};

constexpr auto kTable = std::to_array<DeviceOption<Settings>>({
    {{"profile", "firmware|documented", "taken as by any device; both are the same"},
     [](Settings& to, const OptionValue& value) {
       return value.choose(to.is_documented, {false, true});
     }},
    {{"fault", "FAULT,...", "defects in what it sends: KIND:FIELD, with fields of replies"},
     [](Settings& to, const OptionValue& value) {
       return value.take_each([&](std::string_view text) {
         return parse_fault(text, reply_fields()).map([&](const Fault& fault) {
           to.faults.push_back(fault);
         });
       });
     }},
});
constexpr auto kRows = rows_of(kTable);

}  // namespace

std::span<const OptionRow> options() noexcept { return kRows; }

Outcome<Faulty<StreamDevice>> make(const DeviceOptions& options, const std::string& where) {
  return read_options("demo", kTable, options, where, Settings{}).map([](Settings settings) {
    return Faulty{StreamDevice{}, std::move(settings.faults), kMessageSize};
  });
}

}  // namespace armjig::demo::emulation
