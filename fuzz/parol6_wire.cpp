// SPDX-License-Identifier: Apache-2.0
// One PAROL6 frame each way, out of any bytes: what decodes encodes to the bytes that it was, and
// what encodes decodes to the values that it was.
//
// Input: a body of a command, of which what is missing is 0, and the same bytes as one of
// telemetry.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/require.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::fuzz::parol6_frame {
namespace {

using namespace parol6;

template <std::size_t size>
std::array<std::byte, size> filled(Bytes data) {
  std::array<std::byte, size> body{};
  std::copy_n(data.begin(), std::min(size, data.size()), body.begin());
  return body;
}

void check_frames(Bytes data) {
  const auto asked = filled<kCommandBodySize>(data);
  const auto command = decode_command(asked);
  const auto command_bytes = encode(command);
  require(std::ranges::equal(body_of(command_bytes), asked), "encode(decode(x)) == x, a command");
  require(decode_command(body_of(command_bytes)) == command, "decode(encode(x)) == x, a command");
  const auto said = filled<kTelemetryBodySize>(data);
  const auto telemetry = decode_telemetry(said);
  const auto telemetry_bytes = encode(telemetry);
  require(std::ranges::equal(body_of(telemetry_bytes), said), "encode(decode(x)) == x, telemetry");
  require(decode_telemetry(body_of(telemetry_bytes)) == telemetry,
          "decode(encode(x)) == x, telemetry");
}

}  // namespace
}  // namespace armjig::fuzz::parol6_frame

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::parol6_frame::check_frames(std::as_bytes(std::span{data, size}));
  return 0;
}
