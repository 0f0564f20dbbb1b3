// SPDX-License-Identifier: Apache-2.0
#include "harness/link/random_source.hpp"

#include <cassert>

namespace armjig {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9E3779B97F4A7C15;

constexpr std::uint64_t mixed(std::uint64_t z) noexcept {
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
  z = (z ^ z >> 27) * 0x94D049BB133111EB;
  return z ^ z >> 31;
}

}  // namespace

std::uint64_t RandomSource::next() noexcept { return mixed(state_ += kGoldenGamma); }

double RandomSource::uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }

std::uint64_t RandomSource::below(std::uint64_t bound) noexcept {
  assert(bound >= 1 && bound <= std::uint64_t{1} << 53);
  return static_cast<std::uint64_t>(uniform() * static_cast<double>(bound));
}

bool RandomSource::happens(double probability) noexcept { return uniform() < probability; }

// von Neumann 1951: a uniform x begins a falling run of odd length with probability exp(-x).
double RandomSource::exponential() noexcept {
  for (double whole = 0;; whole += 1) {
    const double first = uniform();
    double last = first;
    double next = uniform();
    bool is_odd = true;
    while (next < last) {
      last = next;
      next = uniform();
      is_odd = !is_odd;
    }
    if (is_odd) return whole + first;
  }
}

// exp(-x*x/2) is exp(-x) times exp(-(x-1)*(x-1)/2), but for a constant: the first is drawn, the
// second is the chance to keep it, which another exponential decides.
double RandomSource::normal() noexcept {
  while (true) {
    const double size = exponential();
    const double off = size - 1;
    if (exponential() >= off * off / 2) return next() >> 63 == 0 ? size : -size;
  }
}

RandomSource RandomSource::fork(std::uint64_t index) const noexcept {
  return RandomSource{mixed(state_ ^ mixed((index + 1) * kGoldenGamma))};
}

}  // namespace armjig
