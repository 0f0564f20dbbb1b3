// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/clocked.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <optional>

#include "tests/unit/support/devices.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

TEST(DeviceClock, ReachesWhatItFoundsOutside) {
  const DeviceClock clock{.begin = at(7s), .rate = 1.0033};
  for (std::int64_t i = 0; i < 10'000; ++i) {
    const auto inside = at(7s + Duration{i * 1'234'567});
    const auto outside = clock.outside(inside);
    EXPECT_GE(clock.inside(outside), inside);
    EXPECT_LT(clock.inside(outside - 2ns), inside);
  }
  EXPECT_EQ(DeviceClock{}.inside(at(3ns)), at(3ns));
}

TEST(DeviceOnClock, AnswersSoonerIfItsClockIsFast) {
  constexpr std::array kQuery{std::byte{0xa5}, std::byte{0x71}, std::byte{0x8e}};
  const auto answered = [&](const DeviceClock& clock) {
    const auto device = put_on_clock(
        std::get<cli::OnStream>(test::device("demo").port).emulate({}, "").value(), clock);
    device->receive(at(10ms), kQuery);
    const auto next = device->next_event();
    device->clone()->advance_to(at(1s));
    device->advance_to(*next);
    EXPECT_EQ(device->sent().size(), 1U);
    return device->sent().front().time;
  };
  // It answers after a millisecond of its own.
  EXPECT_EQ(answered({}), at(11ms));
  EXPECT_EQ(answered({.begin = at(5s)}), at(11ms));
  EXPECT_EQ(answered({.rate = 2}), at(10500us));
  EXPECT_EQ(answered({.rate = 0.5}), at(12ms));
}

TEST(DeviceOnClock, IsLookedAtAsWell) {
  const auto& bus = std::get<cli::OnBus>(test::device("morap").port);
  const auto device = put_on_clock(bus.emulate({{"pen", "yes"}}, "").value(), {.rate = 1.01});
  EXPECT_EQ(device->observe(at(1ms), "servo"), 45);
  EXPECT_EQ(device->observe(at(1ms), "nothing"), std::nullopt);
}

}  // namespace
}  // namespace armjig
