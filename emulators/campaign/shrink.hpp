// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "emulators/campaign/script.hpp"

namespace armjig::campaign {

/// Whether a script still shows what is sought.
using Shows = std::function<bool(const Script& script)>;

/// The shortest script it finds that still shows it: without records that do not matter (delta
/// debugging; A. Zeller, 2002), then in less time, then with what matters of each message's fields
/// and bytes. What counts messages or bytes gets as many of a plain kind, or fewer and longer ones;
/// what shows at a moment that has to be met gets a question time and again, until one is there in
/// that moment. `script` shows it; `may_go_on` is asked before each attempt. The last script that
/// was looked at and showed it is the one that is returned. `plain` is a harmless exchange, whose
/// messages are tried in place of others.
[[nodiscard]] Script shrink(Script script, const Script& plain, MakeDissector make_dissector,
                            const Shows& shows, const std::function<bool()>& may_go_on);

}  // namespace armjig::campaign
