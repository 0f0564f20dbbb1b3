// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/edit.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "harness/link/bus_port.hpp"

namespace armjig::campaign {
namespace {

/// What buses of Linux carry in one transaction.
constexpr std::int64_t kMostBusBytes = 255;

constexpr std::array<std::int64_t, 28> kEdges{
    1,      2,      4,       8,       10,        16,        32,        64,       90,    100,
    128,    180,    256,     512,     1000,      1'024,     2'048,     4'096,    8'192, 10'000,
    32'768, 65'536, 100'000, 1 << 20, 1'000'000, 1LL << 22, 1LL << 23, 1LL << 31};
static_assert(kEdgeCount == kEdges.size() * 6);

}  // namespace

std::int64_t edge_at(std::size_t place) {
  const auto value =
      kEdges.at(place / 6 % kEdges.size()) + static_cast<std::int64_t>(place % 3) - 1;
  return place % 6 < 3 ? value : -value;
}

std::int64_t float_of(std::int64_t value, float part) {
  return std::bit_cast<std::int32_t>(static_cast<float>(value) * part);
}

std::vector<std::size_t> sent_in(const Script& script) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < script.size(); ++i) {
    if (is_sent(script[i]) && !script[i].bytes.empty()) places.push_back(i);
  }
  return places;
}

std::size_t end_of_exchange(const Script& script, std::size_t place) {
  const bool is_followed = script[place].kind == LinkKind::kBus && place + 1 < script.size() &&
                           script[place + 1].kind == LinkKind::kBus && !is_sent(script[place + 1]);
  return is_followed ? place + 1 : place;
}

void set_piece(const Field& field, std::vector<std::byte>& line, std::string_view text) {
  constexpr std::byte kColon{':'};
  auto begin = line.begin();
  for (auto left = field.offset; left > 0 && begin != line.end(); --left) {
    begin = std::find(begin, line.end(), kColon);
    if (begin != line.end()) ++begin;
  }
  const auto end = std::find_if(begin, line.end(), [](std::byte byte) {
    return byte == kColon || byte == std::byte{'\r'} || byte == std::byte{'\n'};
  });
  const auto bytes = std::as_bytes(std::span{text});
  const auto place = line.erase(begin, end);
  line.insert(place, bytes.begin(), bytes.end());
}

void set_number(const Material& material, KeptRecord& record, const Message& whole,
                std::span<const Field> fields, std::int64_t number, float part) {
  auto message = whole.raw;
  for (const auto& field : fields) {
    if (field.place == Place::kPiece) {
      set_piece(field, record.bytes, std::to_string(number));
    } else if (field.offset + std::size_t{field.width} <= message.size() && field.width > 0) {
      const bool is_float = field.encoding == Encoding::kFloatLittle;
      set_field_value(field, message, is_float ? float_of(number, part) : number);
    }
  }
  if (fields.front().place == Place::kBytes && put(message, record)) seal(material, record);
}

bool put(Bytes message, KeptRecord& record) {
  const std::size_t head = record.kind == LinkKind::kBus ? 1 : 0;
  if (message.size() > record.bytes.size() + head) return false;
  std::ranges::copy(message.subspan(head), record.bytes.begin());
  return true;
}

void seal(const Material& material, KeptRecord& record) {
  if (material.seal == nullptr) return;
  auto message = record.bytes;
  const std::size_t head = record.kind == LinkKind::kBus ? 1 : 0;
  if (head > 0) {
    const BusAddress address{static_cast<std::uint8_t>(record.id)};
    message.insert(message.begin(), head_of(write_to(address, {})));
  }
  material.seal(message);
  std::copy(message.begin() + static_cast<std::ptrdiff_t>(head), message.end(),
            record.bytes.begin());
}

KeptRecord sending(KeptRecord record, std::vector<std::byte> bytes) {
  record.bytes = std::move(bytes);
  return record;
}
Script sending(Script exchange, std::vector<std::byte> bytes) {
  exchange.front().bytes = std::move(bytes);
  return exchange;
}

KeptRecord in_one_piece(KeptRecord one, const KeptRecord& next) {
  one.bytes.insert(one.bytes.end(), next.bytes.begin(), next.bytes.end());
  return one;
}

std::vector<std::byte> cut(std::vector<std::byte> bytes, std::size_t size) {
  constexpr std::byte kSurplus{0x41};
  bytes.resize(size, kSurplus);
  return bytes;
}

bool is_permitted(const Material& material, const Script& script) {
  auto permitted = script;
  if (material.permit) material.permit(permitted);
  return permitted.size() == script.size();
}

void hurry(Script& script, Duration longest) {
  Duration saved{};
  Instant last{};
  for (auto& record : script) {
    const auto gap = record.time - last;
    last = record.time;
    saved += std::max(Duration{}, gap - longest);
    record.time -= saved;
  }
}

void leave_out_unplayable(const Material& material, Script& script) {
  std::erase_if(script, [&](const KeptRecord& one) {
    return (one.kind != material.kind && one.kind != LinkKind::kEvents) ||
           (is_by_hand(one) && !material.has_hands);
  });
}

void make_playable(const Material& material, Script& script) {
  if (material.kind != LinkKind::kBus || material.has_operations) return;
  std::erase_if(script, [](const KeptRecord& one) {
    const auto wanted = is_sent(one) ? std::ssize(one.bytes) : number_in(one, "n", 0);
    return one.kind == LinkKind::kBus && (wanted == 0 || wanted > kMostBusBytes);
  });
  for (auto& record : script) {
    const auto goes_on = record.details.find(R"(,"stop":false)");
    if (goes_on != std::string::npos) record.details.resize(goes_on);
  }
}

}  // namespace armjig::campaign
