// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/logged_ports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>

#include "harness/capture/trace.hpp"
#include "harness/link/transaction_bus.hpp"
#include "harness/rig/rig.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr BusAddress kNode{18};
constexpr BusAddress kNobody{99};
constexpr std::array kSelectAngle{std::byte{0x80}};
constexpr std::array kTwoBytes{std::byte{1}, std::byte{2}};

/// A line without its time.
std::string line_of(const TraceEvent& event) {
  auto json = nlohmann::ordered_json::parse(event.json);
  json.erase("t_us");
  json.erase("ns");
  json.erase("messages");
  return json.dump();
}

class BusLog : public testing::Test {
 protected:
  ~BusLog() override { fs::remove(path_); }

  [[nodiscard]] std::unique_ptr<BusPort> logged(std::unique_ptr<BusPort> port) const {
    return put_log_on(
        std::move(port),
        WireLog::create({.file = OutputFile::open(path_, OutputFile::Kind::kGrowing).value()},
                        {.device = "morap", .make_dissector = morap::make_dissector})
            .value());
  }
  [[nodiscard]] std::unique_ptr<BusPort> logged_node() const {
    const auto target = parse_target("emulated:").value();
    return logged(std::move(test::wiring<cli::OnBus>("morap").open_emulated(target).value()));
  }
  [[nodiscard]] std::vector<TraceEvent> events() const { return read_trace(path_).value().events; }
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::ranges::transform(events(), std::back_inserter(all), line_of);
    return all;
  }

  std::string path_ = fs::temp_directory_path() / ("armjig-bus-log-" + std::to_string(::getpid()));
};

TEST_F(BusLog, HasEveryByteAndWhoAcknowledgedIt) {
  const auto bus = logged_node();
  std::array<std::byte, 4> value;
  const std::array read{write_to(kNode, kSelectAngle), read_from(kNode, value)};
  ASSERT_EQ(bus->transfer(read).value(), Transfer::kDone);
  const auto nobody = write_to(kNobody, kTwoBytes);
  ASSERT_EQ(bus->transfer({&nobody, 1}).value(), Transfer::kAddressRefused);
  EXPECT_THAT(lines(),
              testing::ElementsAre(R"({"op":"write","addr":18,"hex":"80","ack":"AA","stop":false})",
                                   R"({"op":"read","addr":18,"hex":"00000000","ack":"A"})",
                                   R"({"op":"write","addr":99,"hex":"","ack":"N"})"));
}

TEST_F(BusLog, SaysWhenAPartBeganAndWhatItMeans) {
  const auto bus = logged_node();
  bus->wait_until(at(5ms));
  const auto select = write_to(kNode, kSelectAngle);
  ASSERT_TRUE(bus->transfer({&select, 1}));
  const auto all = events();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].time, at(5ms));
  const auto messages = nlohmann::json::parse(all[0].json)["messages"];
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0]["schema"], "armjig.message/1");
  EXPECT_EQ(messages[0]["message"], "select");
}

TEST_F(BusLog, HasTransactionsThatAreLedByteByByteAndThoseThatNeverEnd) {
  {
    const auto bus = logged_node();
    std::ignore = bus->start(kNode, Access::kWrite);
    std::ignore = bus->write(std::byte{0x80});
    std::ignore = bus->stop();
    std::ignore = bus->start(kNode, Access::kRead);
    std::ignore = bus->read(Ack::kAck);
  }
  EXPECT_THAT(lines(),
              testing::ElementsAre(R"({"op":"write","addr":18,"hex":"80","ack":"AA"})",
                                   R"({"op":"read","addr":18,"hex":"00","ack":"A","stop":false})"));
}

/// As little as Linux tells.
class Adapter final : public TransactionBus {
 public:
  explicit Adapter(Result<Transfer> answer) : answer_{answer} {}
  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    for (const auto& message : messages) std::ranges::fill(message.read, std::byte{0x42});
    return answer_;
  }
  void wait_until(Instant /*time*/) override {}
  [[nodiscard]] Instant now() const override { return {}; }

 private:
  Result<Transfer> answer_;
};

struct Answer {
  Result<Transfer> answer;
  std::vector<std::string> lines;
};

TEST_F(BusLog, OfAnAdapterSaysWhatItKnows) {
  std::array<std::byte, 2> value;
  const std::array messages{write_to(kNode, kTwoBytes), read_from(kNode, value)};
  for (
      const auto& [answer, expected] :
      {Answer{Transfer::kDone,
              {R"({"op":"write","addr":18,"hex":"0102","ack":"AAA","stop":false})",
               R"({"op":"read","addr":18,"hex":"4242","ack":"A"})"}},
       Answer{Transfer::kByteRefused,
              {R"({"op":"write","addr":18,"hex":"0102","ack":"","refused":"byte","stop":false})",
               R"({"op":"read","addr":18,"hex":"","ack":"","refused":"byte"})"}},
       Answer{
           fail(ErrorCode::kTimedOut),
           {R"({"op":"write","addr":18,"hex":"0102","ack":"","error":"no answer in time","stop":false})",
            R"({"op":"read","addr":18,"hex":"","ack":"","error":"no answer in time"})"}}}) {
    const auto bus = logged(std::make_unique<Adapter>(answer));
    EXPECT_EQ(bus->transfer(messages), answer) << "it is passed on";
    EXPECT_EQ(lines(), expected);
  }
  const auto bus = logged(std::make_unique<Adapter>(Transfer::kByteRefused));
  std::ignore = bus->transfer(std::span{messages}.first(1));
  EXPECT_THAT(lines(), testing::ElementsAre(
                           R"({"op":"write","addr":18,"hex":"0102","ack":"A","refused":"byte"})"));
}

TEST_F(BusLog, IsPutIntoARig) {
  RigOptions options;
  options.target = parse_target("emulated:").value();
  options.capture.file = OutputFile::open(path_, OutputFile::Kind::kGrowing).value();
  const auto wiring = test::wiring<cli::OnBus>("morap");
  auto rig = Rig<BusPort>::open(wiring, options);
  ASSERT_TRUE(rig.has_value());
  const auto select = write_to(kNode, kSelectAngle);
  ASSERT_TRUE(rig->port().transfer({&select, 1}));
  EXPECT_EQ(events().size(), 1U);
  options.capture.file = OutputFile::open("/dev/full", OutputFile::Kind::kGrowing).value();
  EXPECT_EQ(Rig<BusPort>::open(wiring, options).error().code, ErrorCode::kCannotWrite);
}

TEST_F(BusLog, HasWhatIsLeftOfAnImpairedTransaction) {
  RigOptions options;
  options.target = parse_target("emulated:").value();
  options.capture.file = OutputFile::open(path_, OutputFile::Kind::kGrowing).value();
  options.impairment = parse_impairment("out.disconnect-after=1").value();
  auto rig = cli::open_rig<cli::OnBus>(test::device("morap"), options);
  ASSERT_TRUE(rig.has_value());
  const auto select = write_to(kNode, kSelectAngle);
  EXPECT_EQ(rig->port().transfer({&select, 1}), Transfer::kByteRefused);
  EXPECT_EQ(rig->impairments()->out.disconnects, 1U);
  EXPECT_THAT(lines(), testing::ElementsAre(R"({"op":"write","addr":18,"hex":"","ack":"A"})"));
}

}  // namespace
}  // namespace armjig
