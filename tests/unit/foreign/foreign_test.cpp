// SPDX-License-Identifier: Apache-2.0
// Files of other programs. Their bytes are written here by hand, as tcpdump.org describes the link
// types and RFC 9293 the segments.
#include "harness/foreign/foreign.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace armjig {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

/// A message is a line; one that begins with `x` is none.
class Lines final : public Dissector {
 public:
  void feed(Direction direction, Instant time, Bytes bytes, std::vector<Message>& out) override {
    for (const auto byte : bytes) {
      line_.push_back(byte);
      if (byte != std::byte{'\n'}) continue;
      const bool is_message = line_.front() != std::byte{'x'};
      out.push_back({direction, time, "line", line_, {}, is_message ? "" : "it begins with x"});
      line_.clear();
    }
  }
  void finish(std::vector<Message>& /*out*/) override {}

 private:
  std::vector<std::byte> line_;
};

std::unique_ptr<Dissector> make_lines() { return std::make_unique<Lines>(); }

const ForeignHow kHow{.devices = {{"arm", LinkKind::kSession, make_lines, false},
                                  {"board", LinkKind::kStream, make_lines, true},
                                  {"bus", LinkKind::kBus, make_lines, false}},
                      .ports = {{51717, 0}, {4000, 1}},
                      .usb = {}};

std::string big(std::uint64_t value, int size) {
  std::string out;
  for (; size > 0; --size, value >>= 8) out.insert(out.begin(), static_cast<char>(value & 0xFF));
  return out;
}

std::string little(std::uint64_t value, int size) {
  const auto out = big(value, size);
  return {out.rbegin(), out.rend()};
}

using Write = std::string (*)(std::uint64_t value, int size);
constexpr std::uint32_t kMicroseconds = 0xA1B2C3D4;
constexpr std::uint32_t kNanoseconds = 0xA1B23C4D;

