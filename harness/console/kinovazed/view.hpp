// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/wire/kinovazed/line.hpp"

/// How a KinovaZED server looks in a terminal.
namespace armjig::kinovazed::console {

/// The state that a beat tells, as far as it does: several states have the same one.
[[nodiscard]] std::string state_of(Heartbeat beat);

/// `21: connected, initialized, idle`.
[[nodiscard]] std::string flags_of(Heartbeat beat);

}  // namespace armjig::kinovazed::console
