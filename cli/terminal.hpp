// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include "harness/report/report.hpp"

namespace armjig::cli {

/// Adds `--color`; `when` is what `style_of` wants.
void add_colour_option(CLI::App& command, std::string& when);

/// Whether what is written to `stream` has colours: `always`, `never`, or for `auto` if it is a
/// terminal that can do more than print and the environment has no NO_COLOR that says anything.
[[nodiscard]] Style style_of(std::string_view when, std::FILE* stream);

/// The columns that help may take: what COLUMNS says, or the terminal's own width, but at least 60;
/// 80 if nobody knows.
[[nodiscard]] std::size_t help_width();

/// The text with lines of at most `width` columns where it has blanks to break them at. What goes
/// on stands below where the last column of the line began. Prose that was broken by hand is joined
/// first; lines that begin with a blank are not prose.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t width);

}  // namespace armjig::cli