/// A classic file of that link type; packets a millisecond apart.
std::string pcap(std::uint32_t link, const std::vector<std::string>& packets, Write write = little,
                 std::uint32_t magic = kMicroseconds) {
  auto out =
      write(magic, 4) + write(2, 2) + write(4, 2) + write(0, 8) + write(65'535, 4) + write(link, 4);
  std::uint64_t time = 0;
  for (const auto& packet : packets) {
    out += write(1000, 4) + write(time++ * (magic == kNanoseconds ? 1'000'000 : 1000), 4) +
           write(packet.size(), 4) + write(packet.size(), 4) + packet;
  }
  return out;
}

enum Flag : std::uint8_t { kFin = 1, kSyn = 2, kReset = 4, kAck = 16 };

/// From the client's port 1025 to the server, or back.
struct Segment {
  Direction direction;
  std::uint32_t sequence;
  std::uint32_t acknowledged;
  int flags;
  std::string payload;
  std::uint16_t port = 51717;
};

std::string tcp(const Segment& one) {
  const bool is_to = one.direction == Direction::kToDevice;
  return big(is_to ? 1025U : one.port, 2) + big(is_to ? one.port : 1025U, 2) +
         big(one.sequence, 4) + big(one.acknowledged, 4) + "\x50"s + static_cast<char>(one.flags) +
         big(0x2000, 2) + big(0, 4) + one.payload;
}

std::string ipv4(const Segment& one) {
  const auto inner = tcp(one);
  const bool is_to = one.direction == Direction::kToDevice;
  return "\x45\x00"s + big(20 + inner.size(), 2) + big(0, 4) + "\x40\x06"s + big(0, 2) +
         big(is_to ? 0x0A000001 : 0x0A000002, 4) + big(is_to ? 0x0A000002 : 0x0A000001, 4) + inner;
}

std::string ipv6(const Segment& one) {
  const auto inner = tcp(one);
  const bool is_to = one.direction == Direction::kToDevice;
  return "\x60\x00\x00\x00"s + big(inner.size(), 2) + "\x06\x40"s + big(0, 15) +
         big(is_to ? 1 : 2, 1) + big(0, 15) + big(is_to ? 2 : 1, 1) + inner;
}

struct Read {
  std::vector<std::string> records;  ///< `>` or `<`, connection, what was lost, bytes
  std::vector<std::string> links;
  std::string format;
  std::string device;
  std::string warning;
  std::string problem;
  std::vector<Instant> times;
};

Read read(const std::string& content, const ForeignHow& how = kHow) {
  const auto path = fs::temp_directory_path() / ("armjig-foreign-" + std::to_string(::getpid()));
  std::ofstream{path, std::ios::binary} << content;
  auto reader = open_foreign(UserFile::open(path).value(), "input", how);
  fs::remove(path);
  Read read;
  if (!reader) {
    read.problem = reader.error().hint;
    return read;
  }
  read.format = (*reader)->format();
  read.device = (*reader)->header().device;
  CaptureRecord record;
  Outcome<bool> has_record = true;
  while ((has_record = (*reader)->next(record)) && *has_record) {
    if (record.link->kind == LinkKind::kEvents) continue;
    std::string text{record.direction == Direction::kToDevice ? '>' : '<'};
    text += std::to_string(record.id) + ' ';
    if (const auto lost = lost_before(record)) text += "lost " + std::to_string(lost) + ' ';
    text.append(reinterpret_cast<const char*>(record.bytes.data()), record.bytes.size());
    read.records.push_back(text);
    read.links.push_back(record.link->name);
    read.times.push_back(record.time);
  }
  if (!has_record) read.problem = has_record.error().hint;
  read.warning = (*reader)->warning();
  return read;
}

using Texts = std::vector<std::string>;
constexpr auto kTo = Direction::kToDevice;
constexpr auto kFrom = Direction::kFromDevice;

/// A connection with both greetings done; the first byte of each side has number 101 and 201.
std::vector<Segment> greeting() {
  return {{kTo, 100, 0, kSyn, ""}, {kFrom, 200, 101, kSyn | kAck, ""}, {kTo, 101, 201, kAck, ""}};
}

Read read_segments(const std::vector<Segment>& more) {
  std::vector<std::string> packets;
  for (const auto& one : greeting()) packets.push_back(ipv4(one));
  for (const auto& one : more) packets.push_back(ipv4(one));
  return read(pcap(101, packets));
}

TEST(Foreign, FindsAConnectionInEachLinkLayer) {
  const Segment said{kTo, 100, 0, kAck, "a\n"};
  const auto four = ipv4(said);
  const auto six = ipv6(said);
  const auto macs = std::string(12, '\x02');
  const std::vector<std::pair<std::uint32_t, std::string>> files{
      {1, macs + "\x08\x00"s + four + std::string(4, '\0')},  // padded to the least length
      {1, macs + "\x86\xDD"s + six},
      {1, macs + "\x81\x00\x00\x05\x08\x00"s + four},  // in VLAN 5
      {113, std::string(14, '\0') + "\x08\x00"s + four},
      {276, "\x86\xDD"s + std::string(18, '\0') + six},
      {0, "\x02\x00\x00\x00"s + four},
      {0, "\x00\x00\x00\x1E"s + six},
      {108, "\x00\x00\x00\x02"s + four},
      {101, four},
      {101, six},
      {228, four},
      {229, six},
  };
  for (const auto& [link, packet] : files) {
    const auto found = read(pcap(link, {packet}));
    EXPECT_EQ(found.records, Texts{">0 a\n"}) << link << ' ' << found.problem << found.warning;
    EXPECT_EQ(found.device, "arm") << link;
  }
}

TEST(Foreign, ReadsEachFormOfAClassicFile) {
  const std::vector packets{ipv4({kTo, 1, 0, kAck, "ab"}), ipv4({kTo, 3, 0, kAck, "cd"})};
  for (const auto write : {little, big}) {
    for (const auto magic : {kMicroseconds, kNanoseconds}) {
      const auto found = read(pcap(101, packets, write, magic));
      EXPECT_EQ(found.records, (Texts{">0 ab", ">0 cd"})) << magic;
      EXPECT_EQ(found.format, "pcap");
      ASSERT_EQ(found.times.size(), 2U);
      EXPECT_EQ(found.times[1] - found.times[0], std::chrono::milliseconds{1}) << magic;
    }
  }
}

TEST(Foreign, ReadsPcapngOfEitherOrder) {
  const auto packet = ipv4({kTo, 1, 0, kAck, "ab"});
  for (const auto write : {little, big}) {
    const auto block = [write](std::uint32_t type, std::string body) {
      body.resize((body.size() + 3) / 4 * 4);
      return write(type, 4) + write(body.size() + 12, 4) + body + write(body.size() + 12, 4);
    };
    const auto found =
        read(block(0x0A0D0D0A, write(0x1A2B3C4D, 4) + write(1, 2) + write(0, 2) + big(~0ULL, 8)) +
             block(1, write(101, 2) + write(0, 2) + write(0, 4)) +
             block(6, write(0, 4) + write(0, 4) + write(1000, 4) + write(packet.size(), 4) +
                          write(packet.size(), 4) + packet));
    EXPECT_EQ(found.records, Texts{">0 ab"}) << found.problem;
    EXPECT_EQ(found.format, "pcapng");
  }
}

TEST(Foreign, TakesBytesOnceAndInOrder) {
  const auto found = read_segments({{kTo, 104, 201, kAck, "def"},
                                    {kTo, 101, 201, kAck, "abc"},
                                    {kTo, 101, 201, kAck, "abc"},   // again
                                    {kTo, 105, 201, kAck, "efgh"},  // half of it again
                                    {kTo, 108, 201, kAck, "?"},     // keeps the connection alive
                                    {kFrom, 201, 109, kAck, "ok"}});
  EXPECT_EQ(found.records, (Texts{">0 abcdef", ">0 gh", "<0 ok"}));
  EXPECT_EQ(found.warning, "");
}

TEST(Foreign, NumbersMayWrapAround) {
  const auto found =
      read(pcap(101, {ipv4({kTo, 0xFFFF'FFFE, 0, kSyn, ""}), ipv4({kTo, 1, 0, kAck, "cd"}),
                      ipv4({kTo, 0xFFFF'FFFF, 0, kAck, "ab"})}));
  EXPECT_EQ(found.records, Texts{">0 abcd"});
}

TEST(Foreign, SaysHowMuchIsLostInsteadOfGluing) {
  std::vector<Segment> more{{kTo, 101, 201, kAck, "abc"}, {kTo, 110, 201, kAck, "jkl"}};
  for (std::uint32_t i = 0; i < 10; ++i) more.push_back({kFrom, 201 + i, 113, kAck, "."});
  const auto found = read_segments(more);
  ASSERT_GE(found.records.size(), 3U);
  EXPECT_EQ(found.records[0], ">0 abc");
  EXPECT_NE(std::ranges::find(found.records, ">0 lost 6 jkl"), found.records.end());
  EXPECT_NE(found.warning.find("6 bytes of TCP were not captured"), std::string::npos);
}

TEST(Foreign, TellsEachOfSeveralGaps) {
  const auto found = read_segments(
      {{kTo, 101, 201, kAck, "a"}, {kTo, 103, 201, kAck, "c"}, {kTo, 106, 201, kAck, "f"}});
  EXPECT_EQ(found.records, (Texts{">0 a", ">0 lost 1 c", ">0 lost 2 f"}));
}

TEST(Foreign, AConnectionMayBeginInItsMiddleAndBeginAgain) {
  const auto found =
      read(pcap(101, {ipv4({kFrom, 5000, 1, kAck, "late\n"}), ipv4({kTo, 1, 5005, kFin | kAck, ""}),
                      ipv4({kTo, 700, 0, kSyn, ""}), ipv4({kTo, 701, 0, kAck, "new\n"})}));
  EXPECT_EQ(found.records, (Texts{"<0 late\n", ">1 new\n"}));
}

TEST(Foreign, OtherPortsArePassedOver) {
  const auto found = read(
      pcap(101, {ipv4({kTo, 1, 0, kAck, "web", 80}), ipv4({kTo, 1, 0, kAck, "serial", 4000})}));
  EXPECT_EQ(found.records, Texts{">0 serial"});
  EXPECT_EQ(found.device, "board");
  EXPECT_NE(found.warning.find("--tcp-port"), std::string::npos);
}

/// An event of usbmon, 48 bytes and what was captured.
std::string usb(char type, int transfer, int endpoint, int device, std::uint64_t id,
                std::uint32_t length, const std::string& data, Write write = little) {
  return write(id, 8) + type + write(static_cast<std::uint64_t>(transfer), 1) +
         write(static_cast<std::uint64_t>(endpoint), 1) +
         write(static_cast<std::uint64_t>(device), 1) + write(2, 2) + std::string(2, '\0') +
         write(1000, 8) + write(0, 4) + write(0, 4) + write(length, 4) + write(data.size(), 4) +
         std::string(8, '\0') + data;
}

/// The same from a kernel whose buffer is mapped: 64 bytes and what was captured.
std::string mapped_usb(char type, int endpoint, std::uint64_t id, std::uint32_t length,
                       const std::string& data, Write write = little) {
  auto event = usb(type, 3, endpoint, 5, id, length, data, write);
  event.insert(48, 16, '\0');
  return event;
}

TEST(Foreign, TakesCompletedBulkTransfersBothWays) {
  constexpr int kBulk = 3;
  constexpr int kControl = 2;
  const auto found = read(pcap(
      189, {usb('C', kControl, 0x80, 5, 1, 4, "ctrl"), usb('S', kBulk, 0x02, 5, 2, 4, "in1\n"),
            usb('C', kBulk, 0x02, 5, 2, 4, ""), usb('S', kBulk, 0x82, 5, 3, 64, ""),
            usb('C', kBulk, 0x82, 5, 3, 4, "out\n"), usb('C', kBulk, 0x82, 5, 4, 0, ""),  // empty
            usb('S', kBulk, 0x02, 5, 6, 6, "never\n"),  // never completed
            usb('S', kBulk, 0x02, 5, 7, 5, "fail\n"), usb('E', kBulk, 0x02, 5, 7, 0, ""),
            usb('S', kBulk, 0x02, 5, 8, 5, "half\n"), usb('C', kBulk, 0x02, 5, 8, 2, ""),
            usb('C', kBulk, 0x82, 9, 5, 4, "x..\n")}));  // another device
  EXPECT_EQ(found.records, (Texts{">0 in1\n", "<0 out\n", ">0 ha"}));
  EXPECT_EQ(found.device, "board");
  EXPECT_NE(found.warning.find("4 bytes of bulk transfers"), std::string::npos);
  // At its completion, the third packet.
  ASSERT_FALSE(found.times.empty());
  EXPECT_EQ(found.times[0], at(std::chrono::milliseconds{2}));
}

TEST(Foreign, TakesTransfersFromAMappedBuffer) {
  const auto found =
      read(pcap(220, {mapped_usb('S', 0x02, 1, 4, "in1\n"), mapped_usb('C', 0x02, 1, 4, ""),
                      mapped_usb('C', 0x82, 2, 4, "out\n"),
                      mapped_usb('C', 0x82, 3, 4, "x..\n").substr(0, 60)}));
  EXPECT_EQ(found.records, (Texts{">0 in1\n", "<0 out\n"}));
  EXPECT_NE(found.warning.find("1 packets are too short"), std::string::npos) << found.warning;
}

TEST(Foreign, ReadsTransfersThatAMachineOfTheOtherOrderCaptured) {
  for (const std::uint32_t link : {189U, 220U}) {
    const auto event = [link](char type, int endpoint, std::uint64_t id, const std::string& data) {
      return link == 189 ? usb(type, 3, endpoint, 5, id, 4, data, big)
                         : mapped_usb(type, endpoint, id, 4, data, big);
    };
    const auto found = read(pcap(
        link, {event('S', 0x02, 1, "in1\n"), event('C', 0x02, 1, ""), event('C', 0x82, 2, "out\n")},
        big));
    EXPECT_EQ(found.records, (Texts{">0 in1\n", "<0 out\n"})) << link;
  }
}

TEST(Foreign, TheUserMayChooseAmongDevicesOnABus) {
  const auto content =
      pcap(189, {usb('C', 3, 0x82, 5, 1, 2, "a\n"), usb('C', 3, 0x82, 9, 2, 2, "x\n")});
  auto how = kHow;
  how.usb = {2, 9};
  EXPECT_EQ(read(content).records, Texts{"<0 a\n"});
  EXPECT_EQ(read(content, how).records, Texts{"<0 x\n"});
}

TEST(Foreign, ReadsAnI2cBusWithoutItsEvents) {
  // The bus, flags, and the address with the direction; an event has the highest bit of the first.
  const auto found =
      read(pcap(209, {"\x01\x00\x00\x00\x00\x24"s + "ab", "\x81\x00\x00\x00\x02\x24"s,
                      "\x01\x00\x00\x00\x00\x25"s + "c"}));
  EXPECT_EQ(found.records, (Texts{">18 ab", "<18 c"}));
  EXPECT_EQ(found.device, "bus");
}

TEST(Foreign, AFileCutAnywhereIsAPartOrAProblem) {
  const auto whole = pcap(101, {ipv4({kTo, 1, 0, kAck, "ab\n"}), ipv4({kTo, 4, 0, kAck, "cd\n"})});
  for (std::size_t size = 4; size < whole.size(); ++size) {
    const auto found = read(whole.substr(0, size));
    EXPECT_TRUE(!found.problem.empty() || found.records.size() < 2) << size;
    const bool is_between = size == 24 || size == 24 + (whole.size() - 24) / 2;
    EXPECT_EQ(found.problem.empty() && found.warning.empty(), is_between) << size;
  }
}

TEST(Foreign, APacketCutAnywhereIsPassedOver) {
  const auto whole = ipv6({kTo, 1, 0, kAck, "ab\n"});
  for (std::size_t size = 0; size <= 60; ++size) {
    const auto found = read(pcap(101, {whole.substr(0, size)}));
    EXPECT_EQ(found.records, Texts{}) << size;
    EXPECT_EQ(found.problem, "") << size;
  }
}

}  // namespace
}  // namespace armjig
