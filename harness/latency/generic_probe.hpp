// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "harness/latency/probe.hpp"

/// For devices of which nothing more is known than one question and how long its answer is.
namespace armjig::generic {

/// Sends `request`, which only observes; what comes then is the answer when it has that size.
/// `exchange` is as of `Probe`.
[[nodiscard]] std::unique_ptr<Probe> make_probe(std::string exchange,
                                                std::vector<std::byte> request,
                                                std::size_t answer_size);

}  // namespace armjig::generic
