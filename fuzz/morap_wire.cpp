// SPDX-License-Identifier: Apache-2.0
// Any bytes written to or read from a MORAP bus: what decodes encodes to the bytes that it was, and
// the dissector gives every byte back.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fuzz/require.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::fuzz {
namespace {

void command_comes_back(Bytes data) {
  const auto result = morap::decode_command(data);
  const auto* decoded = std::get_if<morap::DecodedCommand>(&result);
  if (decoded == nullptr) return;
  const auto encoded = morap::encode(decoded->command);
  require(decoded->size <= data.size(), "a command is no longer than its bytes");
  require(std::ranges::equal(encoded.view(), data.first(decoded->size)),
          "encode(decode(x)) == x, a command");
}

void set_comes_back(Bytes data) {
  const auto result = morap::decode_set(data);
  const auto* set = std::get_if<morap::ControllerSet>(&result);
  if (set == nullptr) return;
  require(std::ranges::equal(morap::encode(*set).view(), data.first(morap::wire_size(*set))),
          "encode(decode(x)) == x, a set");
}

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

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span{data, size});
  armjig::fuzz::command_comes_back(bytes);
  armjig::fuzz::set_comes_back(bytes);
  armjig::fuzz::every_byte_is_dissected(bytes);
  return 0;
}
