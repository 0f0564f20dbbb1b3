// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/logged_ports.hpp"

#include <utility>

#include "harness/capture/trace.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

using Keys = WireLog::Keys;

const WireLog::Key kWithoutStop{"stop", false};

WireLog::Key failed(ErrorCode code) { return {"error", std::string{describe(code)}}; }

Keys outcome_of(const Result<Transfer>& result) {
  if (!result) return {failed(result.error().code)};
  if (*result == Transfer::kDone) return {};
  return {{"refused", *result == Transfer::kAddressRefused ? "address" : "byte"}};
}

/// What is known of the answers to a message of a transaction with so many.
std::string acks_of(const BusMessage& message, const Result<Transfer>& result, std::size_t count) {
  if (!result) return {};
  if (*result == Transfer::kDone) return std::string(1 + message.write.size(), 'A');
  if (count > 1) return {};
  return *result == Transfer::kAddressRefused ? "N" : "A";
}

}  // namespace

LoggedStream::LoggedStream(std::unique_ptr<StreamPort> port, std::shared_ptr<WireLog> log)
    : StreamAround{std::move(port)}, talk_{std::move(log)} {}

Result<void> LoggedStream::write(Bytes bytes) {
  const auto written = inner().write(bytes);
  if (written) talk_.add_bytes(now(), {}, Direction::kToDevice, bytes);
  return written;
}

Result<std::size_t> LoggedStream::read(std::span<std::byte> into, Instant deadline) {
  const auto size = inner().read(into, deadline);
  if (size && *size > 0) {
    talk_.add_bytes(now(), {}, Direction::kFromDevice, into.first(*size));
  }
  return size;
}

bool LoggedStream::touch(std::string_view input, std::int64_t value) {
  if (!inner().touch(input, value)) return false;
  talk_.log().add_input(now(), "dir", input, value);
  return true;
}

LoggedSession::LoggedSession(std::unique_ptr<SessionPort> port, std::shared_ptr<WireLog> log,
                             Duration offset)
    : SessionAround{std::move(port)}, log_{std::move(log)}, offset_{offset} {}

Result<void> LoggedSession::connect(Instant deadline) {
  const auto connected = inner().connect(deadline);
  const bool is_refused = !connected && connected.error().code == ErrorCode::kRefused;
  if (!connected && !is_refused) return connected;
  connection_ = log_->next_connection();
  is_open_ = !is_refused;
  talk_.emplace(log_);
  write_border("connect", is_refused ? "refused" : "ok");
  return connected;
}

Result<void> LoggedSession::send(Bytes segment) {
  const auto sent = inner().send(segment);
  if (sent) write_bytes(Direction::kToDevice, segment);
  return sent;
}

Result<SessionPort::Received> LoggedSession::receive(std::span<std::byte> into, Instant deadline) {
  const auto received = inner().receive(into, deadline);
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
  inner().half_close();
  if (is_open_) write_border("disconnect", "client-half-close");
}

void LoggedSession::close() {
  inner().close();
  write_end("client-close");
}

void LoggedSession::reset() {
  inner().reset();
  write_end("client-reset");
}

void LoggedSession::write_end(std::string_view how) {
  if (std::exchange(is_open_, false)) write_border("disconnect", how);
}

void LoggedSession::write_border(std::string_view direction, std::string_view how) {
  log_->add(time(), {{"dir", std::string{direction}},
                     {"conn", std::int64_t{connection_}},
                     {"text", std::string{how}}});
}

void LoggedSession::write_bytes(Direction direction, Bytes bytes) {
  talk_->add_bytes(time(), {{"conn", std::int64_t{connection_}}}, direction, bytes);
}

LoggedSource::LoggedSource(std::unique_ptr<SessionSource> inner, std::shared_ptr<WireLog> log)
    : SourceAround{std::move(inner),
                   [this](std::unique_ptr<SessionPort> port) {
                     const auto offset = now() - port->now();
                     return std::make_unique<LoggedSession>(std::move(port), log_, offset);
                   }},
      log_{std::move(log)} {}

