// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The parts of a dissector for Wireshark that are the same for all devices, in Lua.
namespace armjig::lua {

/// What is the same for all devices. `messages`, `device`, `title`, `check` and what `Framing`
/// needs stand before it; then comes `cut`, of the framing, and then the rest.
extern const std::string_view kFields;
extern const std::string_view kCutSizes;
extern const std::string_view kCutLines;
extern const std::string_view kCutTransactions;
extern const std::string_view kShow;
extern const std::string_view kTcp;
extern const std::string_view kUsb;
extern const std::string_view kBus;
/// Of files that armjig wrote: each link is an interface, and each connection has a number.
extern const std::string_view kOwn;

}  // namespace armjig::lua
