// SPDX-License-Identifier: Apache-2.0
// One MORAP message out of any bytes: what decodes encodes to the bytes that it was.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/require.hpp"
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

}  // namespace
}  // namespace armjig::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span{data, size});
  armjig::fuzz::command_comes_back(bytes);
  armjig::fuzz::set_comes_back(bytes);
  return 0;
}
