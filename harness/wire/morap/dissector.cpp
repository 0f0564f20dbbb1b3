// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/dissector.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "harness/wire/morap/fields.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap {
namespace {

/// What a transaction turned out to be. `size` counts the byte with the address.
struct Found {
  std::string_view name;
  std::size_t size{};
  std::span<const Field> fields;
  std::string fault{};  ///< of everything behind the message; of all of it if `size` is 0
};

Found noise(std::string fault) { return {"noise", 0, {}, std::move(fault)}; }

constexpr std::array<std::string_view, 3> kSetFaults{"cut short", "a count above four",
                                                     "wrong checksum"};

constexpr std::string_view kSurplus = "behind the end of the command";
constexpr std::string_view kReadPastValue = "read past the end of the value";
constexpr std::string_view kReadPastSet = "read past the end of the set";
constexpr std::string_view kIgnored = "ignored by the node";
constexpr std::string_view kPenHangs = "hangs a real pen";
constexpr std::string_view kPenIsMute = "a pen has nothing to read";

std::string cut_short(int command) { return fmt::format("command {} is cut short", command); }

std::string describe(const SetFault& fault) {
  return fmt::format("{} at byte {} of the set", kSetFaults[static_cast<std::size_t>(fault.kind)],
                     fault.offset);
}

Found find_fault(const CommandFault& fault, Bytes data) {
  switch (fault.kind) {
    case CommandFault::Kind::kEmpty:
      return {"poke", 1, poke_fields()};
    case CommandFault::Kind::kUnknownId:
      return {"unknown", 2, unknown_write_fields(), std::string{kIgnored}};
    case CommandFault::Kind::kTooShort:
      return noise(cut_short(std::to_integer<int>(data[0])));
    case CommandFault::Kind::kBadSet:
      return noise(describe(fault.set));
  }
  return noise({});
}

class BusDissector final : public Dissector {
 public:
  BusDissector() { selected_.fill(CommandId::kReadAngle); }

  void feed(Direction /*direction*/, Instant time, Bytes bytes,
            std::vector<Message>& out) override {
    if (bytes.empty()) return;
    const auto head = std::to_integer<std::uint8_t>(bytes[0]);
    const auto address = static_cast<std::uint8_t>(head >> 1);
    const bool is_read = (head & 1) != 0;
    const auto found =
        is_read ? find_read(address, bytes.subspan(1)) : find_write(address, bytes.subspan(1));
    const auto direction = is_read ? Direction::kFromDevice : Direction::kToDevice;
    const auto message = bytes.first(std::min(found.size, bytes.size()));
    const auto rest = bytes.subspan(message.size());
    if (!message.empty()) {
      out.push_back(
          {direction, time, found.name, {message.begin(), message.end()}, found.fields, {}});
    }
    if (!rest.empty()) {
      out.push_back({direction, time, "noise", {rest.begin(), rest.end()}, {}, found.fault});
    }
  }
  void finish(std::vector<Message>& /*out*/) override {}

 private:
  Found find_write(std::uint8_t address, Bytes data) {
    if (address == pen::kAddress) return find_pen(data);
    const auto decoded = decode_command(data);
    if (const auto* fault = std::get_if<CommandFault>(&decoded)) return find_fault(*fault, data);
    const auto& [command, size] = std::get<DecodedCommand>(decoded);
    const std::string surplus{kSurplus};
    if (find_reading(command.id) != nullptr) {
      selected_[address] = command.id;
      return {"select", 1 + size, select_fields(), surplus};
    }
    const auto& info = *find_command(command.id);
    const auto* set = std::get_if<ControllerSet>(&command.payload);
    return {info.name, 1 + size, set != nullptr ? program_fields(*set) : write_fields(info),
            surplus};
  }

  Found find_read(std::uint8_t address, Bytes data) const {
    if (address == pen::kAddress) return noise(std::string{kPenIsMute});
    const auto& info = *find_reading(selected_[address]);
    if (data.empty()) return {"poke", 1, poke_fields()};
    if (info.kind == ReadKind::kControllerSet) return find_set(info, data);
    const std::size_t size = info.kind == ReadKind::kFloat ? 4 : 1;
    if (data.size() < size) return noise(fmt::format("{} is cut short", info.name));
    return {info.name, 1 + size, read_fields(info), std::string{kReadPastValue}};
  }

