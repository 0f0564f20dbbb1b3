// SPDX-License-Identifier: Apache-2.0
// Compiled by scripts/mutate for each device: ARMJIG_DEVICE is its namespace, and its headers
// options.hpp and replay/DEVICE.hpp come from the command line.
#include "tests/mutation/judged.hpp"

namespace {

armjig::Outcome<armjig::AnyHosted> emulate(const armjig::DeviceOptions& options,
                                           const std::string& where) {
  return armjig::ARMJIG_DEVICE::emulation::make(options, where).map([](auto device) {
    return armjig::AnyHosted{armjig::make_hosted(std::move(device))};
  });
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const armjig::mutation::Judged* armjig_judged() {
  static constexpr armjig::mutation::Judged kJudged{armjig::ARMJIG_DEVICE::replay::replay, emulate};
  return &kJudged;
}
