// SPDX-License-Identifier: Apache-2.0
// What measuring costs: round trips of `armjig latency`'s meter beside those of a bare write, poll
// and read, in alternated rounds against one echo, over a pseudo-terminal and over TCP. And what
// two rounds of the bare one differ by. Ratios are medians of the rounds'.
#include <fmt/core.h>

#include <array>
#include <chrono>
#include <memory>
#include <string_view>
#include <thread>
#include <vector>

#include "harness/latency/generic_probe.hpp"
#include "harness/latency/meter.hpp"
#include "harness/rig/demo_judge.hpp"
#include "harness/rig/guarded_ports.hpp"
#include "harness/timing/realtime.hpp"
#include "harness/wire/demo/demo.hpp"
#include "tests/integration/support/bare_trips.hpp"
#include "tests/unit/support/link_ends.hpp"

namespace armjig {
namespace {

using namespace testing;

constexpr int kRounds = 11;
constexpr std::size_t kTrips = 5'000;

Trips ours(StreamPort& port, Bytes request) {
  const auto probe = generic::make_probe("echo", {request.begin(), request.end()}, request.size());
  const auto path = path_on(port, direct_line(port, {}).value());
  Meter meter{*path, *probe, {.period = std::nullopt, .expected = kTrips}, [] { return false; }};
  if (!meter.run({.count = kTrips}).value_or(false)) fmt::print("the link has gone\n");
  return trips_of(meter.measured().round_trips);
}

bool compare(std::string_view name, test::LinkEnds ends, DescriptorStream::Put put) {
  const auto request = demo::encode(demo::Operation::kQuery);
  const auto near = ends.near.value();
  std::thread other{[file = ends.far.value()] {
    be_ordinary();
    echo(file);
  }};
  auto port = GuardedStream::guard(std::make_unique<DescriptorStream>(std::move(ends.near), put),
                                   demo::rig::make_judge(), {});
  std::array<std::byte, 16> opening;  // of the judge, echoed
  (void)(*port)->read(opening, (*port)->now() + std::chrono::milliseconds{50});
  std::array<std::vector<double>, 4> ratios;
  for (int i = 0; i < kRounds; ++i) {
    const auto first = bare_trips(near, request, kTrips);
    const auto measured = ours(**port, request);
    const auto second = bare_trips(near, request, kTrips);
    ratios[0].push_back(measured.median / first.median);
    ratios[1].push_back(measured.p99 / first.p99);
    ratios[2].push_back(second.median / first.median);
    ratios[3].push_back(second.p99 / first.p99);
  }
  fmt::print("{}: ours to bare {:.2f} at 50 %, {:.2f} at 99 %; bare to bare {:.2f}, {:.2f}\n", name,
             middle(ratios[0]), middle(ratios[1]), middle(ratios[2]), middle(ratios[3]));
  port->reset();  // the echo ends
  other.join();
  return middle(ratios[0]) <= 1.1 && middle(ratios[1]) <= 1.2;
}

}  // namespace
}  // namespace armjig

int main() {
  const bool is_terminal_met =
      armjig::compare("PTY", armjig::test::make_terminal_ends(), armjig::write_all);
  const bool is_tcp_met = armjig::compare("TCP", armjig::test::make_tcp_ends(), armjig::send_all);
  return is_terminal_met && is_tcp_met ? 0 : 1;
}
