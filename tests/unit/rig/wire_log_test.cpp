// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/logged_ports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "emulators/parol6/arm.hpp"
#include "harness/capture/trace.hpp"
#include "harness/files/user_file.hpp"
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
  return WireLog::create({.file = file},
                         {.device = "parol6", .make_dissector = parol6::make_dissector});
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
    return put_log_on(std::move(arm), parol6_log(path_).value());
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
const auto kIdleFrame = encode(parol6::CommandFrame{.command = parol6::Command::kIdle});

TEST_F(WireLog, HasEveryByteBothWaysInPiecesAsTheyCame) {
  const auto port = logged_arm();
  test::ByteVector written;
  test::ByteVector read;
  test::Dice dice{5};
  for (int i = 0; i < 20; ++i) {
    const auto cut = static_cast<std::size_t>(dice.between(0, 56));
    ASSERT_TRUE(port->write(Bytes{kIdleFrame}.first(cut)));
    ASSERT_TRUE(port->write(Bytes{kIdleFrame}.subspan(cut)));
    written = test::joined(std::move(written), kIdleFrame);
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
  ASSERT_TRUE(port->write(kIdleFrame));
  const auto events = trace().events;
  ASSERT_EQ(events.size(), 1U) << "nothing was read, so there is nothing to write down";
  EXPECT_EQ(events.front().time, at(30ms));
}

TEST_F(WireLog, SaysWhatItMeansWhereAMessageEnds) {
  const auto port = logged_arm();
  ASSERT_TRUE(port->write(Bytes{kIdleFrame}.first(30)));
  ASSERT_TRUE(port->write(Bytes{kIdleFrame}.subspan(30)));
  const auto all = lines();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_FALSE(all[1].contains("messages"));
  ASSERT_EQ(all[2]["messages"].size(), 1U);
  EXPECT_EQ(all[2]["messages"][0]["schema"], "armjig.message/1");
}

TEST_F(WireLog, HasEachLineOnDiskBeforeTheCallReturns) {
  const auto port = logged_arm();
  EXPECT_EQ(trace().device, "parol6");
  ASSERT_TRUE(port->write(kIdleFrame));
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
  const auto port = put_log_on(std::make_unique<Broken>(), parol6_log(path_).value());
  std::array<std::byte, 8> buffer;
  EXPECT_FALSE(port->write(kIdleFrame));
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
    const auto port = put_log_on(std::move(arm), parol6_log(file).value());
    for (int i = 0; i < 20; ++i)
      ASSERT_TRUE(port->write(kIdleFrame)) << "the device is not to blame";
  }
  ASSERT_TRUE(file->failure());
  EXPECT_EQ(file->failure()->where, path_);
  EXPECT_LT(trace().events.size(), 20U);
  EXPECT_LT(fs::file_size(path_), 2'000U);
}

/// A recording of what is overheard in two formats, as one of them.
class CaptureOfAWire : public WireLog {
 protected:
  ~CaptureOfAWire() override { fs::remove(other_); }

  [[nodiscard]] static std::shared_ptr<armjig::WireLog> begin(const std::string& path,
                                                              CaptureFile how,
                                                              CaptureSubject subject = {}) {
    how.file = OutputFile::open(path, OutputFile::Kind::kGrowing).value();
    if (subject.device.empty()) subject.device = "parol6";
    subject.make_dissector = parol6::make_dissector;
    return armjig::WireLog::create(how, subject).value();
  }
  [[nodiscard]] static std::vector<std::string> events_of(const std::string& path) {
    std::vector<std::string> all;
    const auto trace = read_trace(path).value();
    for (const auto& event : trace.events) {
      auto json = nlohmann::ordered_json::parse(event.json);
      json.erase("messages");
      all.push_back(json.dump());
    }
    return all;
  }
  /// What `tell` tells in both formats, which has to be the same.
  template <class Tell>
  [[nodiscard]] std::vector<std::string> recorded(LinkKind kind, Tell tell) const {
    for (const auto& [path, format] :
         {std::pair{path_, CaptureFormat::kLines}, std::pair{other_, CaptureFormat::kPcapng}}) {
      tell(*write_overheard(begin(path, {.format = format}), kind));
    }
    EXPECT_EQ(events_of(path_), events_of(other_));
    return events_of(other_);
  }

  std::string other_ = path_ + ".pcapng";
};

TEST_F(CaptureOfAWire, HasTheSameInBothFormats) {
  EXPECT_THAT(
      recorded(LinkKind::kStream,
               [](Overhearer& log) {
                 log.to_device(at(1ms), Bytes{kIdleFrame}.first(2));
                 log.on_input(at(2ms), "estop", 1);
                 log.from_device(at(2ms), Bytes{kIdleFrame}.first(1));
                 log.overlook(at(3ms), at(50ms));
               }),
      testing::ElementsAre(
          R"({"t_us":1000,"dir":"to_device","hex":"ffff"})",
          R"({"t_us":2000,"dir":"input","name":"estop","value":1})",
          R"({"t_us":2000,"dir":"from_device","hex":"ff"})",
          R"({"t_us":50000,"dir":"overlooked","since_us":3000,"text":"armjig was late itself"})"));
}

TEST_F(CaptureOfAWire, HasConnectionsOfAServerAndHowTheyEnded) {
  using Kind = ConnectionEvent::Kind;
  const std::array byte{std::byte{65}};
  EXPECT_THAT(recorded(LinkKind::kSession,
                       [&](Overhearer& log) {
                         log.on_connection({at(1ms), 0, Kind::kBegun, {}});
                         log.on_connection({at(1ms), 1, Kind::kBegun, {}});
                         log.on_connection({at(2ms), 1, Kind::kToServer, byte});
                         log.on_connection({at(3ms), 0, Kind::kFromServer, byte});
                         log.on_connection({at(4ms), 0, Kind::kHalfClosed, {}});
                         log.on_connection({at(5ms), 0, Kind::kDropped, {}});
                         log.on_connection({at(6ms), 1, Kind::kReset, {}});
                       }),
              testing::ElementsAre(
                  R"({"t_us":1000,"dir":"connect","conn":0,"text":"ok"})",
                  R"({"t_us":1000,"dir":"connect","conn":1,"text":"ok"})",
                  R"({"t_us":2000,"dir":"to_device","conn":1,"hex":"41"})",
                  R"({"t_us":3000,"dir":"from_device","conn":0,"hex":"41"})",
                  R"({"t_us":4000,"dir":"disconnect","conn":0,"text":"client-half-close"})",
                  R"({"t_us":5000,"dir":"disconnect","conn":0,"text":"device-eof"})",
                  R"({"t_us":6000,"dir":"disconnect","conn":1,"text":"client-reset"})"));
}

TEST_F(CaptureOfAWire, HasPartsOfABus) {
  const std::array bytes{std::byte{1}, std::byte{2}};
  EXPECT_THAT(recorded(LinkKind::kBus,
                       [&](Overhearer& log) {
                         log.on_bus({.begin = at(1ms),
                                     .end = at(2ms),
                                     .address = 18,
                                     .bytes = bytes,
                                     .acks = "AAN",
                                     .ending = BusPart::Ending::kNextStart});
                         log.on_bus({.begin = at(2ms),
                                     .end = at(3ms),
                                     .address = 18,
                                     .is_read = true,
                                     .bytes = bytes,
                                     .acks = "A",
                                     .error = ErrorCode::kBusy});
                       }),
              testing::ElementsAre(
                  R"({"t_us":1000,"op":"write","addr":18,"hex":"0102","ack":"AAN","stop":false})",
                  R"({"t_us":2000,"op":"read","addr":18,"hex":"0102","ack":"A","error":")" +
                      std::string{describe(ErrorCode::kBusy)} + R"("})"));
}

