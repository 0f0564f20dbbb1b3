// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "conformance/mutation.hpp"
#include "conformance/program_checker.hpp"
#include "conformance/suite.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/rig.hpp"

/// What the header of a device's suite needs. A device gives `suite()`, `make_bench()`,
/// `mutants_entry()` and, if programs that talk to it are judged, `program_check()`.
