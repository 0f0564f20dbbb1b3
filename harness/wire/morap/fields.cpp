// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/fields.hpp"

#include <array>
#include <cassert>
#include <cstddef>
#include <string_view>
#include <vector>

#include "harness/wire/morap/pen.hpp"

namespace armjig::morap {
namespace {

using enum Encoding;

constexpr std::array<NamedValue, 3> kPenNames{{{1, "deploy"}, {2, "retract"}, {7, "set_position"}}};
constexpr std::array<NamedValue, 2> kKinds{{{0, "position"}, {1, "speed"}}};
constexpr std::array<NamedValue, 3> kTuneKinds{
    {{0, "pd_position"}, {1, "pid_position"}, {2, "pi_speed"}}};
constexpr std::array<NamedValue, 3> kMotorStatuses{
    {{1, "enabled"}, {2, "disabled"}, {3, "needs_calibration"}}};
constexpr std::array<NamedValue, 3> kProgrammingStatuses{
    {{1, "nothing"}, {2, "success"}, {3, "failure"}}};

constexpr Field kBusAddress{"bus", 0, 1, kUnsigned, "", "address times two; plus one for a read"};
constexpr Field kCommand{"command", 1, 1, kCode, "", "what to do", {}, kIdentifierNames};

constexpr std::array kPokeFields{kBusAddress};
constexpr std::array kCommandFields{kBusAddress, kCommand};
constexpr std::array kPenFields{kBusAddress,
                                Field{"command", 1, 1, kCode, "", "others retract", {}, kPenNames}};
constexpr std::array kPenPositionFields{
    kBusAddress, kPenFields[1],
    Field{"position", 2, 1, kUnsigned, "", "0 retracted to 255 deployed"}};
constexpr std::array kTuneFields{
    kBusAddress, kCommand, Field{"kind", 2, 1, kCode, "", "what to compute", {}, kTuneKinds},
    Field{"inertia", 3, 4, kFloatLittle, "kg m^2", "at the output shaft"},
    Field{"pole", 7, 4, kFloatLittle, "1/s", "of the closed loop"}};

using FieldList = std::vector<Field>;

/// The list of each command with a float, and of each float or byte that can be read, made once.
template <class Table, class Make>
std::vector<FieldList> lists_of(const Table& table, Make make) {
  std::vector<FieldList> lists;
  for (const auto& info : table) lists.push_back(make(info));
  return lists;
}

FieldList command_list(const CommandInfo& info) {
  return {kBusAddress, kCommand, Field{"value", 2, 4, kFloatLittle, info.unit, info.meaning}};
}

FieldList reading_list(const ReadInfo& info) {
  switch (info.selector) {
    case CommandId::kReadMotorStatus:
      return {kBusAddress, Field{info.name, 1, 1, kCode, "", info.meaning, {}, kMotorStatuses}};
    case CommandId::kReadProgrammingStatus:
      return {kBusAddress,
              Field{info.name, 1, 1, kCode, "", info.meaning, {}, kProgrammingStatuses}};
    default:
      break;
  }
  if (info.kind == ReadKind::kByte) {
    return {kBusAddress, Field{info.name, 1, 1, kUnsigned, info.unit, info.meaning}};
  }
  return {kBusAddress, Field{info.name, 1, 4, kFloatLittle, info.unit, info.meaning}};
}

using CoefficientNames = std::array<std::string_view, kMostCoefficients>;

/// Adds fields one behind the other.
class ListMaker {
 public:
  explicit ListMaker(FieldList list) : list_{std::move(list)}, place_{list_.back().offset + 1U} {}

  void add(Field field) {
    field.offset = static_cast<std::uint16_t>(place_);
    place_ += field.width;
    list_.push_back(field);
  }
  void add_filter(std::string_view count_name, std::string_view meaning, std::size_t count,
                  const CoefficientNames& names) {
    add({count_name, 0, 1, kUnsigned, "", "how many"});
    for (std::size_t i = 0; i < count; ++i) add({names[i], 0, 4, kFloatLittle, "", meaning});
  }
  [[nodiscard]] FieldList list() const { return list_; }

 private:
  FieldList list_;
  std::size_t place_;
};

FieldList set_list(FieldList head, std::size_t nd, std::size_t nc, std::size_t nf) {
  constexpr CoefficientNames kD{"d.0", "d.1", "d.2", "d.3"};
  constexpr CoefficientNames kC{"c.0", "c.1", "c.2", "c.3"};
  constexpr CoefficientNames kF{"f.0", "f.1", "f.2", "f.3"};
  ListMaker maker{std::move(head)};
  maker.add({"kind", 0, 1, kCode, "", "which controller", {}, kKinds});
  maker.add({"rate", 0, 2, kUnsignedLittle, "Hz", "of the controller"});
  maker.add_filter("d.count", "of the measured value", nd, kD);
  maker.add_filter("c.count", "of the reference", nc, kC);
  maker.add_filter("f.count", "of earlier outputs", nf, kF);
  maker.add({"integral", 0, 4, kFloatLittle, "", "gain of the integrator for each sample"});
  maker.add({"checksum", 0, 1, kUnsigned, "", "folded sum, complemented"});
  return maker.list();
}

constexpr std::size_t kCounts = kMostCoefficients + 1;

/// A list for each choice of counts.
std::vector<FieldList> set_lists(const FieldList& head) {
  std::vector<FieldList> lists;
  for (std::size_t i = 0; i < kCounts * kCounts * kCounts; ++i) {
    lists.push_back(set_list(head, i / kCounts / kCounts, i / kCounts % kCounts, i % kCounts));
  }
  return lists;
}

std::size_t list_number(const ControllerSet& set) noexcept {
  return (set.d.count * kCounts + set.c.count) * kCounts + set.f.count;
}

}  // namespace

std::span<const Field> poke_fields() noexcept { return kPokeFields; }
std::span<const Field> unknown_write_fields() noexcept { return kCommandFields; }
std::span<const Field> select_fields() noexcept { return kCommandFields; }

std::span<const Field> write_fields(const CommandInfo& command) {
  assert(command.payload != Payload::kControllerSet);
  static const auto kLists = lists_of(commands(), command_list);
  if (command.payload == Payload::kNone) return kCommandFields;
  if (command.payload == Payload::kTuneRequest) return kTuneFields;
  return kLists[static_cast<std::size_t>(&command - commands().data())];
}

std::span<const Field> program_fields(const ControllerSet& set) {
  static const auto kLists = set_lists({kBusAddress, kCommand});
  return kLists[list_number(set)];
}

std::span<const Field> read_fields(const ReadInfo& info) {
  assert(info.kind != ReadKind::kControllerSet);
  static const auto kLists = lists_of(readings(), reading_list);
  return kLists[static_cast<std::size_t>(&info - readings().data())];
}

std::span<const Field> read_set_fields(const ControllerSet& set) {
  static const auto kLists = set_lists({kBusAddress});
  return kLists[list_number(set)];
}

std::span<const Field> pen_fields() noexcept { return kPenFields; }
std::span<const Field> pen_position_fields() noexcept { return kPenPositionFields; }

}  // namespace armjig::morap
