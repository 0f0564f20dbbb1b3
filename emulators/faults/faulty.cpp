// SPDX-License-Identifier: Apache-2.0
#include "emulators/faults/faulty.hpp"

#include <array>

namespace armjig {
namespace {

struct KindName {
  std::string_view name;
  Fault::Kind kind;
};
constexpr std::array kKinds{
    KindName{"zero", Fault::Kind::kZero},
    KindName{"stuck", Fault::Kind::kStuck},
    KindName{"off-by-one", Fault::Kind::kOffByOne},
    KindName{"swap-bytes", Fault::Kind::kSwapBytes},
    KindName{"reverse-bits", Fault::Kind::kReverseBits},
    KindName{"loses-splits", Fault::Kind::kLosesSplits},
};

std::byte reversed(std::byte byte) noexcept {
  unsigned out = 0;
  for (unsigned bit = 0; bit < 8; ++bit) {
    out |= (std::to_integer<unsigned>(byte) >> bit & 1U) << (7 - bit);
  }
  return static_cast<std::byte>(out);
}

}  // namespace

std::string fault_forms() {
  std::string forms;
  for (const auto& [name, kind] : kKinds) {
    if (!forms.empty()) forms += ", ";
    forms += name;
    if (kind != Fault::Kind::kLosesSplits) forms += ":FIELD";
  }
  return forms;
}

Outcome<Fault> parse_fault(std::string_view text, std::span<const Field> fields) {
  const auto where = "fault '" + std::string{text} + "'";
  const auto colon = text.find(':');
  const auto kind = std::ranges::find(kKinds, text.substr(0, colon), &KindName::name);
  if (kind == kKinds.end()) return problem(ErrorCode::kBadValue, where, "known: " + fault_forms());
  Fault fault{kind->kind, nullptr};
  const bool has_field = colon != std::string_view::npos;
  if (has_field == (fault.kind == Fault::Kind::kLosesSplits)) {
    return problem(ErrorCode::kBadValue, where, "known: " + fault_forms());
  }
  if (!has_field) return fault;
  fault.field = find_field(fields, text.substr(colon + 1));
  if (fault.field != nullptr) return fault;
  std::string names;
  for (const auto& field : fields) names += ' ' + std::string{field.name};
  return problem(ErrorCode::kBadValue, where, "fields:" + names);
}

void apply_fault(const Fault& fault, std::span<std::byte> message,
                 std::optional<std::int64_t>& first) noexcept {
  if (fault.field == nullptr) return;
  const auto& field = *fault.field;
  if (std::size_t{field.offset} + field.width > message.size()) return;
  const auto bytes = message.subspan(field.offset, field.width);
  switch (fault.kind) {
    case Fault::Kind::kZero:
      set_field_value(field, message, 0);
      break;
    case Fault::Kind::kStuck:
      if (!first) first = field_value(field, message);
      set_field_value(field, message, *first);
      break;
    case Fault::Kind::kOffByOne:
      set_field_value(field, message, field_value(field, message) + 1);
      break;
    case Fault::Kind::kSwapBytes:
      std::ranges::reverse(bytes);
      break;
    case Fault::Kind::kReverseBits:
      std::ranges::transform(bytes, bytes.begin(), reversed);
      break;
    case Fault::Kind::kLosesSplits:
      break;
  }
}

}  // namespace armjig
