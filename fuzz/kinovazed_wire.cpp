// SPDX-License-Identifier: Apache-2.0
// One KinovaZED line each way, out of any text: what is read can be written, and is read again as
// the same; whatever a documented server takes, the shipped one takes as the same, too.
//
// Input: a line without its LF.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/require.hpp"
#include "harness/wire/kinovazed/line.hpp"

namespace armjig::fuzz::kinovazed_line {
namespace {

using namespace kinovazed;

/// Lines are read without their LF.
std::string_view without_lf(std::string_view line) {
  require(line.ends_with("\r\n"), "a line ends with CR LF");
  return line.substr(0, line.size() - 1);
}

void check_line(std::string_view line) {
  const auto forgiven = decode_command(line, kinovazed::Profile::kFirmware);
  if (const auto strict = decode_command(line, kinovazed::Profile::kDocumented)) {
    require(forgiven && *forgiven == *strict, "the shipped server takes what the document allows");
  }
  if (forgiven) {
    const auto text = encode(*forgiven);
    const auto again = decode_command(without_lf(text.view()), kinovazed::Profile::kFirmware);
    require(again && *again == *forgiven, "decode(encode(x)) == x, a command");
  }
  if (const auto message = decode_message(line)) {
    const auto text = encode(*message);
    const auto again = decode_message(without_lf(text.view()));
    require(again && *again == *message, "decode(encode(x)) == x, a message");
  }
}

}  // namespace
}  // namespace armjig::fuzz::kinovazed_line

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::kinovazed_line::check_line({reinterpret_cast<const char*>(data), size});
  return 0;
}
