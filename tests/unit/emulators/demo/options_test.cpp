// SPDX-License-Identifier: Apache-2.0
#include "emulators/demo/options.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/support/options.hpp"

namespace armjig::demo::emulation {
namespace {

TEST(DemoOptions, TakeTheirDocumentedValues) {
  expect_documented_values(options(),
                           [](const DeviceOptions& given, const std::string& where) {
                             return make(given, where).map([](const auto&) {});
                           },
                           {{"fault", {"zero:state", "zero:none"}}});
}

}  // namespace
}  // namespace armjig::demo::emulation
