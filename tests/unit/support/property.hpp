// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/detail/TestListenerAdapter.h>

#include <sstream>
#include <utility>

namespace armjig::test {

/// Runs a property of rapidcheck on the same cases each time; a failure shows the smallest case
/// that fails. `RC_ASSERT` inside.
template <class Property>
void for_all(Property&& property, int cases = 200) {
  rc::detail::TestParams parameters;
  parameters.seed = 20'240'329;
  parameters.maxSuccess = cases;
  rc::detail::TestListenerAdapter silent;
  const auto result = rc::detail::checkProperty(
      rc::detail::toProperty(std::forward<Property>(property)), {}, parameters, silent, {});
  if (result.template is<rc::detail::SuccessResult>()) return;
  std::ostringstream text;
  rc::detail::printResultMessage(result, text);
  ADD_FAILURE() << text.str();
}

}  // namespace armjig::test
