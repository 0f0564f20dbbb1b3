// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/command_receiver.hpp"

#include <variant>

namespace armjig::parol6::emulation {

CommandReceiver::Step CommandReceiver::step_strictly(Bytes in) noexcept {
  std::size_t used = 0;
  while (used < in.size()) {
    const auto step = strict_.step(in.subspan(used));
    used += step.used;
    if (const auto* frame = std::get_if<Splitter::Frame>(&step.found)) {
      return {used, body_of(frame->bytes.first<kCommandFrameSize>())};
    }
  }
  return {used, std::nullopt};
}

CommandReceiver::Step CommandReceiver::step_as_shipped(Bytes in) noexcept {
  std::size_t used = 0;
  while (used < in.size()) {
    const auto step = shipped_.step(in.subspan(used));
    used += step.used;
    const auto body = shipped_.body();
    if (step.accepted && allows(check_, std::to_integer<std::uint8_t>(body.back()))) {
      return {used, body};
    }
  }
  return {used, std::nullopt};
}

}  // namespace armjig::parol6::emulation
