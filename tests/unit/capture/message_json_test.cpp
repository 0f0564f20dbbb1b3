// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/message_json.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/wire/append_text.hpp"
#include "harness/wire/brief.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::hex;

constexpr std::array<NamedValue, 1> kNasty{{{1, "\"<\\\n"}}};
constexpr std::array<std::string_view, 8> kFlags{"a", "", "", "", "", "", "", "h"};
constexpr std::array kNastyFields{
    Field{"co\"de", 0, 1, Encoding::kCode, "", "", {}, kNasty},
    Field{"angle", 1, 4, Encoding::kFloatLittle, "\u00B0", ""},
    Field{"flags", 5, 1, Encoding::kBits, "", "", kFlags},
    Field{"no number", 1, 0, Encoding::kBits, "", "", kFlags, {}, 0, Place::kPiece},
};

/// What the library writes for the same object.
std::string by_the_library(const Message& message) {
  return message_object<nlohmann::ordered_json>(message).dump();
}

TEST(MessageJson, IsWhatALibraryWrites) {
  const Message telemetry{Direction::kFromDevice,
                          at(1234567ns),
                          "telemetry",
                          parol6::vectors::kRestTelemetry,
                          parol6::telemetry_fields(),
                          {}};
  EXPECT_EQ(to_json(telemetry), by_the_library(telemetry));
  const Message command{Direction::kToDevice,     at(-1ns), "command", parol6::vectors::kJogCommand,
                        parol6::command_fields(), {}};
  EXPECT_EQ(to_json(command), by_the_library(command));
}

TEST(MessageJson, KeepsQuotesControlsAndLetters) {
  const Message nasty{Direction::kToDevice,     at(1s),       "na\"me",
                      hex("01 00 00 C0 BF 81"), kNastyFields, {}};
  EXPECT_EQ(to_json(nasty), by_the_library(nasty));
  const Message noise{Direction::kToDevice, {}, "noise", hex("00 FF"), {}, "\x1B[2J \u00B0 \\"};
  EXPECT_EQ(to_json(noise), by_the_library(noise));
}

TEST(AppendText, AddsToWhatIsThere) {
  const Message message{Direction::kToDevice,     at(-1ns), "command", parol6::vectors::kJogCommand,
                        parol6::command_fields(), {}};
  std::string text{"7 "};
  append_line(text, message);
  EXPECT_EQ(text, "7 " + to_line(message));
  text = "x";
  append_number(text, std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(text, "x-9223372036854775808");
}

}  // namespace
}  // namespace armjig
