// SPDX-License-Identifier: Apache-2.0
// Prints a dictionary for libFuzzer and AFL++: what the field lists of the devices named say that
// bytes or words may be, and the words of the seeds that are text.
//
//   dictionary [parol6|morap|kinovazed]... [SEED...]
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "harness/wire/parol6/dissector.hpp"

namespace armjig::fuzz {
namespace {

using Words = std::set<std::string>;

struct NamedDissection {
  std::string_view device;
  Dissection (*dissection)();
};
constexpr std::array kDissections{NamedDissection{"kinovazed", kinovazed::dissection},
                                  NamedDissection{"morap", morap::dissection},
                                  NamedDissection{"parol6", parol6::dissection}};

std::string bytes_of(const Field& field, std::int64_t value) {
  std::vector<std::byte> message(std::size_t{field.offset} + field.width);
  set_field_value(field, message, value);
  return std::string{as_text(Bytes{message}.subspan(field.offset))};
}

void add_field(const Field& field, Words& words) {
  if (field.place == Place::kPiece) {
    for (const auto& value : field.values) words.insert(std::string{value.name});
    return;
  }
  if (field.encoding == Encoding::kLiteral) words.insert(bytes_of(field, field.literal));
  for (const auto& value : field.values) words.insert(bytes_of(field, value.value));
}

void add_device(const Dissection& dissection, Words& words) {
  for (const auto& kind : dissection.messages) {
    if (dissection.framing == Framing::kLines) words.insert(std::string{kind.name});
    if (kind.on_bus.key) words.insert(std::string(1, static_cast<char>(*kind.on_bus.key)));
    for (const auto& field : kind.fields) add_field(field, words);
  }
  if (dissection.framing == Framing::kLines) words.insert("\r\n");
}

/// Runs of letters, which a text consists of, and other files by chance.
void add_seed(const std::string& path, Words& words) {
  constexpr std::size_t kShortest = 3;
  constexpr std::size_t kLongest = 24;
  std::ifstream in{path, std::ios::binary};
  const std::string seed{std::istreambuf_iterator<char>{in}, {}};
  const auto is_letter = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  };
  for (auto at = seed.begin(); at != seed.end();) {
    at = std::find_if(at, seed.end(), is_letter);
    const auto end = std::find_if_not(at, seed.end(), is_letter);
    const auto size = static_cast<std::size_t>(end - at);
    if (size >= kShortest && size <= kLongest) words.emplace(at, end);
    at = end;
  }
}

void print(const Words& words) {
  for (const auto& word : words) {
    if (word.empty()) continue;
    std::string escaped;
    for (const char letter : word) {
      const auto c = static_cast<unsigned char>(letter);
      const bool is_plain = std::isprint(c) != 0 && c != '"' && c != '\\';
      escaped += is_plain ? std::string(1, letter) : fmt::format("\\x{:02x}", c);
    }
    fmt::print("\"{}\"\n", escaped);
  }
}

}  // namespace
}  // namespace armjig::fuzz

int main(int argc, char** argv) {
  using namespace armjig::fuzz;
  Words words;
  for (const std::string argument : std::span{argv, static_cast<std::size_t>(argc)}.subspan(1)) {
    const auto device =
        std::ranges::find(kDissections, std::string_view{argument}, &NamedDissection::device);
    device != kDissections.end() ? add_device(device->dissection(), words)
                                 : add_seed(argument, words);
  }
  print(words);
  return 0;
}
