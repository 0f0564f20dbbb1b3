// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "harness/wire/field.hpp"
#include "harness/wire/kinovazed/vocabulary.hpp"

namespace armjig::kinovazed {

/// The pieces of a command: its word, then its arguments.
[[nodiscard]] std::span<const Field> command_fields(Verb verb) noexcept;

/// The one piece of an event.
[[nodiscard]] std::span<const Field> event_fields() noexcept;

/// The pieces of a heartbeat; the second one are flags.
[[nodiscard]] std::span<const Field> heartbeat_fields() noexcept;

}  // namespace armjig::kinovazed
