// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "conformance/requirement.hpp"

namespace armjig {

/// The documents of docs/spec. The build makes them: cmake/document_lines.cmake.
[[nodiscard]] std::span<const Document> shipped_documents() noexcept;

}  // namespace armjig
