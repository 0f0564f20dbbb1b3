// SPDX-License-Identifier: Apache-2.0
// The device's side of usbredir against the library's other side, in memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "emulators/host/usb_wire.hpp"
#include "tests/unit/host/usbredir_guest.hpp"
#include "tests/unit/usb/plugged.hpp"

namespace armjig {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;
using usb::CdcAcm;
using usb::Plugged;

/// A board and a virtual machine.
class Redirected {
 public:
  explicit Redirected(Cable cable = Cable::kIn) : wire{make_usbredir_wire(board.device, cable)} {}

  /// Whether the wire still wants to hear of the guest.
  bool settle() {
    bool is_sound = true;
    while (is_sound && !(guest.outgoing.empty() && wire->outgoing().empty())) {
      const auto to_host = std::exchange(guest.outgoing, {});
      for (std::size_t i = 0; i < to_host.size() && is_sound; i += step) {
        is_sound =
            wire->receive(Instant{}, Bytes{to_host}.subspan(i, std::min(step, to_host.size() - i)));
      }
      tell();
      const auto to_guest = std::exchange(wire->outgoing(), {});
      EXPECT_TRUE(guest.receive(to_guest));
    }
    return is_sound;
  }
  void tell() {
    while (const auto end = board.device.next(Instant{})) wire->tell(*end);
  }
  void bring_up() {
    settle();
    guest.reset();
    guest.configure(1, 1);
    guest.control(2, {0x21, 0x22, 3, 0, 0});
    settle();
  }
  void say(const std::string& hex) {
    board.say(hex);
    tell();
    settle();
  }

