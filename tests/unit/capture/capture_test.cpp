// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "harness/capture/pcapng.hpp"
#include "harness/capture/trace.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;

/// A file of a test, gone at its end.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view content) {
    std::ofstream{path_, std::ios::binary} << content;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { fs::remove(path_); }
  [[nodiscard]] UserFile open() const { return UserFile::open(path_).value(); }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  std::string path_ = fs::temp_directory_path() / ("armjig-capture-" + std::to_string(::getpid()));
};

std::string content_of(const std::string& path) {
  std::ifstream in{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

struct Copied {
  std::string content;
  std::string warning;
  Outcome<void> result;
};

/// All of a file in another format, as far as it can be read.
Copied copy(UserFile file, CaptureFormat format) {
  Copied copied;
  auto reader = CaptureReader::open(std::move(file), "input");
  if (!reader) return {.content = {}, .warning = {}, .result = tl::unexpected{reader.error()}};
  const auto writer = make_capture_writer(format);
  copied.result = writer->begin((*reader)->header(), copied.content);
  CaptureRecord record;
  while (copied.result) {
    const auto has_record = (*reader)->next(record);
    if (!has_record) copied.result = tl::unexpected{has_record.error()};
    if (!has_record || !*has_record) break;
    copied.result = writer->add(record, {}, copied.content);
  }
  copied.warning = (*reader)->warning();
  return copied;
}

std::string packets_of(std::string_view lines) {
  const TemporaryFile file{lines};
  return copy(file.open(), CaptureFormat::kPcapng).content;
}

std::vector<Json> parsed_lines(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) lines.push_back(Json::parse(line));
  }
  return lines;
}

constexpr auto kStreamLines = R"({"format":"golden-trace/1","device":"demo","title":"t","seed":7}
{"t_us":0,"dir":"input","name":"estop","value":1}
{"t_us":10000,"dir":"to_device","hex":"a5718e"}
{"t_us":11000,"ns":250,"dir":"from_device","hex":"5a00ff"}
)";

TEST(Capture, EveryRecordingComesBackFromPcapngAsItWas) {
  const auto files = find_traces({source_dir() + "/captures"}).value();
  ASSERT_GT(files.size(), 300U);
  for (const auto& path : files) {
    SCOPED_TRACE(path);
    const auto text = content_of(path);
    const TemporaryFile packets{packets_of(text)};
    const auto back = copy(packets.open(), CaptureFormat::kLines);
    ASSERT_TRUE(back.result) << describe(back.result.error());
    EXPECT_EQ(back.warning, "");
    std::istringstream expected{text};
    std::istringstream actual{back.content};
    for (std::string was, is; std::getline(expected, was);) {
      if (was.empty()) continue;
      ASSERT_TRUE(std::getline(actual, is)) << was;
      if (is == was) continue;
      ASSERT_EQ(Json::parse(is), Json::parse(was));
    }
    EXPECT_EQ(actual.peek(), EOF);
  }
}

TEST(Capture, OfPcapngComesBackFromLinesToTheByte) {
  const auto packets = packets_of(kStreamLines);
  const TemporaryFile first{packets};
  const auto lines = copy(first.open(), CaptureFormat::kLines).content;
  EXPECT_EQ(packets_of(lines), packets);
}

TEST(Capture, ALineThatNoPacketCanSayIsKeptAsAnEvent) {
  for (const char* const line :
       {R"({"t_us":1,"dir":"to_device"})", R"({"t_us":1,"dir":"to_device","hex":"A5 71"})",
        R"({"t_us":1,"dir":"can_to_device","id":4294967295,"hex":"00"})",
        R"({"t_us":1,"dir":"can_to_device","id":1,"hex":"000102030405060708"})",
        R"({"t_us":1,"t_ms":2,"dir":"from_device","conn":4294967295,"hex":"","ns":12})",
        R"({"t_us":1,"dir":"note","link":"elbow","device":"other","text":"\u00e4\n\"x\""})"}) {
    const auto text = std::string{kStreamLines}.substr(0, 65) + '\n' + line + '\n';
    const TemporaryFile packets{packets_of(text)};
    const auto back = copy(packets.open(), CaptureFormat::kLines);
    EXPECT_EQ(parsed_lines(back.content), parsed_lines(text));
    EXPECT_EQ(back.warning, "");
  }
}

TEST(Capture, AFileThatEndsAnywhereIsReadToItsLastWholeRecord) {
  const auto packets = packets_of(kStreamLines);
  const auto all = parsed_lines(kStreamLines);
  std::size_t most = 0;
  for (std::size_t size = 0; size < packets.size(); ++size) {
    const TemporaryFile file{packets.substr(0, size)};
    const auto read = copy(file.open(), CaptureFormat::kLines);
    if (!read.result) {
      EXPECT_EQ(most, 0U) << size;
      EXPECT_EQ(read.result.error().code, ErrorCode::kMalformed);
      continue;
    }
    const auto lines = parsed_lines(read.content);
    ASSERT_GE(lines.size(), most) << size;
    most = lines.size();
    for (std::size_t i = 1; i < lines.size(); ++i) ASSERT_EQ(lines[i], all[i]) << size;
  }
  EXPECT_EQ(most, all.size() - 1);
}

