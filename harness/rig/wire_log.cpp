// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/wire_log.hpp"

#include <fmt/core.h>

#include <utility>
#include <vector>

#include "harness/capture/message_json.hpp"
#include "harness/core/hex.hpp"

namespace armjig {

Outcome<std::unique_ptr<StreamPort>> LoggedStream::log(std::unique_ptr<StreamPort> port,
                                                       const std::string& path,
                                                       const DissectorEntry& device) {
  std::ofstream file{path, std::ios::trunc};
  file << fmt::format(R"({{"format":"golden-trace/1","device":"{}","title":"wire log"}})",
                      device.device)
       << '\n'
       << std::flush;
  if (!file) {
    return problem(ErrorCode::kCannotWrite, path, "check that the folder exists and is writable");
  }
  return std::unique_ptr<StreamPort>{
      new LoggedStream{std::move(port), std::move(file), device.make()}};
}

LoggedStream::LoggedStream(std::unique_ptr<StreamPort> port, std::ofstream file,
                           std::unique_ptr<Dissector> dissector)
    : port_{std::move(port)}, file_{std::move(file)}, dissector_{std::move(dissector)} {}

Result<void> LoggedStream::write(Bytes bytes) {
  const auto written = port_->write(bytes);
  if (written) write_line(Direction::kToDevice, bytes);
  return written;
}

Result<std::size_t> LoggedStream::read(std::span<std::byte> into, Instant deadline) {
  const auto size = port_->read(into, deadline);
  if (size && *size > 0) write_line(Direction::kFromDevice, into.first(*size));
  return size;
}

bool LoggedStream::touch(std::string_view input, std::int64_t value) {
  if (!port_->touch(input, value)) return false;
  file_ << fmt::format(R"({{"t_us":{},"dir":"input","name":"{}","value":{}}})", microseconds(now()),
                       input, value)
        << '\n'
        << std::flush;
  return true;
}

void LoggedStream::write_line(Direction direction, Bytes bytes) {
  std::vector<Message> messages;
  dissector_->feed(direction, now(), bytes, messages);
  file_ << fmt::format(R"({{"t_us":{},"dir":"{}","hex":"{}")", microseconds(now()),
                       to_string(direction), to_hex(bytes));
  const char* separator = ",\"messages\":[";
  for (const auto& message : messages) {
    file_ << separator << to_json(message);
    separator = ",";
  }
  file_ << (messages.empty() ? "}" : "]}") << '\n' << std::flush;
}

}  // namespace armjig
