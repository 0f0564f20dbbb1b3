// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/pcapng.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace armjig::pcapng {
namespace {

enum BlockType : std::uint32_t {
  kInterfaceBlock = 1,
  kObsoletePacket = 2,
  kSimplePacket = 3,
  kEnhancedPacket = 6,
  kSectionBlock = 0x0A0D0D0A,
};
enum Option : std::uint16_t {
  kEndOfOptions = 0,
  kComment = 1,
  kFlags = 2,  // of a packet
  kName = 2,   // of an interface
  kApplication = 4,
  kResolution = 9,
  kOffset = 14,
};

constexpr std::uint32_t kByteOrderMagic = 0x1A2B3C4D;
constexpr std::uint8_t kNanoseconds = 9;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::size_t kFrameOfBlock = 12;  // type, length, and length again
constexpr std::size_t kMostOptionBytes = 65'532;
/// More than any program writes; what claims more is no block.
constexpr std::size_t kMostBlockBytes = std::size_t{16} << 20U;
constexpr std::size_t kPieceBytes = std::size_t{256} << 10U;

constexpr std::size_t padding(std::size_t size) noexcept { return (4 - size % 4) % 4; }

void put_u16(std::string& out, std::size_t value) {
  out += static_cast<char>(value);
  out += static_cast<char>(value >> 8U);
}

void put_u32(std::string& out, std::size_t value) {
  put_u16(out, value);
  put_u16(out, value >> 16U);
}

void put_padded(std::string& out, std::string_view bytes) {
  out += bytes;
  out.append(padding(bytes.size()), '\0');
}

void put_option(std::string& out, Option option, std::string_view value) {
  put_u16(out, option);
  put_u16(out, value.size());
  put_padded(out, value);
}

/// A block that grows at the end of a text; its lengths are written when it is complete.
class Block {
 public:
  Block(std::string& out, BlockType type) : out_{out}, begin_{out.size()} {
    put_u32(out, type);
    put_u32(out, 0);
  }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  ~Block() {
    const auto size = out_.size() - begin_ + 4;
    std::string length;
    put_u32(length, size);
    out_ += length;
    out_.replace(begin_ + 4, 4, length);
  }

 private:
  std::string& out_;
  std::size_t begin_;
};

/// Where to cut so that no letter of several bytes is cut.
std::size_t whole_letters(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text.size();
  auto size = most;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return size > 0 ? size : most;
}

constexpr std::array<std::int64_t, 19> powers_of_ten() {
  std::array<std::int64_t, 19> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = powers[i - 1] * 10;
  return powers;
}
constexpr auto kPowersOfTen = powers_of_ten();

/// Ticks in units of 2^-exponent s.
struct Split {
  std::uint64_t seconds;
  std::uint64_t ns;
};

Split split_ticks(std::uint64_t ticks, std::uint8_t resolution) {
  const unsigned exponent = resolution & 0x7FU;
  constexpr std::uint64_t kNs = kNsPerSecond;
  if ((resolution & 0x80U) != 0) {
    if (exponent > 63) return {0, 0};
    const auto rest = ticks & ((std::uint64_t{1} << exponent) - 1);
    constexpr unsigned kMostBits = 30;  // so many times a billion are less than 64
    const auto less = exponent > kMostBits ? exponent - kMostBits : 0;
    return {ticks >> exponent, ((rest >> less) * kNs) >> (exponent - less)};
  }
  if (exponent >= kPowersOfTen.size()) return {0, 0};
  const auto unit = static_cast<std::uint64_t>(kPowersOfTen.at(exponent));
  const auto rest = ticks % unit;
  const auto ns = exponent <= kNanoseconds ? rest * (kNs / unit) : rest / (unit / kNs);
  return {ticks / unit, ns};
}

}  // namespace

void append_section(std::string& out, std::string_view application, std::string_view comment) {
  const Block block{out, kSectionBlock};
  put_u32(out, kByteOrderMagic);
  put_u16(out, 1);
  put_u16(out, 0);
  put_u32(out, 0xFFFFFFFF);  // the length of the section is not known
  put_u32(out, 0xFFFFFFFF);
  while (!comment.empty()) {
    const auto size = whole_letters(comment, kMostOptionBytes);
    put_option(out, kComment, comment.substr(0, size));
    comment.remove_prefix(size);
  }
  put_option(out, kApplication, application);
  put_u32(out, kEndOfOptions);
}

void append_interface(std::string& out, const Interface& interface) {
  const Block block{out, kInterfaceBlock};
  put_u16(out, interface.link_type);
  put_u16(out, 0);
  put_u32(out, 0);  // packets of any length
  put_option(out, kComment, interface.comment);
  put_option(out, kName, interface.name);
  put_option(out, kResolution, std::string_view{"\x09", 1});
  put_u32(out, kEndOfOptions);
}

