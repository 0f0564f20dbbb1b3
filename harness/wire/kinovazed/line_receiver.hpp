// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "harness/core/bytes.hpp"
#include "harness/wire/kinovazed/vocabulary.hpp"

namespace armjig::kinovazed {

/// How a server cuts what a client sends into lines. The shipped one reads at most 128 bytes at a
/// time and collects longer lines of such pieces, with three quirks; the documented one takes lines
/// of up to 1024 bytes. Memory is fixed; nothing allocates or throws.
class LineReceiver {
 public:
  enum class Found : std::uint8_t {
    kNothing,  ///< needs more bytes
    kLine,
    kTooLong,  ///< the connection has to be closed
  };

  explicit LineReceiver(Profile profile) noexcept;

  /// How many bytes the server would read now.
  [[nodiscard]] std::size_t room() const noexcept { return rules_.read_size - size_; }

  /// Requires at most `room()` bytes. What they are together with matters to the shipped server: an
  /// LF that comes first takes the byte behind it along (kinovazed.line.lf-first).
  void fill(Bytes bytes) noexcept;

  /// Takes the next line out of what was read.
  [[nodiscard]] Found step() noexcept;

  /// The line that was found, without its LF. Valid until the next `fill` or `step`.
  [[nodiscard]] std::string_view line() const noexcept { return line_; }

  /// The client has gone: forgets what was read, but the shipped server not what it had collected
  /// (kinovazed.line.carry-over).
  void end_of_stream() noexcept;

  // Regular: `line_` points into this.
  LineReceiver(const LineReceiver& other) noexcept;
  LineReceiver& operator=(const LineReceiver& other) noexcept;
  ~LineReceiver() = default;

 private:
  struct Rules {
    std::size_t read_size;      ///< of one read
    std::size_t collect_below;  ///< as long as fewer bytes were collected, another read is added
    bool lf_first_takes_next;   ///< kinovazed.line.lf-first
    bool keeps_collected;       ///< kinovazed.line.carry-over
  };
  static constexpr Rules kFirmwareRules{128, 1024, true, true};
  static constexpr Rules kDocumentedRules{1025, 0, false, false};

  void drop(std::size_t count) noexcept;

  Rules rules_;
  std::size_t begin_ = 0;  ///< of what was read, in `read_`
  std::size_t size_ = 0;
  std::size_t collected_size_ = 0;
  std::string_view line_;
  std::array<char, kDocumentedRules.read_size> read_{};
  std::array<char, kFirmwareRules.collect_below + 2 * kFirmwareRules.read_size> collected_{};
};

}  // namespace armjig::kinovazed
