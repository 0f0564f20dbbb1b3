// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The parts of pages that are made from data: field lists, catalogues, options, counts. In a page
/// they stand between `<!-- generated: WHAT -->` and `<!-- end -->`, on lines of their own or
/// inside a line:
///
///     requirements DEVICE, CHAPTER    the sentences of a chapter of its suite
///     fields DEVICE MESSAGE           what stands where in a message
///     flags DEVICE                    what the bits of its bytes of flags are
///     commands DEVICE, readings DEVICE
///     options DEVICE                  of the emulated one
///     counts                          what there is of each device, for README.md
namespace armjig::docs {

/// All pages that may have such parts, as paths from the root of the tree.
[[nodiscard]] std::vector<std::string> pages();

[[nodiscard]] std::string read_page(const std::string& path);

/// The page with all its generated parts as they should be. A part that cannot be made has a line
/// with `???` that says why.
[[nodiscard]] std::string renewed(std::string_view page);

}  // namespace armjig::docs
