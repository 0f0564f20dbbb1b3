// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/wire_log.hpp"

#include <fmt/core.h>

#include <utility>
#include <vector>

#include "harness/core/hex.hpp"

namespace armjig {

Outcome<std::unique_ptr<StreamPort>> LoggedStream::log(std::unique_ptr<StreamPort> port,
                                                       const std::string& path,
                                                       const DissectorEntry& device) {
  auto file = LogFile::create(path, device.device);
  if (!file) return tl::unexpected{file.error()};
  return std::unique_ptr<StreamPort>{
      new LoggedStream{std::move(port), *std::move(file), device.make()}};
}

LoggedStream::LoggedStream(std::unique_ptr<StreamPort> port, LogFile file,
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
  file_.add(now(), fmt::format(R"("dir":"input","name":"{}","value":{})", input, value));
  return true;
}

void LoggedStream::write_line(Direction direction, Bytes bytes) {
  std::vector<Message> messages;
  dissector_->feed(direction, now(), bytes, messages);
  file_.add(now(), fmt::format(R"("dir":"{}","hex":"{}")", to_string(direction), to_hex(bytes)),
            messages);
}

}  // namespace armjig
