// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "harness/script/program.hpp"

namespace armjig::script {

/// The command as it is best written in that dialect; a `Flaw` has no such form and gives an empty
/// text. Reading it again gives the same command.
[[nodiscard]] std::string to_text(const Command& command, Dialect dialect);

/// The program in one style: one blank behind each comma in the documented dialect, none in the
/// commander's, which would not take it everywhere. Comments stay; several empty lines become one,
/// and none in the commander's dialect. What the commander would ignore is gone, and lines that it
/// would stumble over stay as they are. Formatting twice changes nothing. Errors: those of `parse`.
[[nodiscard]] tl::expected<std::string, std::vector<Diagnostic>> format(std::string_view text,
                                                                        Dialect dialect);

}  // namespace armjig::script
