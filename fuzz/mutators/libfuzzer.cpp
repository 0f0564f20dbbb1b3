// SPDX-License-Identifier: Apache-2.0
// Compiled for each target that has a form: ARMJIG_FUZZED is its name.
#include "fuzz/mutators/forms.hpp"

// NOLINTBEGIN(readability-identifier-naming): the names that libFuzzer calls and has
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  static const armjig::fuzz::MessageMutator mutator{armjig::fuzz::forms::ARMJIG_FUZZED,
                                                    LLVMFuzzerMutate};
  return mutator.mutate(data, size, max_size, seed);
}
// NOLINTEND(readability-identifier-naming)
