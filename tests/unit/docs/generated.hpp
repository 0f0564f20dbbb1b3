// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The parts of pages that are made from data: field lists, catalogues, options, counts, arrows
/// between rooms. In a page they stand between `<!-- generated: WHAT -->` and `<!-- end -->`, on
/// lines of their own or inside a line:
///
///     requirements DEVICE, CHAPTER    the sentences of a chapter of its suite
///     fields DEVICE MESSAGE           what stands where in a message
///     flags DEVICE                    what the bits of its bytes of flags are
///     commands DEVICE, readings DEVICE
///     options DEVICE                  of the emulated one
///     inputs DEVICE                   what a hand beside the emulated one can do
///     impairments                     what `--impair` takes
///     uses FOLDER                     what the rooms in it may use
///     counts                          what there is of each device, for README.md
namespace armjig::docs {

/// A folder of sources, and the rooms that it may use, with blanks between; itself goes unsaid.
struct Room {
  std::string_view folder;
  std::string_view uses;
};

/// All rooms, from the bottom up (include_arrows_test.cpp has them).
[[nodiscard]] std::span<const Room> rooms() noexcept;

/// All pages that may have such parts, as paths from the root of the tree.
[[nodiscard]] std::vector<std::string> pages();

[[nodiscard]] std::string read_page(const std::string& path);

/// The page with all its generated parts as they should be. A part that cannot be made has a line
/// with `???` that says why.
[[nodiscard]] std::string renewed(std::string_view page);

}  // namespace armjig::docs
