// SPDX-License-Identifier: Apache-2.0
// Minutes of garbage at full rate into the pseudo-terminal of `armjig emulate parol6`, by clients
// that stop reading, go and come again; then a good frame must be answered, and the emulator must
// not have grown by more than 1 MiB. ARMJIG_SOAK_MINUTES sets the length; the seed is printed.
#include <fmt/core.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>

#include "harness/core/hex.hpp"
#include "harness/link/real_streams.hpp"
#include "tests/integration/support/program.hpp"

namespace {

using namespace armjig;
using namespace std::chrono_literals;

constexpr std::array kPoll{std::byte{0xFF}, std::byte{0xFF}, std::byte{0xFF},
                           std::byte{0x02}, std::byte{0x01}, std::byte{0x02}};
constexpr std::size_t kTelemetrySize = 60;
constexpr long kMaxGrowthKib = 1024;
constexpr auto kVisit = 5s;    ///< of one client
constexpr auto kWarmUp = 10s;  ///< before memory is measured

/// Chunks of all kinds of wrong: noise, runs of start bytes, cut frames, and polls, which are
/// right.
class Garbage {
 public:
  explicit Garbage(std::uint32_t seed) : random_{seed} {}

  [[nodiscard]] Bytes next() {
    const auto kind = random_() % 4;
    if (kind == 0) {
      for (auto& byte : chunk_) byte = static_cast<std::byte>(random_());
    } else if (kind == 1) {
      chunk_.fill(std::byte{0xFF});
    } else {
      for (std::size_t i = 0; i < chunk_.size(); ++i) chunk_[i] = kPoll[i % kPoll.size()];
    }
    if (kind == 3) {
      for (int i = 0; i < 16; ++i) chunk_[random_() % chunk_.size()] = std::byte(random_());
    }
    return Bytes{chunk_}.first(1 + random_() % chunk_.size());
  }

 private:
  std::mt19937 random_;
  std::array<std::byte, 4096> chunk_{};
};

/// One client: writes for a while, reads now and then. Answers how much it wrote.
std::uint64_t visit(const std::string& path, Garbage& garbage, Duration length) {
  const auto port = open_pty(path);
  if (!port) return 0;
  std::uint64_t written = 0;
  std::array<std::byte, 4096> answers;
  while ((*port)->now() < at(length)) {
    const auto chunk = garbage.next();
    if (!(*port)->write(chunk)) return written;
    written += chunk.size();
    const bool is_deaf = (*port)->now() < at(length / 2);
    if (!is_deaf) (void)(*port)->read(answers, (*port)->now());
  }
  return written;
}

/// Ends whatever frame the garbage began, then asks as a good client does.
bool is_good_frame_answered(const std::string& path) {
  const auto port = open_pty(path);
  if (!port) return false;
  if (!(*port)->write(std::vector<std::byte>(1024, std::byte{0x55}))) return false;
  std::array<std::byte, 65536> old;
  while ((*port)->read(old, (*port)->now() + 500ms).value_or(0) > 0) {
  }
  if (!(*port)->write(kPoll)) return false;
  std::array<std::byte, 2 * kTelemetrySize> answer;
  std::size_t size = 0;
  const auto deadline = (*port)->now() + testing::kPatience;
  while (size < kTelemetrySize) {
    const auto got = (*port)->read(std::span{answer}.subspan(size), deadline);
    if (!got || *got == 0) return false;
    size += *got;
  }
  fmt::print("answer: {}\n", to_hex_dump(Bytes{answer}.first(size)));
  return size == kTelemetrySize && answer[3] == std::byte{56};
}

}  // namespace

int main() {
  const auto* const text = std::getenv("ARMJIG_SOAK_MINUTES");
  const std::chrono::duration<double, std::ratio<60>> minutes{text ? std::stod(text) : 10.0};
  const auto seed = std::random_device{}();
  testing::Program program{{"emulate", "parol6"}};
  const auto path = program.read_line().substr(sizeof "listening pty:" - 1);
  fmt::print("soak: {:.2f} minutes of garbage into {}, seed {}\n", minutes.count(), path, seed);

  Garbage garbage{seed};
  const Stopwatch clock;
  (void)visit(path, garbage, kWarmUp / 2);
  (void)visit(path, garbage, kWarmUp / 2);
  const auto before = testing::resident_kib(program.pid());
  std::uint64_t written = 0;
  const auto start = clock.now();
  while (clock.now() - start < minutes) {
    written += visit(path, garbage, kVisit);
    std::this_thread::sleep_for(20ms);  // as long as the next program takes to start
  }
  const auto seconds = std::chrono::duration<double>{clock.now() - start}.count();
  const bool is_answered = is_good_frame_answered(path);
  const auto growth = testing::resident_kib(program.pid()) - before;

  program.signal(SIGTERM);
  fmt::print("{}", program.read_errors());
  const auto exit_code = program.wait();
  fmt::print(
      "soak: {} bytes in {:.0f} s ({:.1f} MB/s), memory {} KiB grew by {} KiB, {}, exit {}\n",
      written, seconds, static_cast<double>(written) / seconds / 1e6, before, growth,
      is_answered ? "good frame answered" : "GOOD FRAME NOT ANSWERED", exit_code);
  return is_answered && growth < kMaxGrowthKib && exit_code == 0 ? 0 : 1;
}
