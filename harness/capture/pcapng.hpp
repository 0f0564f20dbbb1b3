// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/files/user_file.hpp"

namespace armjig::pcapng {

/// What a file begins with, whatever the order of its bytes.
inline constexpr std::string_view kMagic = "\n\r\r\n";

/// Wireshark takes no longer packet of the link types that are used here.
inline constexpr std::size_t kMostPacketBytes = 262'144;

/// The link types that are written, and those that are read besides.
enum LinkType : std::uint16_t {
  kLinkI2c = 209,       ///< shown by a plain Wireshark; has no acknowledgements and no stop
  kLinkCan = 227,       ///< SocketCAN; shown by a plain Wireshark
  kLinkUpperPdu = 252,  ///< bytes after the name of their dissector
};

enum class Flow : std::uint8_t { kUnknown, kInbound, kOutbound };

struct Interface {
  std::uint16_t link_type{};
  std::string name;
  std::string comment;
  std::uint8_t resolution = 6;   ///< as the format has it: 10^-n s, with the high bit set 2^-n s
  std::int64_t offset_s = 0;     ///< added to all times
  bool is_little_endian = true;  ///< the machine that captured it
};

/// One packet. What it refers to is valid until the next one is read.
struct Packet {
  std::int64_t time_ns{};  ///< since 1970; 0 if the file does not say
  std::size_t interface{};
  Flow flow{};
  std::size_t original_size{};  ///< more than `data` if it was cut when it was captured
  Bytes data;
};

/// Packets from wherever they come, one by one.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  /// What the file is, for people.
  [[nodiscard]] virtual std::string_view format() const noexcept = 0;
  /// The next packet; false at the end. After a problem nothing more can be read.
  [[nodiscard]] virtual Outcome<bool> next(Packet& packet) = 0;
  /// All so far.
  [[nodiscard]] virtual const std::vector<Interface>& interfaces() const noexcept = 0;
  /// Complete when `next` has returned.
  [[nodiscard]] virtual const std::string& comment() const noexcept = 0;
  /// What a reader should know and is no problem, such as that a file ends too early; empty:
  /// nothing.
  [[nodiscard]] virtual const std::string& warning() const noexcept = 0;
};

/// A section, with `comment` in as many options as it needs.
void append_section(std::string& out, std::string_view application, std::string_view comment);

/// An interface with times in nanoseconds. They are numbered from 0 in each section.
void append_interface(std::string& out, const Interface& interface);

/// Requires `data.size() <= kMostPacketBytes` and a time that is not negative.
void append_packet(std::string& out, const Packet& packet);

/// Reads a file from its beginning to its end, in memory that does not grow with it. Sections of
/// either byte order, and blocks that nobody knows, are read over.
class Reader final : public Source {
 public:
  /// `name` is for messages.
  Reader(UserFile file, std::string name);

  [[nodiscard]] std::string_view format() const noexcept override { return "pcapng"; }
  /// Problems: `kMalformed`, with the offset of the block, and those of the file.
  [[nodiscard]] Outcome<bool> next(Packet& packet) override;

  /// Of all sections so far, one after the other.
  [[nodiscard]] const std::vector<Interface>& interfaces() const noexcept override {
    return interfaces_;
  }
  /// The comments of the first section.
  [[nodiscard]] const std::string& comment() const noexcept override { return comment_; }
  [[nodiscard]] const std::string& warning() const noexcept override { return warning_; }

 private:
  [[nodiscard]] Outcome<bool> fill(std::size_t size);
  [[nodiscard]] Outcome<bool> next_block();
  [[nodiscard]] Outcome<void> take_section();
  [[nodiscard]] Outcome<void> take_interface();
  [[nodiscard]] Outcome<void> take_packet(Packet& packet);
  [[nodiscard]] Outcome<void> take_times(Packet& packet, std::uint64_t ticks);
  [[nodiscard]] tl::unexpected<Problem> malformed(std::string_view what) const;
  [[nodiscard]] std::uint16_t u16(Bytes in) const noexcept;
  [[nodiscard]] std::uint32_t u32(Bytes in) const noexcept;
  template <class Take>
  [[nodiscard]] bool each_option(Bytes options, Take take) const;

  UserFile file_;
  std::string name_;
  std::vector<std::byte> buffer_;
  std::size_t begin_ = 0;  ///< of what has not been used
  std::size_t end_ = 0;
  std::uint64_t offset_ = 0;  ///< of the block in the file
  std::uint32_t type_{};
  Bytes body_;
  bool is_little_endian_ = true;
  bool has_section_ = false;
  bool is_first_section_ = true;
  bool has_ended_ = false;
  std::size_t first_interface_ = 0;  ///< of the section
  std::vector<Interface> interfaces_;
  std::string comment_;
  std::string warning_;
};

}  // namespace armjig::pcapng
