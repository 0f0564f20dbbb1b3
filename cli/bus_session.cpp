// SPDX-License-Identifier: Apache-2.0
#include "cli/bus_session.hpp"

#include <fmt/core.h>

#include "emulators/host/buses.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::cli {
namespace {

ErrorCode error_of(morap::BusCode code) {
  switch (code) {
    case morap::BusCode::kNoSuchAddress:
      return ErrorCode::kNotFound;
    case morap::BusCode::kTimedOut:
      return ErrorCode::kTimedOut;
    case morap::BusCode::kGone:
      return ErrorCode::kDisconnected;
    case morap::BusCode::kForbidden:
      return ErrorCode::kForbidden;
    default:
      return ErrorCode::kBusy;
  }
}

}  // namespace

Outcome<BusRig> open_bus_rig(std::string_view device, const TargetOptions& options) {
  const auto how = parse_target_options(options);
  if (!how) return tl::unexpected{how.error()};
  return BusRig::open(device, *how, find_hosted_bus(device)->open);
}

void add_bus_target_options(CLI::App& app, TargetOptions& options) {
  app.add_option("--target", options.target,
                 "the bus: emulated:[?OPTION=VALUE&...], i2c:/dev/i2c-N or i2c-tiny-usb:[SERIAL]")
      ->type_name("TARGET");
  app.add_option(
         "--allow", options.allow,
         "what may be done to devices that are not emulated: state,move,grip,program or all "
         "(default: only look)")
      ->type_name("LIST");
  add_link_options(app, options);
}

void add_node_option(CLI::App& app, std::uint8_t& node) {
  app.add_option("--node", node, "identifier of the node, 0 to 16 (default: 2)")
      ->type_name("ID")
      ->check(CLI::Range(0, int{morap::kLastNode}));
}

Exit report(morap::BusCode code, BusAddress address, const BusRig& rig) {
  const auto where = fmt::format("address 0x{:02X}", address.value);
  if (code == morap::BusCode::kByteRefused) {
    fmt::print(stderr, "armjig: {}: {}\n", where, describe(code));
    return Exit::kFindings;
  }
  const auto refusal = rig.last_refusal();
  const bool is_forbidden = code == morap::BusCode::kForbidden && refusal;
  return report(
      Problem{error_of(code), where, is_forbidden ? refusal->reason : std::string{describe(code)}});
}

}  // namespace armjig::cli
