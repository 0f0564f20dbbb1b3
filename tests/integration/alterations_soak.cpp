// SPDX-License-Identifier: Apache-2.0
// A thousand random places of each device's recordings are changed, and a thousand answers: all are
// found and named.
//
//   alterations_soak CAPTURES [PLACES [FIRST_SEED [DEVICE]]]
#include <fmt/core.h>

#include <cstdlib>
#include <string>
#include <string_view>

#include "tests/unit/compare/altered_recording.hpp"

namespace {

constexpr std::array<std::string_view, 3> kDevices{"parol6", "kinovazed", "morap"};

/// How many were not.
std::uint64_t overlooked(const std::string& folder, std::uint64_t first, std::uint64_t count) {
  armjig::test::AlteredCorpus corpus{folder};
  std::uint64_t overlooked = corpus.is_empty() ? 1 : 0;
  for (auto seed = first; seed < first + count && !corpus.is_empty(); ++seed) {
    const auto complaint = corpus.complaint(seed);
    if (!complaint.empty()) ++overlooked;
    fmt::print("{}", complaint);
  }
  fmt::print("{}: {} places and {} answers, {} not found and named\n", folder, count, count,
             overlooked);
  return overlooked;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto count = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1'000;
  const auto first = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1'000'000;
  std::uint64_t sum = 0;
  for (const auto device : kDevices) {
    if (argc > 4 && device != argv[4]) continue;
    sum += overlooked(fmt::format("{}/{}", argv[1], device), first, count);
  }
  return sum == 0 ? 0 : 1;
}
