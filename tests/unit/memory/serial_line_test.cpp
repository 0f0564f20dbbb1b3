// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/serial_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>

#include "emulators/demo/demo.hpp"
#include "emulators/memory/in_memory.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::hex;
using ::testing::ElementsAre;

/// Notes when each call brings how many bytes, and answers 01 02 at once to a byte FF.
struct Recorder {
  std::vector<Instant> times;
  std::vector<std::size_t> sizes;
  std::vector<SentBytes> answers;

  void receive(Instant time, Bytes bytes) {
    times.push_back(time);
    sizes.push_back(bytes.size());
    if (bytes.front() == std::byte{0xFF}) {
      answers.push_back({time, {std::byte{1}, std::byte{2}}});
    }
  }
  void advance_to(Instant /*time*/) {}
  [[nodiscard]] std::optional<Instant> next_event() const { return std::nullopt; }
  [[nodiscard]] std::span<const SentBytes> sent() const { return answers; }
  void clear_sent() { answers.clear(); }
  [[nodiscard]] bool set_input(Instant /*time*/, std::string_view name, std::int64_t /*value*/) {
    return name == "known";
  }
};

/// Shares what the recorder notes, which a copy does not.
struct Shared {
  std::shared_ptr<Recorder> recorder = std::make_shared<Recorder>();

  void receive(Instant time, Bytes bytes) { recorder->receive(time, bytes); }
  void advance_to(Instant time) { recorder->advance_to(time); }
  [[nodiscard]] std::optional<Instant> next_event() const { return recorder->next_event(); }
  [[nodiscard]] std::span<const SentBytes> sent() const { return recorder->sent(); }
  void clear_sent() { recorder->clear_sent(); }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) {
    return recorder->set_input(time, name, value);
  }
};

// 1000 baud and 10 bits: 10 ms for each character.
constexpr CharacterRate kSlow{.baud = 1000};

TEST(CharacterRate, AddsNoErrorsUp) {
  // 11 bits at 1200 baud are 9.1666... ms.
  constexpr CharacterRate kModbus{.baud = 1200, .bits = 11};
  EXPECT_EQ(kModbus.time_of(1), 9'166'667ns);
  EXPECT_EQ(kModbus.time_of(6), 55ms);
  EXPECT_EQ(kModbus.time_of(12'000'000), 110'000s);
}

TEST(SerialLine, BringsEachCharacterWhenItsLastBitHasCome) {
  const Shared device;
  const auto port = open_in_memory(put_on_line(make_hosted(device), kSlow));
  std::array<std::byte, 8> buffer{};
  ASSERT_TRUE(port->write(hex("01 02")));
  ASSERT_EQ(port->read(buffer, at(100ms)), 0U);
  ASSERT_TRUE(port->write(hex("03")));
  ASSERT_EQ(port->read(buffer, at(200ms)), 0U);
  EXPECT_THAT(device.recorder->times, ElementsAre(at(10ms), at(20ms), at(110ms)));
  EXPECT_THAT(device.recorder->sizes, ElementsAre(1U, 1U, 1U));
}

TEST(SerialLine, LetsWritesWaitForEachOther) {
  const Shared device;
  const auto port = open_in_memory(put_on_line(make_hosted(device), kSlow));
  std::array<std::byte, 8> buffer{};
  ASSERT_TRUE(port->write(hex("01")));
  ASSERT_EQ(port->read(buffer, at(5ms)), 0U);
  ASSERT_TRUE(port->write(hex("02")));
  ASSERT_EQ(port->read(buffer, at(19ms)), 0U);
  EXPECT_THAT(device.recorder->times, ElementsAre(at(10ms)));
  ASSERT_EQ(port->read(buffer, at(20ms)), 0U);
  EXPECT_THAT(device.recorder->times, ElementsAre(at(10ms), at(20ms)));
}

TEST(SerialLine, TakesItsTimeForAnswersToo) {
  const auto port = open_in_memory(put_on_line(make_hosted(Shared{}), kSlow));
  std::array<std::byte, 8> buffer{};
  ASSERT_TRUE(port->write(hex("FF")));
  ASSERT_EQ(port->read(buffer, at(1s)), 1U);
  EXPECT_EQ(port->now(), at(20ms)) << "10 ms for the question, 10 ms for the first character";
  ASSERT_EQ(port->read(buffer, at(1s)), 1U);
  EXPECT_EQ(port->now(), at(30ms));
  EXPECT_EQ(buffer[0], std::byte{2});
}

TEST(SerialLine, CutsTimeAnywhereAndSeesTheSame) {
  const auto run = [](Duration stride) {
    const auto device = put_on_line(make_hosted(demo::emulation::StreamDevice{}), kSlow);
    device->receive(at(0s), hex("A5 71 8E A5 73 8C"));
    std::vector<std::pair<Instant, std::byte>> sent;
    for (Instant time{}; time <= at(1s); time += stride) {
      device->advance_to(time);
      for (const auto& each : device->sent()) sent.emplace_back(each.time, each.bytes.front());
      device->clear_sent();
    }
    return sent;
  };
  const auto whole = run(1s);
  EXPECT_EQ(whole.size(), 6U);
  // The third character has come at 30 ms, and the device thinks for 1 ms.
  EXPECT_EQ(whole.front().first, at(41ms));
  EXPECT_EQ(whole, run(1ms));
}

TEST(SerialLine, CopiesWhatIsOnItsWay) {
  const auto device = put_on_line(make_hosted(demo::emulation::StreamDevice{}), kSlow);
  device->receive(at(0s), hex("A5 71 8E"));
  device->advance_to(at(15ms));
  const auto copy = device->clone();
  EXPECT_EQ(copy->unread(), 2U);
  for (auto* each : {device.get(), copy.get()}) {
    each->advance_to(at(1s));
    EXPECT_EQ(each->sent().size(), 3U);
  }
}

TEST(SerialLine, PassesInputsOn) {
  const auto device = put_on_line(make_hosted(Recorder{}), kSlow);
  EXPECT_TRUE(device->set_input(at(1s), "known", 1));
  EXPECT_FALSE(device->set_input(at(1s), "unknown", 1));
}

}  // namespace
}  // namespace armjig
