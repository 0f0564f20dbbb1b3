// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/dissection.hpp"

#include <fmt/core.h>

#include <cstddef>

#include "harness/wire/dissection_lua.hpp"

namespace armjig {
namespace {

std::string quoted(std::string_view text) {
  std::string out{'"'};
  for (const char one : text) {
    if (one == '"' || one == '\\') out += '\\';
    out += one;
  }
  return out + '"';
}

std::string_view type_of(const Field& field) {
  if (field.place == Place::kPiece) return "signed";
  switch (field.encoding) {
    case Encoding::kSigned:
      return "signed";
    case Encoding::kFloatLittle:
      return "float";
    default:
      return "unsigned";
  }
}

std::string lua_field(const Field& field) {
  auto text = fmt::format("    {{name = {}, offset = {}, width = {}, type = \"{}\"",
                          quoted(field.name), field.offset, field.width, type_of(field));
  if (field.encoding == Encoding::kUnsignedLittle || field.encoding == Encoding::kFloatLittle) {
    text += ", little = true";
  }
  if (!field.unit.empty()) text += fmt::format(", unit = {}", quoted(field.unit));
  if (field.encoding == Encoding::kLiteral) {
    text += ", literal = {";
    for (int i = field.width; i-- > 0;) text += fmt::format("{},", field.literal >> 8 * i & 0xFF);
    text += '}';
  }
  if (!field.values.empty()) {
    text += ", names = {";
    for (const auto& named : field.values) {
      text += fmt::format("[{}] = {}, ", named.value, quoted(named.name));
    }
    text += '}';
  }
  if (!field.bits.empty()) {
    text += ", bits = {";
    for (std::size_t i = 0; i < field.bits.size(); ++i) {
      if (field.bits[i].empty()) continue;
      text += fmt::format("{{name = {}, bit = {}}}, ", quoted(field.bits[i]), 7 - i);
    }
    text += '}';
  }
  return text + "},\n";
}

void append_text(std::string& out, std::string_view name, std::string_view text) {
  if (!text.empty()) out += fmt::format(", {} = {}", name, quoted(text));
}

std::string lua_kind(const MessageKind& kind) {
  auto text = fmt::format("messages[#messages + 1] = {{\n  name = {}, from_device = {}",
                          quoted(kind.name), kind.direction == Direction::kFromDevice);
  const auto& bus = kind.on_bus;
  if (bus.address) text += fmt::format(", address = {}", *bus.address);
  if (bus.key) text += fmt::format(", key = {}", *bus.key);
  if (bus.is_alone) text += ", is_alone = true";
  if (bus.is_choice) text += ", is_choice = true";
  if (bus.begin > 0) text += fmt::format(", begin = {}", bus.begin);
  append_text(text, "bad_word", kind.bad_word);
  append_text(text, "cut_short", bus.cut_short);
  append_text(text, "too_many", bus.too_many);
  append_text(text, "surplus", bus.surplus);
  text += ",\n  fields = {\n";
  for (const auto& field : kind.fields) text += lua_field(field);
  return text + "  }}\n";
}

std::string lua_lines(const LineWords& lines) {
  auto text = fmt::format("local longest = {}\nlocal words = {{is_there = true", lines.longest);
  append_text(text, "empty", lines.empty);
  append_text(text, "unknown_word", lines.unknown_word);
  append_text(text, "argument_count", lines.argument_count);
  append_text(text, "not_a_number", lines.not_a_number);
  append_text(text, "too_large", lines.too_large);
  append_text(text, "no_return", lines.no_return);
  append_text(text, "too_long", lines.too_long);
  return text + "}\n";
}

}  // namespace

std::string lua_dissector(std::string_view device, std::string_view title,
                          const Dissection& dissection, DissectedLinks links) {
  auto text = fmt::format(
      "-- Made by 'armjig wireshark dissector {0}' of the device's field lists.\n"
      "local device, title = {1}, {2}\n"
      "local check = {3}\n"
      "local messages = {{}}\n",
      device, quoted(device), quoted(title),
      dissection.check.empty() ? "function() return nil end" : dissection.check);
  for (const auto& kind : dissection.messages) text += lua_kind(kind);
  switch (dissection.framing) {
    case Framing::kSizes:
      text.append(lua::kFields).append(lua::kCutSizes);
      break;
    case Framing::kLines:
      text.append(lua_lines(dissection.lines)).append(lua::kFields).append(lua::kCutLines);
      break;
    case Framing::kTransactions:
      text += fmt::format("local first_choice = {}\n", dissection.first_choice);
      text.append(lua::kFields).append(lua::kCutTransactions);
      break;
  }
  text.append(lua::kShow).append(lua::kOwn);
  if (links.tcp_port != 0)
    text.append(fmt::format("\nlocal tcp_port = {}", links.tcp_port)).append(lua::kTcp);
  // Only messages of fixed sizes have a mark to be found by.
  if (links.usb_product != 0 && dissection.framing == Framing::kSizes) {
    text.append(fmt::format("\nlocal usb_product = {}", links.usb_product)).append(lua::kUsb);
  }
  if (dissection.framing == Framing::kTransactions) text += lua::kBus;
  return text;
}

}  // namespace armjig
