// SPDX-License-Identifier: Apache-2.0
// One MORAP message out of any bytes: what decodes encodes to the bytes that it was; and what a pen
// makes of them is within its range.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/require.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

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

/// Each identifier is of one sort, and its payload is the one of its sort.
void sorts_agree(std::uint8_t byte) {
  using namespace morap;
  const CommandId id{byte};
  const auto* const info = find_command(id);
  require(is_known(id) == (info != nullptr || find_reading(id) != nullptr), "it is known or not");
  require(is_reference(id) + is_calibration(id) + is_programming(id) <= 1, "it is of one sort");
  require(!has_number(id) || (info != nullptr && info->payload == Payload::kFloat) || !is_known(id),
          "a number follows it");
  const TuneKind kind{byte};
  const auto* const reading = find_reading(selector_of(kind_of(kind)));
  require(reading != nullptr && reading->kind == ReadKind::kControllerSet,
          "what is tuned can be read");
  require(is_node_address(byte) == (node_of(byte) < kLastNode), "a node has an address");
  require(byte >= kLastNode || node_of(node_address(byte)) == byte,
          "node_of(node_address(x)) == x");
}

void pen_moves_within_its_range(Bytes data) {
  if (data.empty()) return;
  const auto degrees = morap::pen::servo_degrees(data);
  require(degrees >= morap::pen::kDeployedDegrees && degrees <= morap::pen::kRetractedDegrees,
          "the pen stays within its range");
  const morap::pen::Command command{morap::pen::CommandId{std::to_integer<std::uint8_t>(data[0])},
                                    std::to_integer<std::uint8_t>(data.back())};
  const auto encoded = morap::pen::encode(command);
  require(
      command.id != morap::pen::CommandId::kSetPosition ||
          morap::pen::servo_degrees(encoded.view()) == morap::pen::servo_degrees(command.position),
      "what is encoded asks for the same angle");
}

}  // namespace
}  // namespace armjig::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span{data, size});
  armjig::fuzz::command_comes_back(bytes);
  armjig::fuzz::set_comes_back(bytes);
  if (size > 0) armjig::fuzz::sorts_agree(data[0]);
  armjig::fuzz::pen_moves_within_its_range(bytes);
  return 0;
}
