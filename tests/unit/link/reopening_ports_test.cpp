// SPDX-License-Identifier: Apache-2.0
#include "harness/link/reopening_ports.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>

namespace armjig {
namespace {

using namespace std::chrono_literals;

/// What a port answers; the last reading is answered again and again.
struct Script {
  std::vector<Result<std::size_t>> reads;
  Result<void> write{};
};

class ScriptedPort final : public StreamPort {
 public:
  explicit ScriptedPort(Script script) : script_{std::move(script)} {}
  Result<void> write(Bytes /*bytes*/) override { return script_.write; }
  Result<std::size_t> read(std::span<std::byte> /*into*/, Instant deadline) override {
    last_deadline = deadline;
    return script_.reads[std::min(reads_++, script_.reads.size() - 1)];
  }
  [[nodiscard]] Instant now() const override { return at(1000s); }

  Instant last_deadline{};

 private:
  Script script_;
  std::size_t reads_ = 0;
};

auto gone() { return fail(ErrorCode::kDisconnected); }

std::unique_ptr<StreamPort> port(Script script) {
  return std::make_unique<ScriptedPort>(std::move(script));
}

std::byte read_byte;

TEST(ReopeningStream, PassesOnWhatComesWhileTheDeviceIsThere) {
  ReopeningStream stream{port({{3}}), [] { return port({{0}}); }};
  EXPECT_TRUE(stream.write({}));
  EXPECT_EQ(stream.read({&read_byte, 1}, stream.now() + 1s), 3U);
  EXPECT_EQ(stream.reopened(), 0U);
}

TEST(ReopeningStream, OpensADeviceThatHasGoneAtTheNextRead) {
  ReopeningStream stream{port({{1, gone()}}), [] { return port({{7}}); }};
  EXPECT_EQ(stream.read({&read_byte, 1}, stream.now()), 1U);
  EXPECT_EQ(stream.read({&read_byte, 1}, stream.now()), 0U) << "that it has gone is no error";
  EXPECT_EQ(stream.read({&read_byte, 1}, stream.now() + 1h), 7U);
  EXPECT_EQ(stream.reopened(), 1U);
}

TEST(ReopeningStream, LosesWhatIsWrittenWhileTheDeviceIsAway) {
  ReopeningStream stream{port({{0}, gone()}), [] { return port({{0}}); }};
  EXPECT_TRUE(stream.write({}));
  EXPECT_TRUE(stream.write({}));
  EXPECT_EQ(stream.reopened(), 0U) << "opening takes time, and who writes has a deadline";
}

TEST(ReopeningStream, TriesTwiceASecondAndKeepsThePaceOfItsReader) {
  int tries = 0;
  ReopeningStream stream{port({{gone()}}), [&tries]() -> Outcome<std::unique_ptr<StreamPort>> {
                           ++tries;
                           return problem(ErrorCode::kNotFound, "board", "plug it in");
                         }};
  for (int i = 0; i < 20; ++i) EXPECT_EQ(stream.read({&read_byte, 1}, stream.now()), 0U);
  EXPECT_EQ(tries, 1);
}

TEST(ReopeningStream, GivesTheDeviceAsMuchTimeAsItIsGiven) {
  auto inner = std::make_unique<ScriptedPort>(Script{{0}});
  const auto& seen = *inner;
  ReopeningStream stream{std::move(inner), [] { return port({{0}}); }};
  ASSERT_TRUE(stream.read({&read_byte, 1}, stream.now() + 1h));
  EXPECT_LE(seen.last_deadline, at(1000s + 1h));
  EXPECT_GT(seen.last_deadline, at(1000s + 59min));
}

TEST(ReopeningStream, OtherErrorsRemainErrors) {
  ReopeningStream stream{port({{fail(ErrorCode::kSystem)}, fail(ErrorCode::kTimedOut)}),
                         [] { return port({{0}}); }};
  EXPECT_EQ(stream.write({}).error().code, ErrorCode::kTimedOut);
  EXPECT_EQ(stream.read({&read_byte, 1}, stream.now()).error().code, ErrorCode::kSystem);
}

/// A bus that answers the same again and again.
class ScriptedBus final : public RealBus {
 public:
  explicit ScriptedBus(Result<Transfer> answer) : answer_{answer} {}
  Result<Transfer> transfer(std::span<const BusMessage> /*messages*/) override { return answer_; }

 private:
  Result<Transfer> answer_;
};

std::unique_ptr<BusPort> bus(Result<Transfer> answer) {
  return std::make_unique<ScriptedBus>(answer);
}

TEST(ReopeningBus, PassesOnWhatTheDevicesMakeOfIt) {
  for (const auto answer : {Transfer::kDone, Transfer::kAddressRefused, Transfer::kByteRefused}) {
    ReopeningBus port{bus(answer), [] { return bus(gone()); }};
    EXPECT_EQ(port.transfer({}), answer);
    EXPECT_EQ(port.reopened(), 0U);
  }
}

TEST(ReopeningBus, WaitsForAnAdapterThatHasGone) {
  ReopeningBus port{bus(gone()), [] { return bus(Transfer::kDone); }};
  EXPECT_EQ(port.transfer({}).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(port.transfer({}).error().code, ErrorCode::kNotFound)
      << "opening takes time, and who sends has a deadline";
  port.wait_until(port.now());
  EXPECT_EQ(port.transfer({}), Transfer::kDone);
  EXPECT_EQ(port.reopened(), 1U);
}

TEST(ReopeningBus, TriesTwiceASecondAndWaitsNoLongerThanItIsTold) {
  int tries = 0;
  ReopeningBus port{bus(gone()), [&tries]() -> Outcome<std::unique_ptr<BusPort>> {
                      ++tries;
                      return problem(ErrorCode::kNotFound, "adapter", "plug it in");
                    }};
  EXPECT_FALSE(port.transfer({}));
  const auto deadline = port.now() + 20ms;
  port.wait_until(deadline);
  EXPECT_GE(port.now(), deadline);
  for (int i = 0; i < 20; ++i) port.wait_until(port.now());
  EXPECT_EQ(tries, 1);
  EXPECT_EQ(port.transfer({}).error().code, ErrorCode::kNotFound);
}

TEST(ReopeningBus, OtherErrorsRemainErrors) {
  ReopeningBus port{bus(fail(ErrorCode::kBusy)), [] { return bus(Transfer::kDone); }};
  EXPECT_EQ(port.transfer({}).error().code, ErrorCode::kBusy);
  port.wait_until(port.now());
  EXPECT_EQ(port.transfer({}).error().code, ErrorCode::kBusy);
  EXPECT_EQ(port.reopened(), 0U);
}

}  // namespace
}  // namespace armjig
