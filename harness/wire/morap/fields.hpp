// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "harness/wire/field.hpp"
#include "harness/wire/morap/controller_set.hpp"
#include "harness/wire/morap/message.hpp"

/// The fields of each message as it passes on the bus: the byte with address and direction first,
/// then the data bytes. The lists live as long as the program.
namespace armjig::morap {

/// A write of nothing, and of what nobody knows.
[[nodiscard]] std::span<const Field> poke_fields() noexcept;
[[nodiscard]] std::span<const Field> unknown_write_fields() noexcept;

/// A write of `command`. Not for `kProgram`, whose fields depend on its counts.
[[nodiscard]] std::span<const Field> write_fields(const CommandInfo& command);
/// A write that chooses what to read.
[[nodiscard]] std::span<const Field> select_fields() noexcept;
[[nodiscard]] std::span<const Field> program_fields(const ControllerSet& set);

/// The answer to a read. Not for controller sets.
[[nodiscard]] std::span<const Field> read_fields(const ReadInfo& reading);
[[nodiscard]] std::span<const Field> read_set_fields(const ControllerSet& set);

[[nodiscard]] std::span<const Field> pen_fields() noexcept;
[[nodiscard]] std::span<const Field> pen_position_fields() noexcept;

}  // namespace armjig::morap
