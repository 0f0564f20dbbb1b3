// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "harness/core/device_input.hpp"

namespace armjig::cli {

/// Whether there is anything that could be read. Ask before anything is opened: who starts a
/// program without standard input leaves its number to the first file.
[[nodiscard]] bool has_standard_input() noexcept;

/// Lets people and scripts set the inputs of a hosted device by lines on standard input, `NAME
/// VALUE` or `help`, in a thread of its own; answers go to standard error. A terminal that belongs
/// to another job is left alone, and the end of input ends nothing else.
class DeviceInputs {
 public:
  /// Sets one input and tells, in any thread, whether there is one that takes the value.
  using Set = std::function<void(std::string name, std::int64_t value,
                                 std::function<void(bool is_taken)> tell)>;

  /// `set` is called until it is gone.
  DeviceInputs(std::span<const DeviceInput> inputs, Set set);

 private:
  void read(const std::stop_token& stop);
  void obey(std::string_view line);

  std::span<const DeviceInput> inputs_;
  Set set_;
  std::string text_;  ///< without an end of line yet
  std::jthread thread_;
};

}  // namespace armjig::cli
