// SPDX-License-Identifier: Apache-2.0
// Ten thousand random sessions of each device: each is a recording that verifies, and the emulator
// does what its plain model does.
//
//   sessions_soak [SESSIONS [FIRST_SEED [DEVICE]]]
#include <fmt/core.h>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/unit/emulators/sessions/drawn_session.hpp"

namespace {

using armjig::test::DrawnDevice;

std::uint64_t differences_of(const DrawnDevice& device, std::uint64_t first, std::uint64_t count) {
  std::atomic<std::uint64_t> next{0};
  std::atomic<std::uint64_t> different{0};
  std::mutex printing;
  const auto work = [&] {
    for (auto i = next++; i < count; i = next++) {
      const auto seed = first + i;
      const auto complaint = armjig::test::complaint_about_recording(device, seed) +
                             armjig::test::complaint_about_plain_model(device, seed);
      if (complaint.empty()) continue;
      ++different;
      const std::scoped_lock lock{printing};
      fmt::print("{} seed {}:\n{}", device.name, seed, complaint);
    }
  };
  {
    std::vector<std::jthread> workers;
    const auto threads = std::max(std::thread::hardware_concurrency(), 1U);
    for (unsigned i = 0; i < threads; ++i) workers.emplace_back(work);
  }
  fmt::print("{}: {} sessions, {} different\n", device.name, count, different.load());
  return different;
}

}  // namespace

int main(int argc, char** argv) {
  const auto count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000;
  const auto first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1'000'000;
  std::uint64_t different = 0;
  for (const auto& device : armjig::test::kDrawnDevices) {
    if (argc > 3 && device.name != argv[3]) continue;
    different += differences_of(device, first, count);
  }
  return different == 0 ? 0 : 1;
}
