// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/logged_ports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "emulators/parol6/arm.hpp"
#include "harness/capture/trace.hpp"
#include "harness/link/memory_stream.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/limited_file_size.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::LimitedFileSize;
namespace fs = std::filesystem;

Outcome<std::shared_ptr<WireLog>> parol6_log(const std::shared_ptr<OutputFile>& file) {
  return WireLog::create(file, "parol6", parol6::make_dissector);
}
Outcome<std::shared_ptr<WireLog>> parol6_log(const std::string& path) {
  const auto file = OutputFile::open(path, OutputFile::Kind::kGrowing);
  return file ? parol6_log(*file) : tl::unexpected{file.error()};
}

class WireLog : public ::testing::Test {
 protected:
  ~WireLog() override { fs::remove(path_); }

  [[nodiscard]] std::unique_ptr<StreamPort> logged_arm() const {
    auto arm = std::make_unique<MemoryStream<parol6::emulation::Arm>>(parol6::emulation::Arm{});
    return std::make_unique<LoggedStream>(std::move(arm), parol6_log(path_).value());
  }
  [[nodiscard]] Trace trace() const { return read_trace(path_).value(); }
  [[nodiscard]] std::vector<nlohmann::json> lines() const {
    std::vector<nlohmann::json> all;
    std::ifstream file{path_};
    for (std::string line; std::getline(file, line);) all.push_back(nlohmann::json::parse(line));
    return all;
  }
  [[nodiscard]] test::ByteVector logged(std::string_view direction) const {
    test::ByteVector all;
    for (const auto& event : trace().events) {
      if (event.dir == direction) all = test::joined(std::move(all), event.bytes);
    }
    return all;
  }

  std::string path_ = fs::temp_directory_path() / ("armjig-wire-log-" + std::to_string(::getpid()));
};

/// A message of the host that the shipped board answers at once.
const auto kIdle = encode(parol6::CommandFrame{.command = parol6::Command::kIdle});

TEST_F(WireLog, HasEveryByteBothWaysInPiecesAsTheyCame) {
  const auto port = logged_arm();
  test::ByteVector written;
  test::ByteVector read;
  test::Dice dice{5};
  for (int i = 0; i < 20; ++i) {
    const auto cut = static_cast<std::size_t>(dice.between(0, 56));
    ASSERT_TRUE(port->write(Bytes{kIdle}.first(cut)));
    ASSERT_TRUE(port->write(Bytes{kIdle}.subspan(cut)));
    written = test::joined(std::move(written), kIdle);
    std::array<std::byte, 23> buffer;
    const auto deadline = port->now() + 10ms;
    while (const auto size = port->read(buffer, deadline).value()) {
      read.insert(read.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
    }
  }
  EXPECT_EQ(read.size(), 20 * parol6::kTelemetryFrameSize);
  EXPECT_TRUE(test::same_bytes(logged("to_device"), written));
  EXPECT_TRUE(test::same_bytes(logged("from_device"), read));
}

TEST_F(WireLog, SaysWhen) {
  const auto port = logged_arm();
  std::array<std::byte, 64> buffer;
  ASSERT_EQ(port->read(buffer, at(30ms)).value(), 0U);
  ASSERT_TRUE(port->write(kIdle));
  const auto events = trace().events;
  ASSERT_EQ(events.size(), 1U) << "nothing was read, so there is nothing to write down";
  EXPECT_EQ(events.front().time, at(30ms));
}

TEST_F(WireLog, SaysWhatItMeansWhereAMessageEnds) {
  const auto port = logged_arm();
  ASSERT_TRUE(port->write(Bytes{kIdle}.first(30)));
  ASSERT_TRUE(port->write(Bytes{kIdle}.subspan(30)));
  const auto all = lines();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_FALSE(all[1].contains("messages"));
  ASSERT_EQ(all[2]["messages"].size(), 1U);
  EXPECT_EQ(all[2]["messages"][0]["schema"], "armjig.message/1");
}

TEST_F(WireLog, HasEachLineOnDiskBeforeTheCallReturns) {
  const auto port = logged_arm();
  EXPECT_EQ(trace().device, "parol6");
  ASSERT_TRUE(port->write(kIdle));
  EXPECT_EQ(trace().events.size(), 1U);
}

TEST_F(WireLog, LeavesOutWhatWasNotWritten) {
  struct Broken final : StreamPort {
    Result<void> write(Bytes /*bytes*/) override { return fail(ErrorCode::kDisconnected); }
    Result<std::size_t> read(std::span<std::byte> /*into*/, Instant /*deadline*/) override {
      return fail(ErrorCode::kDisconnected);
    }
    [[nodiscard]] Instant now() const override { return {}; }
  };
  const auto port =
      std::make_unique<LoggedStream>(std::make_unique<Broken>(), parol6_log(path_).value());
  std::array<std::byte, 8> buffer;
  EXPECT_FALSE(port->write(kIdle));
  EXPECT_FALSE(port->read(buffer, {}));
  EXPECT_TRUE(trace().events.empty());
}

TEST_F(WireLog, AFileThatCannotBeWrittenIsNamed) {
  const auto log = parol6_log(std::string{"/nonexistent/log"});
  ASSERT_FALSE(log);
  EXPECT_EQ(log.error().code, ErrorCode::kCannotWrite);
  EXPECT_EQ(log.error().where, "/nonexistent/log");
}

TEST_F(WireLog, IsNotBegunOnAFullDisk) {
  EXPECT_EQ(parol6_log(std::string{"/dev/full"}).error().code, ErrorCode::kCannotWrite);
}

TEST_F(WireLog, EndsWithAWholeLineWhereTheDiskIsFull) {
  const auto file = OutputFile::open(path_, OutputFile::Kind::kGrowing).value();
  {
    auto arm = std::make_unique<MemoryStream<parol6::emulation::Arm>>(parol6::emulation::Arm{});
    const LimitedFileSize limit{2'000};
    LoggedStream port{std::move(arm), parol6_log(file).value()};
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(port.write(kIdle)) << "the device is not to blame";
  }
  ASSERT_TRUE(file->failure());
  EXPECT_EQ(file->failure()->where, path_);
  EXPECT_LT(trace().events.size(), 20U);
  EXPECT_LT(fs::file_size(path_), 2'000U);
}

}  // namespace
}  // namespace armjig
