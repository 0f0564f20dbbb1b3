// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "emulators/campaign/script.hpp"
#include "harness/mealy/documented.hpp"

namespace armjig::campaign {

/// Writes down what is done to a device, one thing after the other.
class Acts {
 public:
  explicit Acts(Duration quiet) : quiet_{quiet} {}

  // At this moment.
  void send(Bytes bytes);                         ///< on a stream
  void send_line(std::string_view line);          ///< to a server, with CR LF, on one connection
  void write(std::uint8_t address, Bytes bytes);  ///< on a bus
  void read(std::uint8_t address, std::uint16_t count);  ///< on a bus
  void set(std::string_view input, std::int64_t value);  ///< an input of the device, by hand

  void wait(Duration time) { now_ += time; }
  /// As long as a device may take to end what it does by itself.
  void wait_until_quiet() { now_ += quiet_; }

  /// Since the beginning.
  [[nodiscard]] Instant now() const noexcept { return now_; }
  [[nodiscard]] const Script& script() const noexcept { return script_; }

 private:
  Script script_;
  Instant now_{};
  Duration quiet_;
};

/// What is done to a device as one input of its machine. It takes as much time as it waits, and
/// what the device says meanwhile is the output.
struct AbstractLetter {
  std::string_view name;
  void (*act)(Acts& acts);
};

/// A machine that a device shows: letters, what its answers mean, and what the document says of it.
struct Learnable {
  std::string_view name;
  std::span<const AbstractLetter> letters;
  /// What is said, in a few words, of the messages that came from the device; empty: nothing of
  /// interest. The same for values that do not matter.
  std::string (*said)(std::span<const Message> messages){};
  /// Whether it is the reply of which each message sent gets one, in their order: one that comes in
  /// the time of the next letter still belongs to its own. nullptr: there is no such thing.
  bool (*is_reply)(const Message& message){};
  Duration quiet{};                            ///< as for `Acts::wait_until_quiet`
  std::span<const mealy::Table> documented{};  ///< empty: no document tells
  std::string_view source{};                   ///< where it is documented
  /// Done to a new device before the first letter; nullptr: nothing.
  void (*begin)(Acts& acts){};
  /// Leads a device that nobody can start again to where it begins; nullptr: nothing does.
  void (*reset)(Acts& acts){};
};

/// The value of a field by its name; none: the message has no such field.
[[nodiscard]] std::optional<std::int64_t> value_in(const Message& message, std::string_view field);

}  // namespace armjig::campaign
