// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/target.hpp"

#include <fmt/core.h>

#include "harness/link/real_streams.hpp"

namespace armjig {
namespace {

constexpr auto kForms = "write emulated:, pty:PATH or tcp:HOST:PORT";

auto bad_target(std::string_view text, std::string_view hint) {
  return problem(ErrorCode::kBadTarget, fmt::format("'{}'", text), std::string{hint});
}

}  // namespace

Outcome<Target> parse_target(std::string_view text) {
  Target target;
  target.text = text;
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return bad_target(text, kForms);
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
    target.options[std::string{option.substr(0, equals)}] = option.substr(equals + 1);
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
  }
  if (target.is_emulated() && !target.address.empty()) {
    return bad_target(text, "emulated: has no address, only ?NAME=VALUE options");
  }
  return target;
}

Outcome<std::unique_ptr<StreamPort>> open_stream(const Target& target, OpenEmulated open_emulated) {
  if (target.is_emulated()) return open_emulated(target);
  if (target.scheme == "pty") return open_pty(target.address);
  if (target.scheme == "tcp") return open_tcp_stream(target.address);
  return bad_target(target.text, kForms);
}

}  // namespace armjig
