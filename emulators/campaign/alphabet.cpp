// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/alphabet.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace armjig::campaign {

void Acts::send(Bytes bytes) {
  script_.push_back({.time = now_,
                     .kind = LinkKind::kStream,
                     .direction = Direction::kToDevice,
                     .bytes = {bytes.begin(), bytes.end()}});
}

void Acts::send_line(std::string_view line) {
  const auto text = fmt::format("{}\r\n", line);
  const auto bytes = std::as_bytes(std::span{text});
  script_.push_back({.time = now_,
                     .kind = LinkKind::kSession,
                     .direction = Direction::kToDevice,
                     .id = 1,
                     .bytes = {bytes.begin(), bytes.end()}});
}

void Acts::write(std::uint8_t address, Bytes bytes) {
  script_.push_back({.time = now_,
                     .kind = LinkKind::kBus,
                     .direction = Direction::kToDevice,
                     .id = address,
                     .bytes = {bytes.begin(), bytes.end()},
                     .details = R"("ack":"")"});
}

void Acts::read(std::uint8_t address, std::uint16_t count) {
  script_.push_back({.time = now_,
                     .kind = LinkKind::kBus,
                     .direction = Direction::kFromDevice,
                     .id = address,
                     .details = fmt::format(R"("n":{},"ack":"")", count)});
}

void Acts::set(std::string_view input, std::int64_t value) {
  script_.push_back(
      {.time = now_,
       .kind = LinkKind::kEvents,
       .direction = Direction::kToDevice,
       .details = fmt::format(R"("dir":"input","name":"{}","value":{})", input, value)});
}

std::optional<std::int64_t> value_in(const Message& message, std::string_view field) {
  const auto found = std::ranges::find(message.fields, field, &Field::name);
  if (found == message.fields.end()) return std::nullopt;
  return field_value(*found, message.raw);
}

}  // namespace armjig::campaign