bool LoggedSource::touch(std::string_view input, std::int64_t value) {
  if (!SourceAround::touch(input, value)) return false;
  log_->add_input(now(), "dir", input, value);
  return true;
}

LoggedBus::LoggedBus(std::unique_ptr<BusPort> port, std::shared_ptr<WireLog> log)
    : BusAround{std::move(port)}, talk_{std::move(log)} {}

LoggedBus::~LoggedBus() { end_part({kWithoutStop}); }

Result<Transfer> LoggedBus::transfer(std::span<const BusMessage> messages) {
  if (has_operations()) return BusPort::transfer(messages);
  const auto begin = now();
  const auto result = inner().transfer(messages);
  for (const auto& message : messages) {
    auto outcome = outcome_of(result);
    if (&message != &messages.back()) outcome.push_back(kWithoutStop);
    const bool was_read = result && *result == Transfer::kDone;
    const auto bytes = message.access == Access::kWrite ? message.write
                       : was_read                       ? Bytes{message.read}
                                                        : Bytes{};
    note({begin,
          message.address,
          message.access,
          {bytes.begin(), bytes.end()},
          acks_of(message, result, messages.size())},
         outcome);
  }
  return result;
}

Result<Ack> LoggedBus::start(BusAddress address, Access access) {
  end_part({kWithoutStop});
  part_ = Part{.begin = now(), .address = address, .access = access};
  const auto reply = inner().start(address, access);
  if (reply) {
    part_->acks += *reply == Ack::kAck ? 'A' : 'N';
  } else {
    end_part({failed(reply.error().code)});
  }
  return reply;
}

Result<Ack> LoggedBus::write(std::byte byte) {
  const auto reply = inner().write(byte);
  if (!reply) {
    end_part({failed(reply.error().code)});
  } else if (part_) {
    part_->bytes.push_back(byte);
    part_->acks += *reply == Ack::kAck ? 'A' : 'N';
  }
  return reply;
}

Result<std::byte> LoggedBus::read(Ack reply) {
  const auto byte = inner().read(reply);
  if (!byte) {
    end_part({failed(byte.error().code)});
  } else if (part_) {
    part_->bytes.push_back(*byte);
  }
  return byte;
}

Result<void> LoggedBus::stop() {
  const auto stopped = inner().stop();
  end_part(stopped ? Keys{} : Keys{failed(stopped.error().code)});
  return stopped;
}

Result<void> LoggedBus::recover() {
  end_part({kWithoutStop});
  const auto begin = now();
  const auto recovered = inner().recover();
  Keys keys{{"op", "recover"}};
  if (!recovered) keys.push_back(failed(recovered.error().code));
  talk_.log().add(begin, keys);
  return recovered;
}

bool LoggedBus::touch(std::string_view input, std::int64_t value) {
  if (!inner().touch(input, value)) return false;
  end_part({kWithoutStop});
  talk_.log().add_input(now(), "op", input, value);
  return true;
}

void LoggedBus::end_part(const Keys& keys) {
  if (part_) note(*std::exchange(part_, std::nullopt), keys);
}

void LoggedBus::note(const Part& part, const Keys& more) {
  const bool is_read = part.access == Access::kRead;
  TraceEvent event;
  event.dir = is_read ? "read" : "write";
  event.bytes = part.bytes;
  event.id = part.address.value;
  event.text = part.acks;
  Keys keys{{"op", event.dir},
            {"addr", std::int64_t{event.id}},
            {"hex", to_hex(part.bytes)},
            {"ack", part.acks}};
  keys.insert(keys.end(), more.begin(), more.end());
  talk_.add(part.begin, keys, is_read ? Direction::kFromDevice : Direction::kToDevice,
            bus_message_of(event));
}

}  // namespace armjig
