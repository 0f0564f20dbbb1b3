// SPDX-License-Identifier: Apache-2.0
// Minutes of a hostile peer at full rate against `armjig emulate kinovazed`: noise, floods of
// commands, endless lines, clients that never read, half-close, reset. Meanwhile a second client
// connects again and again and must be served when, and only when, its turn comes. At the end the
// emulator lives and has not grown by 1 MiB. ARMJIG_SOAK_MINUTES sets the length; the seed is
// printed.
#include <fmt/core.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <string_view>

#include "harness/link/tcp_session.hpp"
#include "tests/integration/support/program.hpp"

namespace {

using namespace armjig;
using namespace std::chrono_literals;
using Arrival = SessionPort::Arrival;

constexpr long kMaxGrowthKib = 1024;
constexpr auto kVisit = 2s;  ///< of one hostile client
constexpr auto kWarmUp = 20s;

/// Everything that should not be sent, and everything that may.
class Hostility {
 public:
  explicit Hostility(std::uint32_t seed) : random_{seed} {}

  [[nodiscard]] std::string next() {
    static constexpr std::array<std::string_view, 16> kLines{
        "EStop\r\n",
        "QuitEStop\r\n",
        "Initialize\r\n",
        "Retract\r\n",
        "Unfold\r\n",
        "Freeze\r\n",
        "Unfreeze\n",
        "SetJoystickMode:XYZ\r\n",
        "SetJoystickMode:NoMode\r\n",
        "MoveJoystick:400:-400:2147483647\r\n",
        "MoveJoystick:99999999999999999999:0:0\r\n",
        "RunObjective:Home\r\n",
        "RunObjective:PullDoor\r\n",
        "SetActiveObjective:Antenna\r\n",
        "\n\n\nHeartbeat:3\r\n",
        "::::\r\n",
    };
    const auto kind = roll(64);
    if (kind == 0) return std::string(1 + roll(8192), 'A');  // ends the connection
    std::string text;
    if (kind < 16) {
      text.resize(1 + roll(512));
      for (auto& c : text) c = static_cast<char>(random_());
      return text + "\r\n";
    }
    for (auto n = 1 + roll(200); n > 0; --n) text += kLines[roll(kLines.size())];
    return text;
  }
  [[nodiscard]] std::uint32_t roll(std::uint32_t sides) {
    return static_cast<std::uint32_t>(random_() % sides);
  }

 private:
  std::mt19937 random_;
};

/// What was seen of the second clients.
struct Seconds {
  int served = 0;
  int early = 0;  ///< heard something while another one was served
};

/// Whether a beat or an answer comes in that time.
bool hears(SessionPort& port, Duration patience) {
  std::array<std::byte, 4096> buffer;
  const auto received = port.receive(buffer, port.now() + patience);
  return received && received->arrival == Arrival::kData;
}

/// One hostile client, and a second one behind it. Answers how much was written.
std::uint64_t visit(const std::string& address, Hostility& hostility, Duration length,
                    Seconds& seconds) {
  const auto first = *make_tcp_session(address);
  if (!first->connect(first->now() + 5s)) return 0;
  const auto second = *make_tcp_session(address);
  const bool is_waiting = second->connect(second->now() + 5s).has_value();
  const bool is_deaf = hostility.roll(2) == 0;
  std::uint64_t written = 0;
  std::array<std::byte, 4096> answers;
  const auto start = first->now();
  bool is_served = true;  // until the server throws it out
  while (is_served && first->now() - start < length) {
    const auto chunk = hostility.next();
    if (!first->send(std::as_bytes(std::span{chunk}))) break;  // also: the server takes no more
    written += chunk.size();
    if (is_deaf) continue;
    const auto received = first->receive(answers, first->now());
    is_served =
        received && received->arrival != Arrival::kEnd && received->arrival != Arrival::kReset;
  }
  if (is_waiting && is_served && first->now() - start >= length && hears(*second, 0s)) {
    // The server may have ended the first connection just now; then nothing is early.
    const auto received = first->receive(answers, first->now());
    const bool is_over =
        !received || received->arrival == Arrival::kEnd || received->arrival == Arrival::kReset;
    if (!is_over && !is_deaf) ++seconds.early;
  }
  const auto farewell = hostility.roll(3);
  if (farewell == 0) first->reset();
  if (farewell == 1) first->half_close();
  first->close();
  (void)second->send(std::as_bytes(std::span{"EStop\r\n", 7}));
  if (is_waiting && hears(*second, 10s)) ++seconds.served;
  return written;
}

}  // namespace

int main() {
  const auto* const text = std::getenv("ARMJIG_SOAK_MINUTES");
  const std::chrono::duration<double, std::ratio<60>> minutes{text ? std::stod(text) : 10.0};
  const auto seed = std::random_device{}();
  // Documented: the shipped server may be hung or muted by its first client, as it should.
  testing::Program program{{"emulate", "kinovazed", "--tcp", "0", "--set", "profile=documented"}};
  const auto address = program.read_line().substr(sizeof "listening tcp:" - 1);
  fmt::print("soak: {:.2f} minutes against tcp:{}, seed {}\n", minutes.count(), address, seed);

  Hostility hostility{seed};
  Seconds seconds;
  const Stopwatch clock;
  while (clock.now() < at(kWarmUp)) (void)visit(address, hostility, kVisit, seconds);
  const auto before = testing::resident_kib(program.pid());
  seconds = {};
  std::uint64_t written = 0;
  int visits = 0;
  const auto start = clock.now();
  for (; clock.now() - start < minutes; ++visits) {
    written += visit(address, hostility, kVisit, seconds);
  }
  const auto time = std::chrono::duration<double>{clock.now() - start}.count();
  const auto growth = testing::resident_kib(program.pid()) - before;
  program.signal(SIGTERM);
  const auto exit_code = program.wait();
  fmt::print(
      "soak: {} bytes in {:.0f} s ({:.1f} MB/s) by {} clients, memory {} KiB grew by {} KiB; "
      "second "
      "clients: {} served, {} before their turn; exit {}\n",
      written, time, static_cast<double>(written) / time / 1e6, visits, before, growth,
      seconds.served, seconds.early, exit_code);
  const bool is_right = seconds.served == visits && seconds.early == 0;
  return is_right && growth < kMaxGrowthKib && exit_code == 0 ? 0 : 1;
}
