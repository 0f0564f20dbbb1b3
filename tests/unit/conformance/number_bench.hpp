// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "conformance/bench.hpp"
#include "harness/report/report.hpp"

namespace armjig {

/// A device that is a number: cases look at it, start states set it.
class NumberBench final : public Bench {
 public:
  bool is_alive() override {
    if (is_gibberish) fail("a number", "a letter");
    return !is_dead && !is_gibberish;
  }
  bool can_restart() override { return !has_nobody; }
  bool revive() override {
    if (revivals_left-- <= 0) return false;
    is_dead = false;
    return true;
  }
  void bring_to(std::size_t start) override {
    visited.push_back(start);
    if (stops_in_start-- > 0) {
      missed += std::chrono::seconds{1};
      return fail("the state", "nothing");
    }
    if (late_starts-- > 0) expect_in_time({2000, 0, 1000, "ms"}, "the state", "a late one");
    if (start != kUnreachable) return;
    leaves_beyond_open ? leave_open("no hand") : fail("the state", "another one");
  }
  void measure_noise() override {
    ++measured;
    hear_noise(noise_here);
  }
  [[nodiscard]] Duration longest_answer() const noexcept override {
    return std::chrono::milliseconds{500};
  }
  [[nodiscard]] bool is_stopped() override { return is_stopped_now; }
  void resume() override { is_stopped_now = false; }
  using Bench::lose_link;
  [[nodiscard]] Instant now() const override { return at(std::chrono::seconds{1} * calls); }
  [[nodiscard]] std::string last_exchange() const override { return "the last exchange\n"; }

  static constexpr std::size_t kUnreachable = 2;

  std::vector<std::size_t> visited;
  std::vector<std::string> ran;
  std::vector<std::uint32_t> randoms;
  int calls = 0;
  int measured = 0;
  Duration noise_here = std::chrono::microseconds{3};
  int late_answers = 0;  ///< of the next ones
  int wrong_answers = 0;
  int late_starts = 0;
  bool is_dead = false;
  bool has_nobody = false;  ///< who could start it again
  int revivals_left = 0;    ///< so many times one that is dead can be brought back
  int deaths_left = 2;      ///< in the case that it dies of
  bool is_gibberish = false;
  bool leaves_beyond_open = false;
  bool obeys_firmware = true;
  bool is_stopped_now = false;  ///< by who watches over it
  int supervisors_left = 0;     ///< so many times that happens in a case
  Duration missed{};            ///< in which it did not run
  int stops_left = 0;           ///< so many times it stops in a case
  int stops_in_start = 0;       ///< and on the way to its start

 protected:
  void forget_exchange() override {}
};

inline NumberBench& number(Bench& bench) {
  auto& device = static_cast<NumberBench&>(bench);
  ++device.calls;
  return device;
}

/// The name of each row, and what it came to.
inline std::vector<std::string> verdicts(const Report& report) {
  std::vector<std::string> words;
  for (const auto& row : report.rows) {
    words.push_back(row.name + " " + std::string{to_string(row.verdict)});
  }
  return words;
}

}  // namespace armjig
