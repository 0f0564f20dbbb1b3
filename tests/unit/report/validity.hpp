// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

/// Judges that are not ours. One that is not installed fails the test and says which package it is.
namespace armjig::test {

/// xmllint with tests/data/junit.xsd.
[[nodiscard]] ::testing::AssertionResult is_valid_junit(std::string_view xml);

/// python3-jsonschema with a schema of this tree: `docs/schemas/report.schema.json`.
[[nodiscard]] ::testing::AssertionResult is_valid_json(std::string_view json,
                                                       std::string_view schema);

}  // namespace armjig::test
