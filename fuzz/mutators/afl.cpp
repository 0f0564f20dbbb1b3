// SPDX-License-Identifier: Apache-2.0
// The same as a library for AFL++ (AFL_CUSTOM_MUTATOR_LIBRARY), which has no mutator to borrow:
// what is left to the engine is one byte here. ARMJIG_FUZZED is the target's name.
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "fuzz/mutators/forms.hpp"

namespace armjig::fuzz {
namespace {

class AflMutator {
 public:
  explicit AflMutator(std::uint64_t seed) : dice_{seed} {}

  std::span<std::uint8_t> mutate(std::span<const std::uint8_t> input, std::size_t most) {
    out_.assign(most, 0);
    std::ranges::copy(input.first(std::min(input.size(), most)), out_.begin());
    const auto seed = dice_.number<std::uint64_t>(0, INT64_MAX);
    const auto size = mutator_.mutate(out_.data(), std::min(input.size(), most), most, seed);
    return std::span{out_}.first(size);
  }

 private:
  std::size_t change_byte(std::uint8_t* data, std::size_t size) {
    if (size > 0)
      data[dice_.number<std::size_t>(0, static_cast<std::int64_t>(size) - 1)] =
          dice_.number<std::uint8_t>(0, 255);
    return size;
  }

  sessions::Dice dice_;
  MessageMutator mutator_{forms::ARMJIG_FUZZED,
                          [this](std::uint8_t* data, std::size_t size, std::size_t /*most*/) {
                            return change_byte(data, size);
                          }};
  std::vector<std::uint8_t> out_;
};

}  // namespace
}  // namespace armjig::fuzz

// NOLINTBEGIN(readability-identifier-naming): the names that AFL++ calls
// NOLINTBEGIN(bugprone-reserved-identifier): and those that targets call, whose flags this library
// is compiled with, too. What it reaches itself is of no interest.
extern "C" __attribute__((no_sanitize("coverage"))) void __sanitizer_cov_trace_pc_guard_init(
    std::uint32_t* /*begin*/, std::uint32_t* /*end*/) {}
extern "C" __attribute__((no_sanitize("coverage"))) void __sanitizer_cov_trace_pc_guard(
    std::uint32_t* /*guard*/) {}
// NOLINTEND(bugprone-reserved-identifier)
extern "C" void* afl_custom_init(void* /*afl*/, unsigned int seed) {
  return std::make_unique<armjig::fuzz::AflMutator>(seed).release();
}
extern "C" void afl_custom_deinit(void* mutator) {
  const std::unique_ptr<armjig::fuzz::AflMutator> owned{
      static_cast<armjig::fuzz::AflMutator*>(mutator)};
}
extern "C" std::size_t afl_custom_fuzz(void* mutator, std::uint8_t* data, std::size_t size,
                                       std::uint8_t** out, std::uint8_t* /*other*/,
                                       std::size_t /*other_size*/, std::size_t max_size) {
  const auto mutated =
      static_cast<armjig::fuzz::AflMutator*>(mutator)->mutate({data, size}, max_size);
  *out = mutated.data();
  return mutated.size();
}
// NOLINTEND(readability-identifier-naming)