void append_packet(std::string& out, const Packet& packet) {
  assert(packet.data.size() <= kMostPacketBytes && packet.time_ns >= 0);
  const Block block{out, kEnhancedPacket};
  const auto time = static_cast<std::uint64_t>(packet.time_ns);
  put_u32(out, packet.interface);
  put_u32(out, time >> 32U);
  put_u32(out, time & 0xFFFFFFFF);
  put_u32(out, packet.data.size());
  put_u32(out, packet.data.size());
  put_padded(out, as_text(packet.data));
  if (packet.flow == Flow::kUnknown) return;
  put_u16(out, kFlags);
  put_u16(out, 4);
  put_u32(out, static_cast<std::uint32_t>(packet.flow));
  put_u32(out, kEndOfOptions);
}

Reader::Reader(UserFile file, std::string name)
    : file_{std::move(file)}, name_{std::move(name)}, buffer_(2 * kPieceBytes) {}

std::uint16_t Reader::u16(Bytes in) const noexcept {
  const auto bytes = in.first<2>();
  return is_little_endian_ ? load_u16_le(bytes) : load_u16_be(bytes);
}

std::uint32_t Reader::u32(Bytes in) const noexcept {
  const std::uint32_t first = u16(in);
  const std::uint32_t second = u16(in.subspan(2));
  return is_little_endian_ ? second << 16U | first : first << 16U | second;
}

tl::unexpected<Problem> Reader::malformed(std::string_view what) const {
  return problem(ErrorCode::kMalformed, name_,
                 fmt::format("the block at byte {}: {}", offset_, what));
}

/// Whether so many bytes are there.
Outcome<bool> Reader::fill(std::size_t size) {
  while (end_ - begin_ < size && !has_ended_) {
    if (begin_ > 0) {
      std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
                buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
      end_ -= std::exchange(begin_, 0);
    }
    // By pieces: a length that lies does not make us take memory for nothing.
    if (buffer_.size() < end_ + kPieceBytes) buffer_.resize(end_ + kPieceBytes);
    const auto read = file_.read(std::span{buffer_}.subspan(end_, kPieceBytes));
    if (!read) return tl::unexpected{read.error()};
    has_ended_ = *read < kPieceBytes;
    end_ += *read;
  }
  return end_ - begin_ >= size;
}

/// The next block, with its body; false at the end of the file.
Outcome<bool> Reader::next_block() {
  offset_ += body_.empty() && !has_section_ ? 0 : body_.size() + kFrameOfBlock;
  const auto ends_early = [this]() -> Outcome<bool> {
    if (!has_section_) return malformed("the file ends within its first block");
    warning_ = fmt::format("{}: the file ends within a block, at byte {}; all before it was read",
                           name_, offset_);
    return false;
  };
  auto has_header = fill(kFrameOfBlock);
  if (!has_header) return has_header;
  if (!*has_header) {
    if (end_ == begin_ && has_section_) return false;
    return ends_early();
  }
  Bytes there{buffer_.data() + begin_, end_ - begin_};
  constexpr std::uint32_t kSection = kSectionBlock;
  type_ = u32(there);
  if (type_ == kSection) {  // the same in both orders, and says which one follows
    is_little_endian_ = true;
    is_little_endian_ = u32(there.subspan(8)) == kByteOrderMagic;
    if (u32(there.subspan(8)) != kByteOrderMagic) return malformed("it has no byte order");
  } else if (!has_section_) {
    return malformed("it is no beginning of a pcapng file");
  }
  const std::size_t size = u32(there.subspan(4));
  if (size < kFrameOfBlock || size % 4 != 0 || size > kMostBlockBytes) {
    return malformed(fmt::format("its length cannot be {}", size));
  }
  auto is_whole = fill(size);
  if (!is_whole) return is_whole;
  if (!*is_whole) return ends_early();
  there = {buffer_.data() + begin_, size};
  if (u32(there.subspan(size - 4)) != size) return malformed("its two lengths differ");
  body_ = there.subspan(8, size - kFrameOfBlock);
  begin_ += size;
  return true;
}

template <class Take>
bool Reader::each_option(Bytes options, Take take) const {
  while (options.size() >= 4) {
    const auto option = u16(options);
    const std::size_t size = u16(options.subspan(2));
    if (option == kEndOfOptions) return true;
    if (options.size() - 4 < size) return false;
    take(option, options.subspan(4, size));
    options = options.subspan(std::min(options.size(), 4 + size + padding(size)));
  }
  return options.empty();
}

