// SPDX-License-Identifier: Apache-2.0
// Every recording of captures/, its host played in real time to a hosted emulated device over a
// pseudo-terminal, TCP or an I2C adapter: what it says is as recorded, within what real time
// allows.
//
//   hosted_replay_soak [DEVICE [AT_ONCE]]
#include <fmt/core.h>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "harness/capture/trace.hpp"
#include "tests/integration/support/hosted_replay.hpp"

namespace {

using armjig::testing::replay_hosted;

/// How many are not as recorded.
std::size_t different(std::string_view device, unsigned at_once) {
  const auto files =
      armjig::find_traces({fmt::format("{}/captures/{}", ARMJIG_SOURCE_DIR, device)}).value();
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> different{0};
  std::atomic<std::size_t> left_out{0};
  std::mutex printing;
  const auto work = [&] {
    for (auto i = next++; i < files.size(); i = next++) {
      const auto done = replay_hosted(device, files[i]);
      if (done && done->messages == 0) ++left_out;
      if (done && done->differences == 0) continue;
      ++different;
      const std::scoped_lock lock{printing};
      fmt::print("{}: {}\n", files[i],
                 done ? fmt::format("{} differences in {} messages, first {}", done->differences,
                                    done->messages, done->first)
                      : describe(done.error()));
    }
  };
  {
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < at_once; ++i) workers.emplace_back(work);
  }
  fmt::print("{}: {} recordings, {} left out, {} different\n", device, files.size(),
             left_out.load(), different.load());
  return different;
}

}  // namespace

int main(int argc, char** argv) {
  const auto at_once = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 4;
  std::size_t sum = 0;
  for (const auto device : armjig::testing::recorded_devices()) {
    if (argc > 1 && device != argv[1]) continue;
    sum += different(device, at_once);
  }
  return sum == 0 ? 0 : 1;
}