  static Found find_set(const ReadInfo& info, Bytes data) {
    const auto decoded = decode_set(data);
    if (const auto* fault = std::get_if<SetFault>(&decoded)) return noise(describe(*fault));
    const auto& set = std::get<ControllerSet>(decoded);
    return {info.name, 1 + wire_size(set), read_set_fields(set), std::string{kReadPastSet}};
  }

  static Found find_pen(Bytes data) {
    if (data.empty()) return {"poke", 1, poke_fields()};
    const bool has_position =
        data[0] == static_cast<std::byte>(pen::CommandId::kSetPosition) && data.size() > 1;
    if (has_position) return {"pen", 3, pen_position_fields(), std::string{kPenHangs}};
    return {"pen", 2, pen_fields(), std::string{kPenHangs}};
  }

  std::array<CommandId, 128> selected_{};  ///< by address
};

}  // namespace

std::unique_ptr<Dissector> make_dissector() { return std::make_unique<BusDissector>(); }

Dissection dissection() {
  constexpr auto kTo = Direction::kToDevice;
  constexpr auto kFrom = Direction::kFromDevice;
  const auto key_of = [](auto id) { return static_cast<std::uint8_t>(id); };
  const auto pattern_of_set = [](BusPattern pattern, std::uint16_t begin) {
    pattern.begin = begin;
    pattern.too_many = fmt::format("{} at byte %d of the set", kSetFaults[1]);
    return pattern;
  };
  ControllerSet largest;
  for (auto* filter : {&largest.d, &largest.c, &largest.f}) filter->count = kMostCoefficients;
  std::vector<MessageKind> kinds{
      {"noise", kFrom, {}, {}, {.address = pen::kAddress, .surplus = std::string{kPenIsMute}}},
      {"poke", kTo, poke_fields(), {}, {.is_alone = true}},
      {"poke", kFrom, poke_fields(), {}, {.is_alone = true}},
      {"pen",
       kTo,
       pen_position_fields(),
       {},
       {.address = pen::kAddress,
        .key = key_of(pen::CommandId::kSetPosition),
        .surplus = std::string{kPenHangs}}},
      {"pen",
       kTo,
       pen_fields(),
       {},
       {.address = pen::kAddress, .surplus = std::string{kPenHangs}}}};
  for (const auto& info : commands()) {
    const BusPattern pattern{.key = key_of(info.id),
                             .cut_short = cut_short(key_of(info.id)),
                             .surplus = std::string{kSurplus}};
    const bool is_set = info.payload == Payload::kControllerSet;
    kinds.push_back({info.name,
                     kTo,
                     is_set ? program_fields(largest) : write_fields(info),
                     {},
                     is_set ? pattern_of_set(pattern, 2) : pattern});
  }
  for (const auto& info : readings()) {
    const auto key = key_of(info.selector);
    kinds.push_back({"select",
                     kTo,
                     select_fields(),
                     {},
                     {.key = key, .is_choice = true, .surplus = std::string{kSurplus}}});
    const bool is_set = info.kind == ReadKind::kControllerSet;
    const BusPattern pattern{
        .key = key,
        .cut_short = is_set ? fmt::format("{} at byte %d of the set", kSetFaults[0])
                            : fmt::format("{} is cut short", info.name),
        .surplus = std::string{is_set ? kReadPastSet : kReadPastValue}};
    kinds.push_back({info.name,
                     kFrom,
                     is_set ? read_set_fields(largest) : read_fields(info),
                     {},
                     is_set ? pattern_of_set(pattern, 1) : pattern});
  }
  kinds.push_back({"unknown", kTo, unknown_write_fields(), {}, {.surplus = std::string{kIgnored}}});
  return {.messages = std::move(kinds),
          .check =
              "function(m, begin)\n"
              "  local sum = 0\n"
              "  for i = begin + 1, #m - 1 do sum = sum + m:byte(i) end\n"
              "  while sum > 255 do sum = math.floor(sum / 256) + sum % 256 end\n"
              "  return m:byte(-1) ~= 255 - sum and 'wrong checksum at byte %d of the set' or nil\n"
              "end",
          .framing = Framing::kTransactions,
          .first_choice = key_of(CommandId::kReadAngle)};
}

}  // namespace armjig::morap
