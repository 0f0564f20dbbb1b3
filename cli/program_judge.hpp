// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string_view>

#include "conformance/program_check.hpp"
#include "emulators/host/i2c_adapter.hpp"
#include "harness/core/error.hpp"

namespace armjig::cli {

/// A check of the programs that talk to a device, which says on standard error what they do wrong:
/// the first few times of each. Problems: `kBadValue` if nothing is demanded of them.
[[nodiscard]] Outcome<std::unique_ptr<ProgramCheck>> make_program_check(std::string_view device,
                                                                        const LinkNoise& noise);

/// The same for programs on an emulated bus.
class BusCheck {
 public:
  [[nodiscard]] static Outcome<std::unique_ptr<BusCheck>> make(std::string_view device);
  explicit BusCheck(std::unique_ptr<ProgramCheck> check) noexcept;

  /// For one bus. `this` must outlive it.
  [[nodiscard]] BusListener listener();

  /// What `ProgramCheck` says of the session. Nothing is heard any more.
  [[nodiscard]] Report finish();

 private:
  std::mutex guard_;  ///< transactions come from a thread of the bus
  std::unique_ptr<ProgramCheck> check_;
};

}  // namespace armjig::cli
