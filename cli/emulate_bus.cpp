// SPDX-License-Identifier: Apache-2.0
#include "cli/emulate_bus.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "emulators/host/virtual_i2c.hpp"

namespace armjig::cli {
namespace {

constexpr int kLastBus = 255;

/// Takes the number of the bus out of the options.
Outcome<int> take_number(DeviceOptions& options, const std::string& where) {
  const auto said = options.find("bus");
  if (said == options.end()) return 1;
  const auto text = said->second;
  options.erase(said);
  int number = -1;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc{} && stop == text.data() + text.size();
  if (is_number && number >= 0 && number <= kLastBus) return number;
  return problem(ErrorCode::kBadValue, fmt::format("{}, bus={}", where, text),
                 "write the N of /dev/i2c-N, 0 to 255");
}

void announce(const VirtualI2c& bus, std::string_view device, Announcement form) {
  const auto target = "i2c:" + bus.path();
  const auto environment = bus.environment();
  if (form == Announcement::kJson) {
    const nlohmann::ordered_json line{{"schema", "armjig.emulate/1"},
                                      {"device", device},
                                      {"listening", {target}},
                                      {"environment", environment},
                                      {"pid", ::getpid()}};
    fmt::print("{}\n", line.dump());
  } else {
    fmt::print("listening {} for programs that are started with\n ", target);
    for (const auto& variable : environment) fmt::print(" {}", variable);
    fmt::print(" PROGRAM\n");
  }
  std::fflush(stdout);  // whoever waits for the line may be behind a pipe
}

/// Blocks the signals that end a server, for this thread and those that it starts.
sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

}  // namespace

Exit emulate_bus(const BusEntry& entry, DeviceOptions options, Announcement form,
                 BusListener listener) {
  const std::string device{entry.device};
  const auto number = take_number(options, device);
  if (!number) return report(number.error());
  auto bus = entry.make(options, device);
  if (!bus) return report(bus.error());
  const auto signals = block_signals();
  const auto i2c = VirtualI2c::open(*std::move(bus), *number, std::move(listener));
  if (!i2c) return report(i2c.error());
  announce(*i2c, entry.device, form);
  int signal = 0;
  ::sigwait(&signals, &signal);
  return Exit::kPassed;
}

}  // namespace armjig::cli
