// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "harness/console/arguments.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// What a line that the console says is.
enum class Tone : std::uint8_t {
  kAnswer,
  kEvent,       ///< something happened by itself, or goes on
  kFailed,      ///< what was asked for was refused or had no effect
  kUnreadable,  ///< what was asked for cannot be understood
};

/// Gets text without the last line end, of one line or several.
using Say = std::function<void(Tone, std::string_view)>;

/// The commands by which a person drives a device: a table of those that all devices have and of
/// its own. A command is begun, and goes on while `cycle` is called once a period; whoever calls
/// decides whether to wait for its end. No I/O but the port's, whose time is the console's. For one
/// thread.
class DeviceConsole {
 public:
  using Words = std::span<const std::string_view>;
  /// Whether the words of a command could be read; if not, why, or an empty sentence.
  using Read = Parsed<void>;

  /// When a command may be given.
  enum class When : std::uint8_t {
    kAlways,
    kAlone,  ///< not while another one goes on
  };

  struct Row {
    std::string_view name;
    /// What follows the name: words, `[WORD]` for one that may be left out, `...` for any more.
    /// How many there are is checked, but with alternatives (` | `) the command does so itself.
    std::string_view arguments;
    std::string_view help;
    When when{};
    Read (*run)(DeviceConsole& console, Words words){};
    std::string_view completions;  ///< words for one place, `|`, words for the next
  };

  DeviceConsole(const DeviceConsole&) = delete;
  DeviceConsole& operator=(const DeviceConsole&) = delete;
  virtual ~DeviceConsole() = default;

  /// Waits for the first sign of life. False: none came in time, and `silence` says what to look
  /// for.
  [[nodiscard]] Outcome<bool> find_device();
  [[nodiscard]] std::string_view silence() const noexcept { return silence_.words; }

  /// Talks to the device for a period, 10 ms. Problems: the target is gone or may not be written
  /// to any more.
  [[nodiscard]] Outcome<void> cycle();

  /// Begins a command; what is blank or a comment does nothing.
  void begin(std::string_view line);
  /// The command that was begun last has not ended.
  [[nodiscard]] bool is_busy() const noexcept { return !going_on_.empty(); }
  [[nodiscard]] bool wants_to_quit() const noexcept { return wants_to_quit_; }

  /// Makes the device stand, as the command `stop` does.
  void stop();
  /// Makes it stand and waits for that, at most for two seconds.
  [[nodiscard]] Outcome<void> leave();

  /// What goes on, in a word or two for a prompt: `home 12 s`, `ESTOP`; empty if nothing does.
  [[nodiscard]] virtual std::string occupation() { return going_on(); }

  /// What may stand at the end of the line, for completion.
  [[nodiscard]] std::vector<std::string> candidates(std::string_view line) const;

  [[nodiscard]] virtual Instant now() = 0;

 protected:
  /// How long the first sign of life may take, and what to say if there is none.
  struct Silence {
    Duration patience;
    std::string_view words;
  };

  /// `target` is for messages.
  DeviceConsole(std::span<const Row> own, std::string target, Say say, Silence silence = {});

  static constexpr auto kAlways = When::kAlways;
  static constexpr auto kAlone = When::kAlone;
  /// `Row::run` of a method, which takes the words or nothing, and answers `Read` or nothing.
  template <auto method>
  static Read run(DeviceConsole& console, [[maybe_unused]] Words words) {
    return call(method, console, words);
  }

  void say(Tone tone, std::string_view text) { say_(tone, text); }

  /// A command of that name goes on from now on, until `end` or until another one takes its place.
  void go_on(std::string_view name);
  void end() noexcept;
  [[nodiscard]] Instant began() const noexcept { return began_; }
  [[nodiscard]] std::string_view name() const noexcept { return going_on_; }
  /// `home 12 s`; empty if nothing does.
  [[nodiscard]] std::string going_on();

  [[nodiscard]] auto gone(ErrorCode code, std::string hint) const {
    return problem(code, target_, std::move(hint));
  }

 private:
  /// A period of the device.
  [[nodiscard]] virtual Outcome<void> exchange() = 0;
  [[nodiscard]] virtual bool hears_the_device() const { return true; }
  /// For the command `status`; if there is nothing to say, why.
  [[nodiscard]] virtual Parsed<std::string> state() = 0;
  /// Nothing goes on any more.
  virtual void stand() = 0;
  /// For the command `wait`.
  virtual void wait_for(Duration time);

  template <class Self, class Answer, class... Taken>
  static Read call(Answer (Self::*method)(Taken...), DeviceConsole& console,
                   [[maybe_unused]] Words words) {
    const auto answer = [&] {
      auto& self = static_cast<Self&>(console);
      if constexpr (sizeof...(Taken) == 0) return (self.*method)();
      if constexpr (sizeof...(Taken) == 1) return (self.*method)(words);
    };
    if constexpr (!std::is_void_v<Answer>) return answer();
    answer();
    return {};
  }

  Read help(Words words);
  void status();
  Read wait(Words words);
  void quit() { wants_to_quit_ = true; }
  [[nodiscard]] const Row* find(std::string_view name) const noexcept;
  void end_early();

  std::vector<Row> rows_;
  std::string target_;
  Say say_;
  Silence silence_;
  std::string going_on_;  ///< empty if nothing does
  Instant began_{};
  std::optional<Instant> waits_until_;
  bool wants_to_quit_ = false;
};

}  // namespace armjig
