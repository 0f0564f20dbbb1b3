// SPDX-License-Identifier: Apache-2.0
#include "cli/program_judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace armjig::cli {
namespace {

/// What is broken in every message need not be said a hundred times a second.
constexpr std::size_t kMostLines = 3;

}  // namespace

Outcome<std::unique_ptr<ProgramCheck>> make_program_check(std::string_view device,
                                                          const LinkNoise& noise) {
  const auto entries = program_checks();
  const auto entry = std::ranges::find(entries, device, &ProgramCheckEntry::device);
  if (entry == entries.end()) {
    return problem(ErrorCode::kBadValue, "--check",
                   "nothing is demanded of programs for " + std::string{device});
  }
  auto lines = std::make_shared<std::map<std::string_view, std::size_t>>();
  return std::make_unique<ProgramCheck>(*entry, noise, [lines](const Offence& offence) {
    if (++(*lines)[offence.requirement] > kMostLines) return;
    fmt::print(stderr, "armjig: {:.3f} s {}: {}\n",
               std::chrono::duration<double>{offence.time.time_since_epoch()}.count(),
               offence.requirement, offence.what);
  });
}

/// A program waits for each transaction, and the time of the bus never falls behind the wall clock
/// meanwhile: no pause is seen shorter than the program made it, so there is no noise.
Outcome<std::unique_ptr<BusCheck>> BusCheck::make(std::string_view device) {
  auto check = make_program_check(device, {});
  if (!check) return tl::unexpected{check.error()};
  return std::make_unique<BusCheck>(*std::move(check));
}

BusCheck::BusCheck(std::unique_ptr<ProgramCheck> check) noexcept : check_{std::move(check)} {}

BusListener BusCheck::listener() {
  return [this](Instant time, Bytes message) {
    const std::lock_guard lock{guard_};
    const bool is_read = (message[0] & std::byte{1}) != std::byte{};
    is_read ? check_->from_device(time, message) : check_->to_device(time, message);
  };
}

Report BusCheck::finish() {
  const std::lock_guard lock{guard_};
  return check_->finish();
}

}  // namespace armjig::cli
