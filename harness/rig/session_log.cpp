// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/session_log.hpp"

#include <fmt/core.h>

#include <utility>
#include <vector>

#include "harness/core/hex.hpp"

namespace armjig {

Outcome<std::shared_ptr<SessionLog>> SessionLog::create(const std::string& path,
                                                        const DissectorEntry& device) {
  auto file = LogFile::create(path, device.device);
  if (!file) return tl::unexpected{file.error()};
  return std::make_shared<SessionLog>(SessionLog{*std::move(file), device});
}

LoggedSession::LoggedSession(std::unique_ptr<SessionPort> port, std::shared_ptr<SessionLog> log,
                             Duration offset)
    : port_{std::move(port)}, log_{std::move(log)}, offset_{offset} {}

Result<void> LoggedSession::connect(Instant deadline) {
  const auto connected = port_->connect(deadline);
  const bool is_refused = !connected && connected.error().code == ErrorCode::kRefused;
  if (!connected && !is_refused) return connected;
  connection_ = log_->connections++;
  is_open_ = !is_refused;
  dissector_ = log_->device.make();
  add(fmt::format(R"("dir":"connect","conn":{},"text":"{}")", connection_,
                  is_refused ? "refused" : "ok"));
  return connected;
}

Result<void> LoggedSession::send(Bytes segment) {
  const auto sent = port_->send(segment);
  if (sent) write_bytes(Direction::kToDevice, segment);
  return sent;
}

Result<SessionPort::Received> LoggedSession::receive(std::span<std::byte> into, Instant deadline) {
  const auto received = port_->receive(into, deadline);
  if (!received) return received;
  if (received->arrival == Arrival::kData) {
    write_bytes(Direction::kFromDevice, into.first(received->size));
  } else if (received->arrival == Arrival::kEnd) {
    write_end("device-eof");
  } else if (received->arrival == Arrival::kReset) {
    write_end("device-reset");
  }
  return received;
}

void LoggedSession::half_close() {
  port_->half_close();
  if (is_open_) write_disconnect("client-half-close");
}

void LoggedSession::close() {
  port_->close();
  write_end("client-close");
}

void LoggedSession::reset() {
  port_->reset();
  write_end("client-reset");
}

void LoggedSession::add(std::string_view keys, std::span<const Message> messages) {
  log_->file.add(time(), keys, messages);
}

void LoggedSession::write_end(std::string_view how) {
  if (std::exchange(is_open_, false)) write_disconnect(how);
}

void LoggedSession::write_disconnect(std::string_view how) {
  add(fmt::format(R"("dir":"disconnect","conn":{},"text":"{}")", connection_, how));
}

void LoggedSession::write_bytes(Direction direction, Bytes bytes) {
  std::vector<Message> messages;
  dissector_->feed(direction, time(), bytes, messages);
  add(fmt::format(R"("dir":"{}","conn":{},"hex":"{}")", to_string(direction), connection_,
                  to_hex(bytes)),
      messages);
}

}  // namespace armjig
