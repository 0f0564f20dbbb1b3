// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/load.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "harness/timing/realtime.hpp"

namespace armjig {
namespace {

constexpr unsigned kMost = 64;

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

void compute(const std::atomic<bool>& must_end) {
  volatile std::uint64_t word = 1;
  while (!must_end) {
    for (int i = 0; i < 100'000; ++i) word = word * 6'364'136'223'846'793'005U + 1;
  }
}

void write(const std::atomic<bool>& must_end) {
  const std::unique_ptr<std::FILE, CloseFile> file{std::tmpfile()};
  const std::vector<char> block(std::size_t{64} << 10U, 'x');
  while (!must_end && file != nullptr) {
    std::rewind(file.get());
    for (int i = 0; i < 16; ++i) (void)std::fwrite(block.data(), 1, block.size(), file.get());
    std::fflush(file.get());
    (void)::fsync(::fileno(file.get()));
  }
}

}  // namespace

Outcome<LoadPlan> parse_load(std::string_view text) {
  LoadPlan plan;
  const auto wrong = problem(ErrorCode::kBadValue, fmt::format("--load '{}'", text),
                             "write cpu=2, io=1 or cpu=2,io=1, from 1 to 64 of each");
  for (auto rest = text;;) {
    const auto comma = rest.find(',');
    const auto part = rest.substr(0, comma);
    const auto sign = part.find('=');
    const auto name = part.substr(0, sign);
    if (sign == std::string_view::npos || (name != "cpu" && name != "io")) return wrong;
    auto& threads = name == "cpu" ? plan.cpu : plan.io;
    const auto* const end = part.data() + part.size();
    const bool is_twice = threads != 0;
    const auto [stop, error] = std::from_chars(part.data() + sign + 1, end, threads);
    if (error != std::errc{} || stop != end || is_twice || threads < 1 || threads > kMost) {
      return wrong;
    }
    if (comma == std::string_view::npos) return plan;
    rest.remove_prefix(comma + 1);
  }
}

Load::Load(const LoadPlan& plan) {
  const auto start = [this](unsigned count, void (*work)(const std::atomic<bool>&)) {
    for (unsigned i = 0; i < count; ++i) {
      threads_.emplace_back([this, work] {
        be_ordinary();
        work(must_end_);
      });
    }
  };
  start(plan.cpu, compute);
  start(plan.io, write);
}

Load::~Load() {
  must_end_ = true;
  for (auto& thread : threads_) thread.join();
}

}  // namespace armjig
