// SPDX-License-Identifier: Apache-2.0
// Any bytes written to or read from a MORAP bus: the dissector gives every byte back.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fuzz/require.hpp"
#include "harness/wire/morap/dissector.hpp"

namespace armjig::fuzz {
namespace {

/// The input cut into transactions by length bytes.
void every_byte_is_dissected(Bytes data) {
  const auto dissector = morap::make_dissector();
  while (data.size() > 1) {
    const auto size = std::min<std::size_t>(std::to_integer<std::size_t>(data[0]), data.size() - 1);
    const auto transaction = data.subspan(1, size);
    std::vector<Message> messages;
    dissector->feed(Direction::kToDevice, {}, transaction, messages);
    std::size_t seen = 0;
    for (const auto& message : messages) {
      require(std::ranges::equal(message.raw, transaction.subspan(seen, message.raw.size())),
              "messages are the bytes in order");
      seen += message.raw.size();
    }
    require(seen == transaction.size(), "no byte is lost");
    data = data.subspan(1 + size);
  }
}

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::every_byte_is_dissected(std::as_bytes(std::span{data, size}));
  return 0;
}
