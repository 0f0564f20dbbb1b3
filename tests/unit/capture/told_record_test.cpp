// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/told_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "harness/core/hex.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

class ToldLines final : public Overhearer {
 public:
  void to_device(Instant, Bytes bytes) override { lines.push_back("to " + to_hex(bytes)); }
  void from_device(Instant, Bytes bytes) override { lines.push_back("from " + to_hex(bytes)); }
  void on_connection(const ConnectionEvent& event) override {
    lines.push_back("connection " + std::to_string(event.connection) + " " +
                    std::to_string(static_cast<int>(event.kind)) + " " + to_hex(event.bytes));
  }
  void on_bus(const BusPart& part) override {
    lines.push_back(std::string{part.is_read ? "read " : "write "} + std::string{part.acks} +
                    (part.ending == BusPart::Ending::kStop ? "" : " no stop"));
  }
  void on_input(Instant, std::string_view name, std::int64_t value) override {
    lines.push_back(std::string{name} + "=" + std::to_string(value));
  }
  std::vector<std::string> lines;
};

std::vector<std::string> told_of_record(LinkKind kind, Direction direction,
                                        std::string_view details, Bytes bytes) {
  const CaptureLink link{"x", "x", kind};
  ToldLines heard;
  tell({at(1s), &link, direction, 3, bytes, details}, heard);
  return heard.lines;
}

TEST(ToldRecord, IsWhatPassed) {
  constexpr std::array kBytes{std::byte{0xAB}};
  using enum Direction;
  EXPECT_THAT(told_of_record(LinkKind::kStream, kToDevice, "", kBytes), ElementsAre("to ab"));
  EXPECT_THAT(told_of_record(LinkKind::kStream, kFromDevice, "", kBytes), ElementsAre("from ab"));
  EXPECT_THAT(told_of_record(LinkKind::kSession, kToDevice, "", kBytes),
              ElementsAre("connection 3 1 ab"));
  EXPECT_THAT(told_of_record(LinkKind::kBus, kToDevice, R"("ack":"AN","stop":false)", kBytes),
              ElementsAre("write AN no stop"));
  EXPECT_THAT(told_of_record(LinkKind::kBus, kFromDevice, "", kBytes), ElementsAre("read A"));
  EXPECT_THAT(told_of_record(LinkKind::kCan, kToDevice, "", kBytes), ElementsAre());
}

TEST(ToldRecord, HasConnectionsAndInputsFromEvents) {
  const auto event = [](std::string_view details) {
    return told_of_record(LinkKind::kEvents, Direction::kToDevice, details, {});
  };
  EXPECT_THAT(event(R"("dir":"connect","conn":7,"text":"ok")"), ElementsAre("connection 7 0 "));
  EXPECT_THAT(event(R"("dir":"connect","conn":7,"text":"refused")"), ElementsAre());
  EXPECT_THAT(event(R"("dir":"disconnect","conn":7,"text":"device-eof")"),
              ElementsAre("connection 7 6 "));
  EXPECT_THAT(event(R"("op":"input","name":"adc","value":-2)"), ElementsAre("adc=-2"));
  EXPECT_THAT(event(R"("dir":"overlooked","text":"late")"), ElementsAre());
}

}  // namespace
}  // namespace armjig