TEST_F(CaptureOfAWire, SaysOfItselfOnlyWhatWasAskedFor) {
  const CaptureSubject subject{
      .device = {}, .make_dissector = {}, .target = "tcp:lab:1", .epoch_ns = 7};
  (void)begin(path_, {}, subject);
  (void)begin(other_, {.format = CaptureFormat::kPcapng, .is_redacted = true}, subject);
  const auto whole = nlohmann::json::parse(read_trace(path_)->header);
  EXPECT_EQ(whole["target"], "tcp:lab:1");
  EXPECT_EQ(whole["epoch_ns"], 7);
  EXPECT_EQ(whole.size(), 6U) << "format, device, title, source: nothing of who made it";
  std::ifstream file{other_};
  const std::string content{std::istreambuf_iterator<char>{file}, {}};
  EXPECT_THAT(content, testing::Not(testing::HasSubstr("lab")));
}

TEST_F(CaptureOfAWire, RotatesIntoWholeFiles) {
  for (const auto format : {CaptureFormat::kLines, CaptureFormat::kPcapng}) {
    const auto first = other_.substr(0, other_.size() - 7) + ".1.pcapng";
    {
      const auto log = write_overheard(
          begin(other_,
                {.format = format, .rotation = CaptureFile::Rotation{.bytes = 2'000, .files = 2}}),
          LinkKind::kStream);
      for (int i = 0; i < 100; ++i) log->to_device(at(i * 1ms), kIdleFrame);
    }
    const auto before = read_trace(first).value().events;
    const auto after = read_trace(other_).value().events;
    ASSERT_FALSE(before.empty());
    ASSERT_FALSE(after.empty());
    EXPECT_EQ(after.front().time, before.back().time + 1ms) << "nothing is lost in between";
    EXPECT_EQ(after.back().time, at(99ms));
    EXPECT_LE(fs::file_size(other_), 2'000U);
    EXPECT_LE(fs::file_size(first), 2'000U);
    fs::remove(first);
  }
}

TEST_F(CaptureOfAWire, OfPacketsEndsWithAWholeOneWhereTheDiskIsFull) {
  {
    const LimitedFileSize limit{2'000};
    const auto log =
        write_overheard(begin(other_, {.format = CaptureFormat::kPcapng}), LinkKind::kStream);
    for (int i = 0; i < 100; ++i) log->to_device(at(i * 1ms), kIdleFrame);
  }
  const auto reader = CaptureReader::open(UserFile::open(other_).value(), other_).value();
  CaptureRecord record;
  int records = 0;
  while (reader->next(record).value()) ++records;
  EXPECT_GT(records, 3);
  EXPECT_LT(records, 100);
  EXPECT_EQ(reader->warning(), "");
}

}  // namespace
}  // namespace armjig
