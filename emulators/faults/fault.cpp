// SPDX-License-Identifier: Apache-2.0
#include "emulators/faults/fault.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "harness/core/nearest.hpp"

namespace armjig {
namespace {

/// What stands behind the colon.
enum class Argument : std::uint8_t { kNone, kField, kTwoFields, kBit };

struct Form {
  std::string_view name;
  Fault::Kind kind;
  Argument argument;
};
constexpr std::array kForms{
    Form{"zero", Fault::Kind::kZero, Argument::kField},
    Form{"stuck", Fault::Kind::kStuck, Argument::kField},
    Form{"stale", Fault::Kind::kStale, Argument::kField},
    Form{"off-by-one", Fault::Kind::kOffByOne, Argument::kField},
    Form{"doubled", Fault::Kind::kDoubled, Argument::kField},
    Form{"negated", Fault::Kind::kNegated, Argument::kField},
    Form{"swap-bytes", Fault::Kind::kSwapBytes, Argument::kField},
    Form{"reverse-bits", Fault::Kind::kReverseBits, Argument::kField},
    Form{"swapped", Fault::Kind::kSwapped, Argument::kTwoFields},
    Form{"bit-low", Fault::Kind::kBitLow, Argument::kBit},
    Form{"bit-high", Fault::Kind::kBitHigh, Argument::kBit},
    Form{"late", Fault::Kind::kLate, Argument::kNone},
    Form{"missing", Fault::Kind::kMissing, Argument::kNone},
    Form{"twice", Fault::Kind::kTwice, Argument::kNone},
    Form{"unasked", Fault::Kind::kUnasked, Argument::kNone},
    Form{"cut-short", Fault::Kind::kCutShort, Argument::kNone},
    Form{"loses-splits", Fault::Kind::kLosesSplits, Argument::kNone},
};

constexpr std::string_view form_of(Argument argument) noexcept {
  constexpr std::array<std::string_view, 4> kWords{"", ":FIELD", ":FIELD+FIELD", ":FIELD.BIT"};
  return kWords[static_cast<std::size_t>(argument)];
}

std::byte reversed(std::byte byte) noexcept {
  unsigned out = 0;
  for (unsigned bit = 0; bit < 8; ++bit) {
    out |= (std::to_integer<unsigned>(byte) >> bit & 1U) << (7 - bit);
  }
  return static_cast<std::byte>(out);
}

bool fits(const Field& field, std::span<const std::byte> message) noexcept {
  return std::size_t{field.offset} + field.width <= message.size();
}

/// Fills in what the argument names. False: it names nothing.
bool read_argument(Fault& fault, Argument argument, std::string_view text,
                   std::span<const Field> fields) {
  switch (argument) {
    case Argument::kNone:
      return text.empty();
    case Argument::kField:
      fault.field = find_field(fields, text);
      return fault.field != nullptr;
    case Argument::kTwoFields: {
      const auto plus = text.find('+');
      if (plus == std::string_view::npos) return false;
      fault.field = find_field(fields, text.substr(0, plus));
      fault.other = find_field(fields, text.substr(plus + 1));
      return fault.field != nullptr && fault.other != nullptr &&
             fault.field->width == fault.other->width;
    }
    case Argument::kBit:
      break;
  }
  const auto dot = text.rfind('.');
  if (dot == std::string_view::npos || dot + 2 != text.size()) return false;
  fault.field = find_field(fields, text.substr(0, dot));
  fault.bit = static_cast<std::uint8_t>(text.back() - '0');
  return fault.field != nullptr && fault.bit < 8;
}

}  // namespace

std::string fault_forms() {
  std::string forms;
  for (const auto& form : kForms) {
    if (!forms.empty()) forms += ", ";
    forms.append(form.name).append(form_of(form.argument));
  }
  return forms;
}

Outcome<Fault> parse_fault(std::string_view text, std::span<const Field> fields) {
  const auto where = "fault '" + std::string{text} + "'";
  const auto colon = text.find(':');
  const auto form = std::ranges::find(kForms, text.substr(0, colon), &Form::name);
  if (form == kForms.end()) {
    return problem(
        ErrorCode::kBadValue, where,
        did_you_mean(text.substr(0, colon), kForms, &Form::name) + "known: " + fault_forms());
  }
  Fault fault{.kind = form->kind};
  const bool has_argument = colon != std::string_view::npos;
  if (has_argument != (form->argument != Argument::kNone)) {
    return problem(ErrorCode::kBadValue, where, "known: " + fault_forms());
  }
  const auto argument = has_argument ? text.substr(colon + 1) : std::string_view{};
  if (read_argument(fault, form->argument, argument, fields)) return fault;
  std::string names;
  for (const auto& field : fields) names += ' ' + std::string{field.name};
  return problem(ErrorCode::kBadValue, where,
                 did_you_mean(argument, fields, &Field::name) + "fields:" + names);
}

std::string to_string(const Fault& fault) {
  const auto form = std::ranges::find(kForms, fault.kind, &Form::kind);
  std::string text{form->name};
  if (fault.field == nullptr) return text;
  text.append(":").append(fault.field->name);
  if (form->argument == Argument::kTwoFields) text.append("+").append(fault.other->name);
  if (form->argument == Argument::kBit) text.append(".").append(std::to_string(fault.bit));
  return text;
}

void apply_fault(const Fault& fault, std::span<std::byte> message,
                 std::optional<std::int64_t>& memory) noexcept {
  if (!fault.is_about_field() || !fits(*fault.field, message)) return;
  const auto& field = *fault.field;
  const auto bytes = message.subspan(field.offset, field.width);
  const auto value = field_value(field, message);
  const auto set = [&](std::int64_t changed) { set_field_value(field, message, changed); };
  switch (fault.kind) {
    case Fault::Kind::kZero:
      set(0);
      break;
    case Fault::Kind::kStuck:
      if (!memory) memory = value;
      set(*memory);
      break;
    case Fault::Kind::kStale:
      set(std::exchange(memory, value).value_or(value));
      break;
    case Fault::Kind::kOffByOne:
      set(value + 1);
      break;
    case Fault::Kind::kDoubled:
      set(value * 2);
      break;
    case Fault::Kind::kNegated:
      set(-value);
      break;
    case Fault::Kind::kSwapBytes:
      std::ranges::reverse(bytes);
      break;
    case Fault::Kind::kReverseBits:
      std::ranges::transform(bytes, bytes.begin(), reversed);
      break;
    case Fault::Kind::kSwapped:
      if (!fits(*fault.other, message)) break;
      std::ranges::swap_ranges(bytes, message.subspan(fault.other->offset, fault.other->width));
      break;
    case Fault::Kind::kBitLow:
      set(value & ~(std::int64_t{1} << fault.bit));
      break;
    case Fault::Kind::kBitHigh:
      set(value | std::int64_t{1} << fault.bit);
      break;
    default:
      break;
  }
}

}  // namespace armjig
