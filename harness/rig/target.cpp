// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/target.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "harness/core/nearest.hpp"
#include "harness/rig/target_schemes.hpp"

namespace armjig {
namespace {

constexpr auto kForms =
    "this is no target; write emulated:, serial:PATH, serial:VID:PID, usb:VID:PID, pty:PATH, "
    "tcp:HOST:PORT, rfc2217:HOST:PORT or i2c:DEVICE; "
    "'armjig devices' lists what is plugged in";

}  // namespace

tl::unexpected<Problem> bad_target(std::string_view text, std::string_view hint) {
  const auto scheme = text.substr(0, std::min(text.find(':'), text.size() - 1) + 1);
  return problem(ErrorCode::kBadTarget, fmt::format("'{}'", text),
                 did_you_mean(scheme, kTargetSchemes).append(hint));
}

tl::unexpected<Problem> no_target(std::string_view text) { return bad_target(text, kForms); }

Outcome<Target> parse_target(std::string_view text) {
  Target target;
  target.text = text;
  const auto colon = text.find(':');
  const bool is_known = colon != std::string_view::npos &&
                        std::ranges::count(kTargetSchemes, text.substr(0, colon + 1)) > 0;
  if (!is_known) return no_target(text);
  target.scheme = text.substr(0, colon);
  auto rest = text.substr(colon + 1);
  // Only emulated targets have options; a path or host may contain a question mark.
  const auto question = target.is_emulated() ? rest.find('?') : std::string_view::npos;
  target.address = rest.substr(0, question);
  rest = question == std::string_view::npos ? "" : rest.substr(question + 1);
  while (!rest.empty()) {
    const auto end = rest.find('&');
    const auto option = rest.substr(0, end);
    const auto equals = option.find('=');
    if (equals == 0 || equals == std::string_view::npos) {
      return bad_target(text, "write options as ?NAME=VALUE&NAME=VALUE");
    }
    const auto name = option.substr(0, equals);
    if (target.options.contains(name)) {
      return bad_target(text, fmt::format("it says {} twice", name));
    }
    target.options[std::string{name}] = option.substr(equals + 1);
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
  }
  if (target.is_emulated() && !target.address.empty()) {
    return bad_target(text, "emulated: has no address, only ?NAME=VALUE options");
  }
  return target;
}

}  // namespace armjig