  std::size_t step = 1'000'000;  ///< bytes at a time
  Plugged board{Plugged::Configured::kNo};
  std::unique_ptr<UsbWire> wire;
  UsbredirGuest guest;
};

TEST(UsbredirWire, PresentsTheDevice) {
  Redirected redirected;
  redirected.settle();
  const auto& guest = redirected.guest;
  EXPECT_EQ(guest.connections, 1);
  EXPECT_EQ(guest.device.vendor_id, 0x0483);
  EXPECT_EQ(guest.device.product_id, 0x5740);
  EXPECT_EQ(guest.device.speed, usb_redir_speed_full);
  EXPECT_EQ(guest.interfaces.interface_count, 2U);
  EXPECT_EQ(guest.interfaces.interface_class[1], 0x0A);
  EXPECT_EQ(guest.endpoints.type[1], usb_redir_type_bulk);       // 0x01
  EXPECT_EQ(guest.endpoints.type[16 + 1], usb_redir_type_bulk);  // 0x81
  EXPECT_EQ(guest.endpoints.type[16 + 2], usb_redir_type_interrupt);
  EXPECT_EQ(guest.endpoints.max_packet_size[16 + 1], 64);
}

TEST(UsbredirWire, CarriesBytesBothWaysHoweverTheyAreCut) {
  for (const std::size_t step : {std::size_t{1}, std::size_t{7}, std::size_t{1'000'000}}) {
    Redirected redirected;
    redirected.step = step;
    redirected.bring_up();
    redirected.guest.bulk(10, CdcAcm::kBulkOut, 3, "010203");
    redirected.guest.bulk(11, CdcAcm::kBulkIn, 128);
    EXPECT_TRUE(redirected.settle());
    EXPECT_EQ(redirected.board.heard, "010203");
    EXPECT_EQ(redirected.guest.answer(10).status, usb_redir_success);
    EXPECT_EQ(redirected.guest.answer(10).length, 3U);
    redirected.say("aabb");
    EXPECT_EQ(redirected.guest.answer(11).data, "aabb");
  }
}

TEST(UsbredirWire, AnswersARequestThatStalls) {
  Redirected redirected;
  redirected.bring_up();
  redirected.guest.control(20, {0x80, 6, 0x0600, 0, 10});
  redirected.settle();
  EXPECT_EQ(redirected.guest.answer(20).status, usb_redir_stall);
}

TEST(UsbredirWire, AnswersWhatIsCancelledOnce) {
  Redirected redirected;
  redirected.bring_up();
  redirected.guest.bulk(30, CdcAcm::kBulkIn, 64);
  redirected.guest.cancel(30);
  redirected.guest.cancel(30);
  redirected.settle();
  redirected.guest.bulk(31, CdcAcm::kBulkIn, 64);
  redirected.settle();
  redirected.say("cc");
  EXPECT_EQ(redirected.guest.answer(30).status, usb_redir_cancelled);
  EXPECT_EQ(redirected.guest.answer(31).data, "cc");
}

TEST(UsbredirWire, EndsWhatWaitsWhenTheBusIsReset) {
  Redirected redirected;
  redirected.bring_up();
  redirected.guest.bulk(32, CdcAcm::kBulkIn, 64);
  redirected.guest.reset();
  redirected.settle();
  EXPECT_EQ(redirected.guest.answer(32).status, usb_redir_cancelled);
  EXPECT_EQ(redirected.board.device.configuration(), 0);
}

TEST(UsbredirWire, SendsInterruptsAsTheyHappen) {
  Redirected redirected;
  redirected.settle();
  redirected.guest.configure(1, 1);
  redirected.guest.start_interrupts(40, CdcAcm::kNotifications);
  redirected.guest.control(41, {0x21, 0x22, 3, 0, 0});
  redirected.settle();
  redirected.guest.control(42, {0x21, 0x22, 0, 0, 0});
  redirected.settle();
  EXPECT_EQ(redirected.guest.answer(40).status, usb_redir_success);
  EXPECT_THAT(redirected.guest.interrupts,
              ElementsAre("a1200000000002000300", "a1200000000002000000"));
}

TEST(UsbredirWire, RefusesEndpointsOfOtherKinds) {
  Redirected redirected;
  redirected.bring_up();
  redirected.guest.start_interrupts(50, CdcAcm::kBulkIn);
  redirected.guest.bulk(51, CdcAcm::kNotifications, 16);
  redirected.guest.bulk(52, 0x85, 16);
  EXPECT_TRUE(redirected.settle());
  for (const std::uint64_t id : {50U, 51U, 52U}) {
    EXPECT_EQ(redirected.guest.answer(id).status, usb_redir_inval) << id;
  }
}

TEST(UsbredirWire, ComesAgainAfterItWasPulledOut) {
  Redirected redirected;
  redirected.bring_up();
  redirected.guest.bulk(60, CdcAcm::kBulkIn, 64);
  redirected.settle();
  redirected.board.device.unplug(Instant{});
  EXPECT_TRUE(redirected.wire->set_cable(Cable::kOut));
  EXPECT_TRUE(redirected.wire->set_cable(Cable::kIn));
  redirected.guest.bulk(61, CdcAcm::kBulkIn, 64);  // sent before it has heard of that
  redirected.settle();
  EXPECT_EQ(redirected.guest.disconnections, 1);
  EXPECT_EQ(redirected.guest.connections, 2);
  EXPECT_EQ(redirected.guest.answers.count(61), 0U);
  redirected.bring_up();
  EXPECT_EQ(redirected.board.device.configuration(), 1);
}

TEST(UsbredirWire, ADeviceWithoutACableIsPresentedWhenItIsPluggedIn) {
  Redirected redirected{Cable::kOut};
  redirected.settle();
  EXPECT_EQ(redirected.guest.connections, 0);
  EXPECT_TRUE(redirected.wire->set_cable(Cable::kIn));
  redirected.settle();
  EXPECT_EQ(redirected.guest.connections, 1);
}

TEST(UsbredirWire, SurvivesBeingPulledOutAtAnyMoment) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 dice{seed};
    Redirected redirected;
    redirected.step = 1 + dice() % 40;
    redirected.bring_up();
    std::uint64_t id = 1000;
    for (int i = 0; i < 40; ++i) {
      redirected.guest.bulk(++id, CdcAcm::kBulkIn, 64);
      redirected.guest.bulk(++id, CdcAcm::kBulkOut, 2, "0102");
      if (dice() % 3 != 0) redirected.settle();
      (void)redirected.board.port.send(std::vector<std::byte>(1 + dice() % 100));
      redirected.board.device.advance();
      if (dice() % 4 == 0) {
        redirected.board.device.unplug(Instant{});
        EXPECT_TRUE(redirected.wire->set_cable(Cable::kOut));
        EXPECT_TRUE(redirected.wire->set_cable(Cable::kIn));
        if (dice() % 2 == 0) redirected.bring_up();
      }
      redirected.tell();
    }
    EXPECT_TRUE(redirected.settle()) << "seed " << seed;
    for (const auto& [number, answers] : redirected.guest.answers) {
      if (number < 1000) continue;
      EXPECT_THAT(answers, SizeIs(1)) << "seed " << seed << " id " << number;
    }
  }
}

TEST(UsbredirWire, LetsGoWhoDoesNotSpeakTheProtocol) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 dice{seed};
    Redirected redirected;
    redirected.settle();
    std::vector<std::byte> noise(4096);
    for (auto& byte : noise) byte = static_cast<std::byte>(dice());
    EXPECT_FALSE(redirected.wire->receive(Instant{}, noise)) << "seed " << seed;
  }
}

TEST(UsbredirWire, LetsGoWhoSendsAPacketWithoutEnd) {
  Redirected redirected;
  redirected.bring_up();
  // A bulk packet (101) that says it has 64 MiB; its identifier has 64 bits.
  const auto head = from_hex(
                        "65000000"
                        "00000004"
                        "0100000000000000")
                        .value();
  ASSERT_TRUE(redirected.wire->receive(Instant{}, head));
  const std::vector<std::byte> more(std::size_t{1} << 19U);
  EXPECT_TRUE(redirected.wire->receive(Instant{}, more));
  EXPECT_FALSE(redirected.wire->receive(Instant{}, more) &&
               redirected.wire->receive(Instant{}, more));
}

}  // namespace
}  // namespace armjig
