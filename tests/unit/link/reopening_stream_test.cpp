// SPDX-License-Identifier: Apache-2.0
#include "harness/link/reopening_stream.hpp"

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

}  // namespace
}  // namespace armjig