TEST(Capture, ACutFileSaysSo) {
  const auto packets = packets_of(kStreamLines);
  const TemporaryFile file{packets.substr(0, packets.size() - 1)};
  const auto read = copy(file.open(), CaptureFormat::kLines);
  EXPECT_TRUE(read.result);
  EXPECT_THAT(read.warning, HasSubstr("the file ends within a block"));
}

TEST(Capture, NoFlippedBitIsMoreThanAProblem) {
  const auto packets = packets_of(kStreamLines);
  for (std::size_t bit = 0; bit < 8 * packets.size(); ++bit) {
    auto flipped = packets;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    const TemporaryFile file{flipped};
    const auto read = copy(file.open(), CaptureFormat::kLines);
    if (!read.result) {
      EXPECT_FALSE(read.result.error().hint.empty());
    }
  }
}

TEST(Capture, ALengthThatLiesIsNamedWithItsPlace) {
  auto packets = packets_of(kStreamLines);
  const auto second_block = std::to_integer<std::size_t>(static_cast<std::byte>(packets[4]));
  packets[second_block + 4] = '\x01';
  const TemporaryFile file{packets};
  const auto read = copy(file.open(), CaptureFormat::kLines);
  ASSERT_FALSE(read.result);
  EXPECT_THAT(describe(read.result.error()),
              HasSubstr("the block at byte " + std::to_string(second_block) + ": its length"));
}

TEST(Capture, TheOtherByteOrderReadsTheSame) {
  // A section, an interface of link type 252 with times of 2^-1 s and an offset of 1 s, and a
  // packet at half a second, from the device, of the dissector `demo` with the bytes 5A 00 FF: all
  // most significant byte first.
  using namespace std::string_literals;
  const auto content =
      "\x0a\x0d\x0d\x0a\x00\x00\x00\x1c\x1a\x2b\x3c\x4d\x00\x01\x00\x00\xff\xff\xff\xff\xff\xff\xff"
      "\xff"
      "\x00\x00\x00\x1c"
      "\x00\x00\x00\x01\x00\x00\x00\x2c\x00\xfc\x00\x00\x00\x00\x00\x00"
      "\x00\x09\x00\x01\x81\x00\x00\x00\x00\x0e\x00\x08\x00\x00\x00\x00\x00\x00\x00\x01"
      "\x00\x00\x00\x00\x00\x00\x00\x2c"
      "\x00\x00\x00\x06\x00\x00\x00\x3c\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x01\x00\x00\x00"
      "\x0f"
      "\x00\x00\x00\x0f\x00\x0c\x00\x04"
      "demo\x00\x00\x00\x00\x5a\x00\xff\x00\x00\x02\x00\x04\x00\x00\x00\x01"
      "\x00\x00\x00\x00\x00\x00\x00\x3c"s;
  const TemporaryFile file{content};
  auto reader = CaptureReader::open(file.open(), "input");
  ASSERT_TRUE(reader) << describe(reader.error());
  EXPECT_EQ((*reader)->header().epoch_ns, 1'500'000'000);
  CaptureRecord record;
  ASSERT_TRUE((*reader)->next(record).value());
  EXPECT_EQ(record.link->device, "demo");
  EXPECT_EQ(record.direction, Direction::kFromDevice);
  ASSERT_EQ(record.bytes.size(), 3U);
  EXPECT_EQ(record.bytes[0], std::byte{0x5A});
  EXPECT_FALSE((*reader)->next(record).value());
}

TEST(Capture, WhatToldWhoRecordedItCanBeTakenAway) {
  const auto header = CaptureHeader::parse(
      R"({"format":"golden-trace/1","device":"demo","target":"tcp:lab:1","host":"h","user":"u",)"
      R"("serial":"s","title":"t"})",
      "here");
  EXPECT_EQ(header->redacted().json, R"({"format":"golden-trace/1","device":"demo","title":"t"})");
}

TEST(Capture, TheEndingChoosesTheFormat) {
  EXPECT_EQ(capture_format_of("a/b.pcapng"), CaptureFormat::kPcapng);
  EXPECT_EQ(capture_format_of("b.jsonl"), CaptureFormat::kLines);
  EXPECT_EQ(capture_format_of("-"), CaptureFormat::kLines);
  EXPECT_EQ(capture_format_of("b.pcap").error().code, ErrorCode::kBadValue);
}

}  // namespace
}  // namespace armjig
