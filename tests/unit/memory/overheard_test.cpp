// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/overheard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "harness/core/hex.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// One line for each thing that it is told.
class Lines final : public Overhearer {
 public:
  void to_device(Instant time, Bytes bytes) override { add(time, "to " + to_hex(bytes)); }
  void from_device(Instant time, Bytes bytes) override { add(time, "from " + to_hex(bytes)); }
  void on_connection(const ConnectionEvent& event) override {
    add(event.time, std::to_string(event.connection) + " " +
                        std::to_string(static_cast<int>(event.kind)) + to_hex(event.bytes));
  }
  void on_bus(const BusPart& part) override {
    add(part.begin, std::to_string(part.address) + (part.is_read ? " read " : " write ") +
                        to_hex(part.bytes) + " " + std::string{part.acks} +
                        (part.ending == BusPart::Ending::kStop ? "" : " no stop"));
  }
  void on_input(Instant time, std::string_view name, std::int64_t value) override {
    add(time, std::string{name} + "=" + std::to_string(value));
  }

  std::vector<std::string> lines;

 private:
  void add(Instant time, const std::string& text) {
    lines.push_back(std::to_string(microseconds(time)) + " " + text);
  }
};

TEST(Overheard, TellsWhatPassesOnAStreamOnceAndInOrder) {
  Lines heard;
  auto device =
      overhear(std::get<cli::OnStream>(test::device("demo").port).emulate({}, "").value(), heard);
  constexpr std::array kQuery{std::byte{0xa5}, std::byte{0x71}, std::byte{0x8e}};
  device->receive(at(10ms), kQuery);
  device->advance_to(at(11ms));
  device->advance_to(at(12ms));
  device->clear_sent();
  device->advance_to(at(13ms));
  EXPECT_THAT(heard.lines, ElementsAre("10000 to a5718e", "11000 from 5a00ff"));
}

TEST(Overheard, TellsOfInputsThatAreTaken) {
  Lines heard;
  auto device =
      overhear(std::get<cli::OnStream>(test::device("parol6").port).emulate({}, "").value(), heard);
  EXPECT_TRUE(device->set_input(at(1ms), "estop", 1));
  EXPECT_FALSE(device->set_input(at(2ms), "no such", 1));
  EXPECT_THAT(heard.lines, ElementsAre("1000 estop=1"));
}

TEST(Overheard, TellsOfPartsOfABusAndWhoAcknowledged) {
  Lines heard;
  auto bus =
      overhear(std::get<cli::OnBus>(test::device("morap").port).emulate({}, "").value(), heard);
  auto time = at(1ms);
  const auto then = [&time](const BusReply& reply) { time = reply.end; };
  then(bus->start(time, 18, false));
  then(bus->write(time, std::byte{0x80}));
  then(bus->start(time, 18, true));
  then(bus->read(time));
  then(bus->stop(time));
  then(bus->start(time, 99, false));
  then(bus->stop(time));
  for (auto& line : heard.lines) line.erase(0, line.find(' ') + 1);
  EXPECT_THAT(heard.lines, ElementsAre("18 write 80 AA no stop", "18 read 00 A", "99 write  N"));
}

}  // namespace
}  // namespace armjig
