// SPDX-License-Identifier: Apache-2.0
// The demo device at the end of a pseudo-terminal, which prints the terminal's path and takes a
// normally distributed time for each answer.
//
//     delayed_echo MEAN_US DEVIATION_US SEED
#include <fmt/core.h>
#include <poll.h>
#include <pty.h>
#include <sched.h>
#include <sys/prctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "harness/link/random_source.hpp"
#include "harness/wire/demo/demo.hpp"

namespace {

using Clock = std::chrono::steady_clock;

void sleep_until(Clock::time_point end) {
  const auto ns = std::chrono::nanoseconds{end.time_since_epoch()}.count();
  const timespec until{.tv_sec = ns / 1'000'000'000, .tv_nsec = ns % 1'000'000'000};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

/// The near end is kept open, so that programs may come and go.
int open_terminal() {
  int far_end = -1;
  int near_end = -1;
  std::array<char, 64> path{};
  if (::openpty(&far_end, &near_end, path.data(), nullptr, nullptr) != 0) std::abort();
  termios settings{};
  (void)::tcgetattr(near_end, &settings);
  ::cfmakeraw(&settings);
  (void)::tcsetattr(near_end, TCSANOW, &settings);
  fmt::print("{}\n", path.data());
  std::fflush(stdout);
  return far_end;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const double mean = std::atof(arguments[1]);
  const double deviation = std::atof(arguments[2]);
  armjig::RandomSource random{std::strtoull(arguments[3], nullptr, 10)};
  const auto answer = armjig::demo::encode(armjig::demo::State::kReady);
  ::prctl(PR_SET_TIMERSLACK, 1UL);
  // A device has a processor of its own; as far as we may.
  const sched_param priority{.sched_priority = 60};
  (void)::sched_setscheduler(0, SCHED_FIFO, &priority);
  const int file = open_terminal();
  armjig::demo::Splitter splitter{armjig::demo::kRequestStart};
  std::array<std::byte, 64> buffer;
  for (;;) {
    pollfd entry{.fd = file, .events = POLLIN, .revents = 0};
    (void)::poll(&entry, 1, -1);
    const auto came = Clock::now();
    const auto size = ::read(file, buffer.data(), buffer.size());
    if (size <= 0) return 0;
    for (const auto byte : std::span{buffer}.first(static_cast<std::size_t>(size))) {
      if (!splitter.step(byte)) continue;
      const std::chrono::duration<double, std::micro> delay{
          std::max(0.0, mean + deviation * random.normal())};
      sleep_until(came + std::chrono::duration_cast<Clock::duration>(delay));
      (void)!::write(file, answer.data(), answer.size());
    }
  }
}
