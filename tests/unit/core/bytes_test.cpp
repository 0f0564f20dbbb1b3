// SPDX-License-Identifier: Apache-2.0
#include "harness/core/bytes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace armjig {
namespace {

template <class... Numbers>
constexpr std::array<std::byte, sizeof...(Numbers)> bytes(Numbers... numbers) {
  return {static_cast<std::byte>(numbers)...};
}

struct Signed24 {
  std::int32_t value;
  std::array<std::byte, 3> bytes;
};
// F1
constexpr std::array kSigned24{
    Signed24{0, bytes(0x00, 0x00, 0x00)},        Signed24{1, bytes(0x00, 0x00, 0x01)},
    Signed24{-1, bytes(0xFF, 0xFF, 0xFF)},       Signed24{255, bytes(0x00, 0x00, 0xFF)},
    Signed24{256, bytes(0x00, 0x01, 0x00)},      Signed24{-256, bytes(0xFF, 0xFF, 0x00)},
    Signed24{10240, bytes(0x00, 0x28, 0x00)},    Signed24{-32000, bytes(0xFF, 0x83, 0x00)},
    Signed24{57905, bytes(0x00, 0xE2, 0x31)},    Signed24{65536, bytes(0x01, 0x00, 0x00)},
    Signed24{-65536, bytes(0xFF, 0x00, 0x00)},   Signed24{8388607, bytes(0x7F, 0xFF, 0xFF)},
    Signed24{-8388608, bytes(0x80, 0x00, 0x00)},
};

TEST(Bytes, StoresSigned24BitNumbersBigEndian) {
  for (const auto& [value, expected] : kSigned24) {
    std::array<std::byte, 3> actual{};
    store_i24_be(actual, value);
    EXPECT_EQ(actual, expected) << value;
  }
}

TEST(Bytes, LoadsSigned24BitNumbersBigEndian) {
  for (const auto& [value, stored] : kSigned24) EXPECT_EQ(load_i24_be(stored), value);
}

TEST(Bytes, WrapsWhatDoesNotFitIn24Bits) {
  // F1
  constexpr std::array kWrapped{Signed24{8388608, bytes(0x80, 0x00, 0x00)},
                                Signed24{-8388609, bytes(0x7F, 0xFF, 0xFF)},
                                Signed24{16777216, bytes(0x00, 0x00, 0x00)}};
  for (const auto& [value, expected] : kWrapped) {
    std::array<std::byte, 3> actual{};
    store_i24_be(actual, value);
    EXPECT_EQ(actual, expected) << value;
  }
  EXPECT_EQ(load_i24_be(bytes(0x80, 0x00, 0x00)), -8388608);
}

struct Signed16 {
  std::int16_t value;
  std::array<std::byte, 2> bytes;
};

TEST(Bytes, StoresAndLoadsSigned16BitNumbersBigEndian) {
  // F2
  constexpr std::array kSigned16{
      Signed16{300, bytes(0x01, 0x2C)},  Signed16{500, bytes(0x01, 0xF4)},
      Signed16{1300, bytes(0x05, 0x14)}, Signed16{-1, bytes(0xFF, 0xFF)},
      Signed16{-200, bytes(0xFF, 0x38)}, Signed16{-32768, bytes(0x80, 0x00)},
  };
  for (const auto& [value, expected] : kSigned16) {
    std::array<std::byte, 2> actual{};
    store_i16_be(actual, value);
    EXPECT_EQ(actual, expected) << value;
    EXPECT_EQ(load_i16_be(expected), value);
  }
}

TEST(Bytes, StoresAndLoadsUnsigned16BitNumbersBigEndian) {
  std::array<std::byte, 2> actual{};
  store_u16_be(actual, 0xBA95);  // B1: 47765
  EXPECT_EQ(actual, bytes(0xBA, 0x95));
  EXPECT_EQ(load_u16_be(actual), 47765);
}

TEST(Bytes, CutsASliceOfFixedSize) {
  constexpr auto kFour = bytes(0x01, 0x02, 0x03, 0x04);
  const auto middle = slice<2>(kFour, 1);
  EXPECT_EQ(middle[0], std::byte{0x02});
  EXPECT_EQ(middle[1], std::byte{0x03});
}

}  // namespace
}  // namespace armjig
