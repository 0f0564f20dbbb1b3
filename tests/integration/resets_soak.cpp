// SPDX-License-Identifier: Apache-2.0
// 100,000 clients of `armjig emulate kinovazed` that connect and reset, some after a command, some
// after a half-close. At the end it serves the next client, has no descriptor more than before,
// and has not grown by 1 MiB.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <string>

#include "harness/link/tcp_session.hpp"
#include "tests/integration/support/program.hpp"

namespace {

using namespace armjig;
using namespace std::chrono_literals;

constexpr int kClients = 100'000;
constexpr int kWarmUp = 2'000;
constexpr long kMaxGrowthKib = 1024;

std::ptrdiff_t open_files(pid_t pid) {
  const std::filesystem::directory_iterator files{fmt::format("/proc/{}/fd", pid)};
  return std::distance(files, {});
}

bool come_and_reset(SessionPort& client, int number) {
  if (!client.connect(client.now() + testing::kPatience)) return false;
  if (number % 3 == 0) (void)client.send(std::as_bytes(std::span{"EStop\r\n", 7}));
  if (number % 7 == 0) client.half_close();
  client.reset();
  return true;
}

/// Whether a client of its own is told something, after which nobody is left to be served.
bool is_served(SessionPort& client) {
  std::array<std::byte, 512> buffer;
  if (!client.connect(client.now() + testing::kPatience)) return false;
  const auto received = client.receive(buffer, client.now() + testing::kPatience);
  client.close();
  return received && received->arrival == SessionPort::Arrival::kData;
}

}  // namespace

int main() {
  // Documented: a reset may mute or end the shipped server, as it should.
  testing::Program program{{"emulate", "kinovazed", "--tcp", "0", "--set", "profile=documented"}};
  const auto client = *make_tcp_session(program.read_line().substr(sizeof "listening tcp:" - 1));
  int connected = 0;
  for (int i = 0; i < kWarmUp; ++i) connected += come_and_reset(*client, i) ? 1 : 0;
  bool is_well = is_served(*client);
  const auto files = open_files(program.pid());
  const auto memory = testing::resident_kib(program.pid());
  auto most_files = files;
  const Stopwatch clock;
  for (int i = 0; i < kClients; ++i) {
    connected += come_and_reset(*client, i) ? 1 : 0;
    if (i % 1000 == 0) most_files = std::max(most_files, open_files(program.pid()));
  }
  is_well = is_served(*client) && is_well;
  const auto seconds = std::chrono::duration<double>{clock.now().time_since_epoch()}.count();
  const auto files_after = open_files(program.pid());
  const auto growth = testing::resident_kib(program.pid()) - memory;
  program.signal(SIGTERM);
  const auto exit_code = program.wait();
  fmt::print(
      "soak: {} clients reset in {:.0f} s; descriptors {} before, {} at most, {} after; memory {} "
      "KiB grew by {} KiB; {}, exit {}\n",
      connected, seconds, files, most_files, files_after, memory, growth,
      is_well ? "the next client served" : "THE NEXT CLIENT NOT SERVED", exit_code);
  const bool is_right = is_well && connected == kWarmUp + kClients && files_after <= files;
  return is_right && growth < kMaxGrowthKib && exit_code == 0 ? 0 : 1;
}
