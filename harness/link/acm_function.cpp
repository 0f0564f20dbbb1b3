// SPDX-License-Identifier: Apache-2.0
#include "harness/link/acm_function.hpp"

namespace armjig {
namespace {

// Descriptors (USB 2.0, table 9-5; CDC 1.2, tables 12 and 13): a size, a kind, and what they say.
constexpr std::uint8_t kConfiguration = 2;
constexpr std::uint8_t kInterface = 4;
constexpr std::uint8_t kEndpoint = 5;
constexpr std::uint8_t kFunctional = 0x24;
constexpr std::uint8_t kAcmFunctional = 2;
constexpr std::uint8_t kUnionFunctional = 6;
constexpr std::uint8_t kCommunicationClass = 0x02;
constexpr std::uint8_t kAcmSubclass = 0x02;
constexpr std::uint8_t kDataClass = 0x0A;
constexpr unsigned kBulk = 2;

/// Follows the descriptors one by one.
class Search {
 public:
  /// The port, once it is whole.
  std::optional<AcmFunction> next(Bytes descriptor) noexcept {
    const auto at = [descriptor](std::size_t i) noexcept {
      return i < descriptor.size() ? std::to_integer<std::uint8_t>(descriptor[i]) : std::uint8_t{0};
    };
    switch (at(1)) {
      case kConfiguration:
        *this = {};
        found_.configuration = at(5);
        break;
      case kInterface:
        enter(at(2), at(5), at(6));
        break;
      case kFunctional:
        if (inside_ == Inside::kControl) note_functional(at(2), at(3), at(4));
        break;
      case kEndpoint:
        if (inside_ == Inside::kData && (at(3) & 3U) == kBulk) {
          note_endpoint(at(2), static_cast<std::uint16_t>(at(4) | at(5) << 8U));
        }
        break;
      default:
        break;
    }
    const bool is_whole = found_.bulk_in != 0 && found_.bulk_out != 0;
    return is_whole ? std::optional{found_} : std::nullopt;
  }

 private:
  enum class Inside : std::uint8_t { kOther, kControl, kData };

  void enter(std::uint8_t number, std::uint8_t main, std::uint8_t sub) noexcept {
    inside_ = Inside::kOther;
    if (main == kCommunicationClass && sub == kAcmSubclass) {
      found_ = {.configuration = found_.configuration, .control = number};
      has_control_ = true;
      union_.reset();
      inside_ = Inside::kControl;
    } else if (main == kDataClass && has_control_ && union_.value_or(number) == number) {
      found_.data = number;
      inside_ = Inside::kData;
    }
  }

  void note_functional(std::uint8_t kind, std::uint8_t first, std::uint8_t second) noexcept {
    constexpr unsigned kTakesLine = 2;
    if (kind == kAcmFunctional) found_.has_line = (first & kTakesLine) != 0;
    if (kind == kUnionFunctional) union_ = second;
  }

  void note_endpoint(std::uint8_t address, std::uint16_t packet_size) noexcept {
    constexpr unsigned kIn = 0x80;
    if ((address & kIn) == 0) {
      found_.bulk_out = address;
    } else {
      found_.bulk_in = address;
      found_.packet_size = packet_size;
    }
  }

  AcmFunction found_;
  std::optional<std::uint8_t> union_;  ///< the data interface, if it is said
  bool has_control_ = false;
  Inside inside_ = Inside::kOther;
};

}  // namespace

std::optional<AcmFunction> find_acm(Bytes descriptors) noexcept {
  Search search;
  while (descriptors.size() >= 2) {
    const auto size = std::to_integer<std::size_t>(descriptors[0]);
    if (size < 2 || size > descriptors.size()) break;
    if (auto found = search.next(descriptors.first(size))) return found;
    descriptors = descriptors.subspan(size);
  }
  return std::nullopt;
}

}  // namespace armjig
