// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/defects/defects.hpp"

#include <algorithm>
#include <tuple>
#include <utility>
#include <variant>

#include "harness/wire/morap/fields.hpp"

namespace armjig::morap::emulation {
namespace {

using MessageBytes = std::vector<std::byte>;

/// Whether `bytes` are all of a command, and no more; so are those of a set whose count or checksum
/// the node refuses.
bool is_complete(Bytes bytes) {
  const auto decoded = decode_command(bytes);
  if (const auto* command = std::get_if<DecodedCommand>(&decoded)) {
    return command->size == bytes.size();
  }
  const auto& fault = std::get<CommandFault>(decoded);
  return fault.kind == CommandFault::Kind::kUnknownId || fault.kind == CommandFault::Kind::kBadSet;
}

/// The fields of a command behind the byte with the address; none of what nobody knows.
std::span<const Field> fields_of_command(Bytes command) {
  const CommandId id{std::to_integer<std::uint8_t>(command[0])};
  if (id != CommandId::kProgram) {
    const auto* info = find_command(id);
    return info == nullptr ? select_fields() : write_fields(*info);
  }
  const auto set = decode_set(command.subspan(1));
  if (const auto* good = std::get_if<ControllerSet>(&set)) return program_fields(*good);
  return {};
}

std::span<const Field> fields_of_answer(CommandId selected, Bytes answer) {
  const auto& reading = *find_reading(selected);
  if (reading.kind != ReadKind::kControllerSet) return read_fields(reading);
  const auto set = decode_set(answer);
  if (const auto* good = std::get_if<ControllerSet>(&set)) return read_set_fields(*good);
  return {};
}

/// Fields stand behind the byte with the address, which is not there.
void change(MessageBytes& bytes, const FieldFault& wrong, std::span<const Field> fields,
            std::optional<std::int64_t>& memory) {
  const auto* field = find_field(fields, wrong.field);
  if (field == nullptr) return;
  bytes.insert(bytes.begin(), std::byte{});
  apply_fault({.kind = wrong.kind, .field = field}, bytes, memory);
  bytes.erase(bytes.begin());
}

/// A changed parameter is sent with the checksum that it then has: nobody takes note of the fault.
void renew_checksum(MessageBytes& set) {
  const auto decoded = decode_set(set);
  if (!std::holds_alternative<SetFault>(decoded)) return;
  if (std::get<SetFault>(decoded).kind != SetFault::Kind::kWrongChecksum) return;
  set.back() = static_cast<std::byte>(checksum(Bytes{set}.first(set.size() - 1)));
}

constexpr std::size_t kWrap = 256;  // of the node's byte counter

}  // namespace

DefectiveNode::DefectiveNode(const NodeSetup& setup, Defects defects)
    : setup_{setup},
      plant_{setup.plant},
      defects_{std::move(defects)},
      node_{setup},
      field_memories_(defects_.heard.size() + defects_.sent.size()),
      quirk_memories_(defects_.quirks.size()) {}

bool DefectiveNode::acknowledges(std::uint8_t address) const noexcept {
  for (const auto* quirk : defects_.quirks) {
    if (quirk->acknowledges != nullptr) return quirk->acknowledges(address, node_);
  }
  return node_.acknowledges(address);
}

void DefectiveNode::start(Instant time, bool is_read) {
  stop(time);
  transaction_ = {.is_read = is_read};
  node_.start(time, is_read);
}

bool DefectiveNode::write(Instant time, std::byte byte) {
  auto& is_done = transaction_.is_done;
  auto& bytes = transaction_.bytes;
  bytes.push_back(byte);
  if (!is_done && is_complete(bytes)) {
    is_done = true;
    obey(time);
  } else if (!is_done) {
    std::ignore = node_.write(time, byte);
  } else {
    auto command = bytes;
    bool is_odd = false;
    for (std::size_t i = 0; i < defects_.quirks.size(); ++i) {
      const auto surplus = defects_.quirks[i]->surplus;
      if (surplus == nullptr) continue;
      surplus(command, quirk_memories_[i], node_);
      is_odd = true;
    }
    if (is_odd) {
      replay(time, command);
    } else {
      std::ignore = node_.write(time, byte);
    }
  }
  return std::ranges::none_of(defects_.quirks, [&](const Quirk* quirk) {
    return quirk->refuses != nullptr && quirk->refuses(bytes, node_);
  });
}

/// The node hears the last byte of a sound command, or all of a changed one at that time.
void DefectiveNode::obey(Instant time) {
  const auto command = heard(time);
  if (command == transaction_.bytes) {
    std::ignore = node_.write(time, command.back());
  } else {
    replay(time, command);
  }
}

void DefectiveNode::replay(Instant time, Bytes command) {
  node_.start(time, false);
  for (const auto byte : command) std::ignore = node_.write(time, byte);
}

MessageBytes DefectiveNode::heard(Instant time) {
  auto command = transaction_.bytes;
  const CommandId id{std::to_integer<std::uint8_t>(command[0])};
  node_.advance_to(time - Duration{1});
  for (std::size_t i = 0; i < defects_.heard.size(); ++i) {
    const auto& wrong = defects_.heard[i];
    if (wrong.id != id) continue;
    change(command, wrong, fields_of_command(command), field_memories_[i]);
    if (id != CommandId::kProgram || wrong.field == "checksum") continue;
    MessageBytes set{command.begin() + 1, command.end()};
    renew_checksum(set);
    std::ranges::copy(set, command.begin() + 1);
  }
  for (const auto& row : defects_.rows) {
    if (row.id != id || row.status != node_.status()) continue;
    command.clear();
    if (row.acts_as) command.push_back(static_cast<std::byte>(*row.acts_as));
  }
  for (std::size_t i = 0; i < defects_.quirks.size(); ++i) {
    const auto hear = defects_.quirks[i]->hear;
    if (hear != nullptr && !command.empty()) hear(command, quirk_memories_[i], node_);
  }
  return command;
}

std::byte DefectiveNode::read(Instant time) {
  auto& bytes = transaction_.bytes;
  const auto says = [](const Quirk* quirk) { return quirk->say != nullptr; };
  if (defects_.sent.empty() && std::ranges::none_of(defects_.quirks, says)) return node_.read(time);
  const bool is_byte = find_reading(node_.selected())->kind == ReadKind::kByte;
  if (bytes.empty() || is_byte) say(time);
  const auto place = is_byte ? 0 : transaction_.read++ % kWrap;
  const auto byte_of = [place](Bytes answer) {
    return place < answer.size() ? answer[place] : std::byte{};
  };
  // What no fault changes may change by itself while it is read.
  const auto byte = node_.read(time);
  return byte_of(bytes) == byte_of(transaction_.truth) ? byte : byte_of(bytes);
}

/// All of an answer at the time of its first byte, which is still to be read then.
void DefectiveNode::say(Instant time) {
  const auto selected = node_.selected();
  auto& bytes = transaction_.bytes;
  bytes.clear();
  node_.start(time, true);
  const auto size = [&]() -> std::size_t {
    switch (find_reading(selected)->kind) {
      case ReadKind::kByte:
        return 1;
      case ReadKind::kFloat:
        return sizeof(float);
      case ReadKind::kControllerSet:
        break;
    }
    const bool is_position = selected == CommandId::kReadPositionSet;
    return wire_size(is_position ? node_.position_set() : node_.speed_set());
  }();
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(node_.read(time));
  transaction_.truth = bytes;
  for (std::size_t i = 0; i < defects_.sent.size(); ++i) {
    const auto& wrong = defects_.sent[i];
    if (wrong.id != selected) continue;
    auto& memory = field_memories_[defects_.heard.size() + i];
    change(bytes, wrong, fields_of_answer(selected, bytes), memory);
    if (wrong.field != "checksum") renew_checksum(bytes);
  }
  for (std::size_t i = 0; i < defects_.quirks.size(); ++i) {
    const auto say = defects_.quirks[i]->say;
    if (say != nullptr) say(bytes, quirk_memories_[i], node_);
  }
  node_.start(time, true);
}

void DefectiveNode::stop(Instant time) {
  const auto ended = std::exchange(transaction_, {});
  if (ended.is_read || ended.is_done || ended.bytes.empty()) return;
  for (std::size_t i = 0; i < defects_.quirks.size(); ++i) {
    const auto finish = defects_.quirks[i]->finish;
    if (finish == nullptr) continue;
    auto command = ended.bytes;
    finish(command, quirk_memories_[i], node_);
    replay(time, command);
  }
}

Duration DefectiveNode::stretch() const {
  auto held = node_.stretch();
  for (const auto* quirk : defects_.quirks) {
    if (quirk->stretch == nullptr) continue;
    held = std::max(held, quirk->stretch(transaction_.bytes, transaction_.is_read));
  }
  return held;
}

void DefectiveNode::restart(Instant time) {
  node_.restart(time);
  transaction_ = {};
}

bool DefectiveNode::set_input(Instant time, std::string_view name, std::int64_t value) {
  node_.advance_to(time);
  if (name == "power") {
    restart(time);
  } else if (name == "shaft") {
    setup_.plant = value != 0 ? plant_ : std::nullopt;
    node_ = Node{setup_};
    restart(time);
  } else if (name == "encoder") {
    node_.turn_encoder(time, static_cast<std::int32_t>(value));
  } else if (name == "adc") {
    node_.set_conversion(time, static_cast<std::uint16_t>(value));
  } else {
    return false;
  }
  return true;
}

}  // namespace armjig::morap::emulation