Outcome<void> Reader::take_section() {
  constexpr std::size_t kFixed = 16;
  if (body_.size() < kFixed) return malformed("it is too short for a section");
  if (u16(body_.subspan(4)) != 1) return malformed("the version of the format is not 1");
  const auto is_sound = each_option(body_.subspan(kFixed), [this](auto option, Bytes value) {
    if (option == kComment && is_first_section_) comment_ += as_text(value);
  });
  if (!is_sound) return malformed("an option is longer than the block");
  is_first_section_ = false;
  has_section_ = true;
  first_interface_ = interfaces_.size();
  return {};
}

Outcome<void> Reader::take_interface() {
  constexpr std::size_t kFixed = 8;
  constexpr std::size_t kMostInterfaces = 65'536;
  if (body_.size() < kFixed) return malformed("it is too short for an interface");
  if (interfaces_.size() >= kMostInterfaces) return malformed("there are too many interfaces");
  Interface interface;
  interface.link_type = u16(body_);
  interface.is_little_endian = is_little_endian_;
  const auto is_sound = each_option(body_.subspan(kFixed), [&](auto option, Bytes value) {
    if (option == kComment) interface.comment += as_text(value);
    if (option == kName) interface.name = as_text(value);
    if (option == kResolution && !value.empty()) {
      interface.resolution = std::to_integer<std::uint8_t>(value.front());
    }
    if (option == kOffset && value.size() >= 8) {
      const std::uint64_t low = u32(value.subspan(is_little_endian_ ? 0 : 4));
      const std::uint64_t high = u32(value.subspan(is_little_endian_ ? 4 : 0));
      interface.offset_s = static_cast<std::int64_t>(high << 32U | low);
    }
  });
  if (!is_sound) return malformed("an option is longer than the block");
  interfaces_.push_back(std::move(interface));
  return {};
}

Outcome<void> Reader::take_times(Packet& packet, std::uint64_t ticks) {
  const auto& interface = interfaces_[packet.interface];
  if (interface.resolution == kNanoseconds && interface.offset_s == 0 && ticks >> 63U == 0) {
    packet.time_ns = static_cast<std::int64_t>(ticks);  // nearly always, and without divisions
    return {};
  }
  const auto [seconds, ns] = split_ticks(ticks, interface.resolution);
  std::int64_t sum = 0;
  const bool is_too_far =
      __builtin_add_overflow(seconds, interface.offset_s, &sum) ||
      __builtin_mul_overflow(sum, kNsPerSecond, &sum) ||
      __builtin_add_overflow(sum, static_cast<std::int64_t>(ns), &packet.time_ns);
  if (is_too_far) return malformed("its time is out of range");
  return {};
}

Outcome<void> Reader::take_packet(Packet& packet) {
  packet = {};
  const bool is_simple = type_ == kSimplePacket;
  const std::size_t fixed = is_simple ? 4 : 20;
  if (body_.size() < fixed) return malformed("it is too short for a packet");
  std::size_t interface = 0;
  if (type_ == kEnhancedPacket) interface = u32(body_);
  if (type_ == kObsoletePacket) interface = u16(body_);
  if (interface >= interfaces_.size() - first_interface_) {
    return malformed(fmt::format("there is no interface {}", interface));
  }
  packet.interface = first_interface_ + interface;
  packet.original_size = u32(body_.subspan(fixed - 4));
  const auto after = body_.subspan(fixed);
  const std::size_t size = is_simple ? std::min(packet.original_size, after.size())
                                     : std::size_t{u32(body_.subspan(12))};
  if (size > after.size()) return malformed("the packet is longer than the block");
  packet.data = after.first(size);
  if (is_simple) return {};
  const auto options = after.subspan(std::min(after.size(), size + padding(size)));
  const bool is_sound = each_option(options, [&](auto option, Bytes value) {
    if (option == kFlags && value.size() == 4) packet.flow = static_cast<Flow>(u32(value) & 3U);
  });
  if (!is_sound) return malformed("an option is longer than the block");
  if (packet.flow > Flow::kOutbound) packet.flow = Flow::kUnknown;
  return take_times(packet, std::uint64_t{u32(body_.subspan(4))} << 32U | u32(body_.subspan(8)));
}

Outcome<bool> Reader::next(Packet& packet) {
  while (true) {
    auto block = next_block();
    if (!block || !*block) return block;
    Outcome<void> taken;
    const bool is_packet =
        type_ == kEnhancedPacket || type_ == kSimplePacket || type_ == kObsoletePacket;
    if (type_ == kSectionBlock) taken = take_section();
    if (type_ == kInterfaceBlock) taken = take_interface();
    if (is_packet) taken = take_packet(packet);
    if (!taken) return tl::unexpected{std::move(taken.error())};
    if (is_packet) return true;
  }
}

}  // namespace armjig::pcapng
