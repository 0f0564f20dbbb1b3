// SPDX-License-Identifier: Apache-2.0
#include "cli/target_options.hpp"

#include <fmt/core.h>

namespace armjig::cli {

void add_target_options(CLI::App& app, TargetOptions& options) {
  app.add_option("--target", options.target,
                 "where the device is: emulated:[?OPTION=VALUE&...], serial:PATH[,BAUD], "
                 "serial:VID:PID[:SERIAL], usb:VID:PID[:SERIAL], pty:PATH, tcp:HOST:PORT, "
                 "rfc2217:HOST:PORT, i2c:/dev/i2c-N or "
                 "i2c-tiny-usb:[SERIAL]")
      ->type_name("TARGET");
  app.add_option("--allow", options.allow,
                 "what may be done to a device that is not emulated: "
                 "state,move,home,grip,program,crash or all "
                 "(default: only look)")
      ->type_name("LIST");
  add_link_options(app, options);
}

void add_link_options(CLI::App& app, TargetOptions& options) {
  app.add_option("--impair", options.impair,
                 "make the link bad, as in loss=0.1%,delay=normal(2ms,1ms),split=random,seed=7")
      ->type_name("SPEC");
  add_capture_options(app, options.capture);
}

Outcome<RigOptions> parse_target_options(const TargetOptions& options) {
  if (options.target.empty()) {
    return problem(ErrorCode::kBadTarget, "--target is missing",
                   "say where the device is; for a first try: --target emulated:");
  }
  RigOptions rig;
  auto target = parse_target(options.target);
  if (!target) return tl::unexpected{target.error()};
  rig.target = *std::move(target);
  const auto permissions = parse_permissions(options.allow);
  if (!permissions) return tl::unexpected{permissions.error()};
  rig.permissions = *permissions;
  if (!options.impair.empty()) {
    const auto impairment = parse_impairment(options.impair);
    if (!impairment) return tl::unexpected{impairment.error()};
    rig.impairment = *impairment;
  }
  auto capture = open_capture_file("--capture", options.capture);
  if (!capture) return tl::unexpected{capture.error()};
  rig.capture = *std::move(capture);
  return rig;
}

std::string to_arguments(const TargetOptions& options) {
  std::string text;
  if (!options.allow.empty()) text += fmt::format(" --allow {}", options.allow);
  if (!options.impair.empty()) text += fmt::format(" --impair '{}'", options.impair);
  return text;
}

}  // namespace armjig::cli
