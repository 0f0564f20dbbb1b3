// SPDX-License-Identifier: Apache-2.0
#include "cli/morap/bus_session.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "cli/checks.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::cli {
Outcome<Rig<BusPort>> open_bus_rig(const Device& device, const TargetOptions& options) {
  const auto how = parse_target_options(options);
  if (!how) return tl::unexpected{how.error()};
  return open_rig<OnBus>(device, *how);
}

void add_node_option(CLI::App& app, std::uint8_t& node) {
  app.add_option("--node", node, "identifier of the node, 0 to 16 (default: 2)")
      ->type_name("ID")
      ->transform(whole(0, morap::kLastNode));
}

Exit report(morap::drive::BusCode code, BusAddress address, const Rig<BusPort>& rig) {
  const auto where = fmt::format("address 0x{:02X}", address.value);
  if (code == morap::drive::BusCode::kByteRefused) {
    fmt::print(stderr, "armjig: {}: {}\n", where, describe(code));
    return Exit::kFindings;
  }
  const auto refusal = rig.last_refusal();
  const bool is_forbidden = code == morap::drive::BusCode::kForbidden && refusal;
  return report(Problem{morap::drive::error_of(code), where,
                        is_forbidden ? refusal->reason : std::string{describe(code)}});
}

}  // namespace armjig::cli
