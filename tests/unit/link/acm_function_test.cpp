// SPDX-License-Identifier: Apache-2.0
#include "harness/link/acm_function.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "emulators/usb/cdc_acm.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

// A device and its configuration, with a storage before the port and a port whose data are two
// interfaces further: 9 bytes for each interface, 7 for each endpoint.
constexpr auto kComposite =
    "12 01 00 02 EF 02 01 40 83 04 40 57 00 01 01 02 03 01 "
    "09 02 00 00 04 02 00 80 32 "
    "09 04 00 00 02 08 06 50 00 "                   // storage
    "07 05 01 02 40 00 00  07 05 81 02 40 00 00 "   //
    "09 04 01 00 01 02 02 01 00 "                   // the port
    "05 24 00 10 01  04 24 02 02  05 24 06 01 03 "  // its data are interface 3
    "07 05 82 03 08 00 10 "                         //
    "09 04 02 00 02 0A 00 00 00 "                   // data of something else
    "07 05 03 02 40 00 00  07 05 83 02 40 00 00 "   //
    "09 04 03 00 02 0A 00 00 00 "                   //
    "07 05 04 02 00 02 00  07 05 84 02 00 02 00 ";  // at high speed

std::vector<std::byte> descriptors_of(const usb::Description& description) {
  auto bytes = usb::device_descriptor(description);
  const auto rest = usb::configuration_descriptor(description);
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

TEST(AcmFunction, IsThatOfAnEmulatedBoard) {
  const usb::CdcAcm board{{}, {}};
  const auto found = find_acm(descriptors_of(board.description()));
  EXPECT_EQ(found, (AcmFunction{.configuration = 1,
                                .control = 0,
                                .data = 1,
                                .bulk_in = usb::CdcAcm::kBulkIn,
                                .bulk_out = usb::CdcAcm::kBulkOut,
                                .packet_size = 64,
                                .has_line = true}));
}

TEST(AcmFunction, IsTheOneWhoseInterfacesBelongTogether) {
  const auto found = find_acm(from_hex(kComposite).value());
  EXPECT_EQ(found, (AcmFunction{.configuration = 2,
                                .control = 1,
                                .data = 3,
                                .bulk_in = 0x84,
                                .bulk_out = 0x04,
                                .packet_size = 512,
                                .has_line = true}));
}

TEST(AcmFunction, MayTakeNoLine) {
  auto bytes = from_hex(kComposite).value();
  constexpr std::size_t kCapabilities = 18 + 9 + 9 + 14 + 9 + 5 + 3;
  bytes.at(kCapabilities) = std::byte{0};
  ASSERT_TRUE(find_acm(bytes));
  EXPECT_FALSE(find_acm(bytes)->has_line);
}

TEST(AcmFunction, IsNotThereUnlessItIsWhole) {
  const auto bytes = from_hex(kComposite).value();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(find_acm(Bytes{bytes}.first(size))) << size;
  }
}

TEST(AcmFunction, NoDescriptorCanHangTheSearch) {
  auto bytes = from_hex(kComposite).value();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const auto value : {0x00, 0x01, 0x7F, 0xFF}) {
      auto broken = bytes;
      broken[i] = static_cast<std::byte>(value);
      (void)find_acm(broken);
    }
  }
}

TEST(AcmFunction, AnotherDeviceHasNone) {
  EXPECT_FALSE(find_acm(from_hex("12 01 00 02 FF 00 00 08 03 04 31 C6 05 02 01 02 03 01 "
                                 "09 02 12 00 01 01 00 80 32  09 04 00 00 00 FF 00 00 00")
                            .value()));
}

}  // namespace
}  // namespace armjig
