// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/target_options.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

namespace armjig::cli {

/// What a line that the console says is.
enum class Tone : std::uint8_t {
  kAnswer,
  kEvent,       ///< something happened by itself, or goes on
  kFailed,      ///< what was asked for was refused or had no effect
  kUnreadable,  ///< what was asked for cannot be understood
};

/// Gets text without the last line end, of one line or several.
using Say = std::function<void(Tone, std::string_view)>;

/// The commands of `armjig console` for one device. A command is begun, and goes on while `cycle`
/// is called once a period; whoever calls decides whether to wait for its end.
class DeviceConsole {
 public:
  DeviceConsole() = default;
  DeviceConsole(const DeviceConsole&) = delete;
  DeviceConsole& operator=(const DeviceConsole&) = delete;
  virtual ~DeviceConsole() = default;

  /// Talks to the device for a period. Problems: the target is gone or may not be written to any
  /// more.
  [[nodiscard]] virtual Outcome<void> cycle() = 0;

  /// Begins a command; what is blank or a comment does nothing.
  virtual void begin(std::string_view line) = 0;
  /// The command that was begun last has not ended.
  [[nodiscard]] virtual bool is_busy() const noexcept = 0;
  [[nodiscard]] virtual bool wants_to_quit() const noexcept = 0;

  /// Makes the arm stand.
  virtual void stop() = 0;

  /// What goes on, in a word or two for a prompt: `home 12 s`, `ESTOP`; empty if nothing does.
  [[nodiscard]] virtual std::string occupation() = 0;

  /// What may stand at the end of the line, for completion.
  [[nodiscard]] virtual std::vector<std::string> candidates(std::string_view line) const = 0;

  [[nodiscard]] virtual Instant now() = 0;

  /// The first sign of life comes within `hears_within` of the first cycle, and if it does not,
  /// `silence` says what to look for.
  [[nodiscard]] virtual bool hears_the_device() const noexcept = 0;
  [[nodiscard]] virtual Duration hears_within() const noexcept = 0;
  [[nodiscard]] virtual std::string_view silence() const noexcept = 0;
};

/// A device that there is a console for.
struct ConsoleEntry {
  std::string_view device;
  /// Opens the target, which is called `target` in messages.
  Outcome<std::unique_ptr<DeviceConsole>> (*open)(const RigOptions& how, const std::string& target,
                                                  Say say);
};

}  // namespace armjig::cli
