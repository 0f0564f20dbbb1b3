// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/report/report.hpp"

/// Made-up runs that have something of everything a report can hold.
namespace armjig::test {

/// What a hostile device might have sent: markup, quotes, controls, an escape sequence of
/// terminals, bytes that are no UTF-8 (a lone continuation, an overlong slash, half of a
/// surrogate pair), characters that XML forbids, and an emoji, which is harmless.
inline const std::string kNasty =
    std::string{"<script>alert(\"x\")</script> & 'q' ]]> {{title}} \x1b[31mred\x1b[0m nul:"} +
    '\0' + " del:\x7F c1:\xC2\x9B bad:\x80 \xC0\xAF \xED\xA0\x80 non:\xEF\xBF\xBE \xF0\x9F\xA6\xBE";

/// A row of each verdict, in three topics.
[[nodiscard]] Report one_of_each();

/// `one_of_each` with `kNasty` and a very long line in each string.
[[nodiscard]] Report nasty_report();

/// A run of a drive with sections, tables and a plot of each kind.
[[nodiscard]] Report drive_report();

}  // namespace armjig::test
