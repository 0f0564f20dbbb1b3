// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/logged_ports.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace armjig {
namespace {

using Keys = WireLog::Keys;
using Ending = BusPart::Ending;

/// What is known of the answers to a message of a transaction with so many.
std::string acks_of(const BusMessage& message, const Result<Transfer>& result, std::size_t count) {
  if (!result) return {};
  if (*result == Transfer::kDone) return std::string(1 + message.write.size(), 'A');
  if (count > 1) return {};
  return *result == Transfer::kAddressRefused ? "N" : "A";
}

class LoggedStream final : public StreamAround {
 public:
  LoggedStream(std::unique_ptr<StreamPort> port, std::shared_ptr<WireLog> log)
      : StreamAround{std::move(port)}, talk_{std::move(log), LinkKind::kStream} {}

  Result<void> write(Bytes bytes) override {
    const auto written = inner().write(bytes);
    if (written) talk_.add(now(), Direction::kToDevice, bytes);
    return written;
  }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    const auto size = inner().read(into, deadline);
    if (size && *size > 0) {
      talk_.add(now(), Direction::kFromDevice, into.first(*size));
    }
    return size;
  }
  bool touch(std::string_view input, std::int64_t value) override {
    if (!inner().touch(input, value)) return false;
    talk_.log().add_input(now(), "dir", input, value);
    return true;
  }

 private:
  WireLog::Talk talk_;
};

class LoggedSession final : public SessionAround {
 public:
  LoggedSession(std::unique_ptr<SessionPort> port, std::shared_ptr<WireLog> log)
      : SessionAround{std::move(port)}, log_{std::move(log)} {}
  ~LoggedSession() override { write_end("client-close"); }

  Result<void> connect(Instant deadline) override {
    const auto connected = inner().connect(deadline);
    const bool is_refused = !connected && connected.error().code == ErrorCode::kRefused;
    if (!connected && !is_refused) return connected;
    connection_ = log_->next_connection();
    is_open_ = !is_refused;
    talk_.emplace(log_, LinkKind::kSession, connection_);
    write_border("connect", is_refused ? "refused" : "ok");
    return connected;
  }
  Result<void> send(Bytes segment) override {
    const auto sent = inner().send(segment);
    if (sent) write_bytes(Direction::kToDevice, segment);
    return sent;
  }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
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
  void half_close() override {
    inner().half_close();
    if (is_open_) write_border("disconnect", "client-half-close");
  }
  void close() override {
    inner().close();
    write_end("client-close");
  }
  void reset() override {
    inner().reset();
    write_end("client-reset");
  }

 private:
  void write_end(std::string_view how) {
    if (std::exchange(is_open_, false)) write_border("disconnect", how);
  }
  void write_border(std::string_view direction, std::string_view how) {
    log_->add_border(now(), connection_, direction, how);
  }
  void write_bytes(Direction direction, Bytes bytes) { talk_->add(now(), direction, bytes); }

  std::shared_ptr<WireLog> log_;
  std::optional<WireLog::Talk> talk_;  ///< of the connection
  std::uint32_t connection_ = 0;
  bool is_open_ = false;
};

class LoggedSource final : public SourceAround {
 public:
  LoggedSource(std::unique_ptr<SessionSource> inner, std::shared_ptr<WireLog> log)
      : SourceAround{std::move(inner),
                     [this](std::unique_ptr<SessionPort> port) {
                       return put_log_on(std::move(port), log_);
                     }},
        log_{std::move(log)} {}

  bool touch(std::string_view input, std::int64_t value) override {
    if (!SourceAround::touch(input, value)) return false;
    log_->add_input(now(), "dir", input, value);
    return true;
  }

 private:
  std::shared_ptr<WireLog> log_;
};

class LoggedBus final : public BusAround {
 public:
  LoggedBus(std::unique_ptr<BusPort> port, std::shared_ptr<WireLog> log)
      : BusAround{std::move(port)}, talk_{std::move(log), LinkKind::kBus} {}
  ~LoggedBus() override { end_part(Ending::kNextStart); }

  Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    if (has_operations()) return BusPort::transfer(messages);
    const auto begin = now();
    const auto result = inner().transfer(messages);
    Keys refused;
    if (result && *result != Transfer::kDone) {
      refused.push_back({"refused", *result == Transfer::kAddressRefused ? "address" : "byte"});
    }
    for (const auto& message : messages) {
      const bool was_read = result && *result == Transfer::kDone;
      const auto bytes = message.access == Access::kWrite ? message.write
                         : was_read                       ? Bytes{message.read}
                                                          : Bytes{};
      Part part{begin, message.address, message.access, {bytes.begin(), bytes.end()}};
      part.acks = acks_of(message, result, messages.size());
      note(part, &message == &messages.back() ? Ending::kStop : Ending::kNextStart,
           result ? std::nullopt : std::optional{result.error().code}, refused);
    }
    return result;
  }
  Result<Ack> start(BusAddress address, Access access) override {
    end_part(Ending::kNextStart);
    part_ = Part{.begin = now(), .address = address, .access = access};
    const auto reply = inner().start(address, access);
    if (reply) {
      part_->acks += *reply == Ack::kAck ? 'A' : 'N';
    } else {
      end_part(Ending::kStop, reply.error().code);
    }
    return reply;
  }
  Result<Ack> write(std::byte byte) override {
    const auto reply = inner().write(byte);
    if (!reply) {
      end_part(Ending::kStop, reply.error().code);
    } else if (part_) {
      part_->bytes.push_back(byte);
      part_->acks += *reply == Ack::kAck ? 'A' : 'N';
    }
    return reply;
  }
  Result<std::byte> read(Ack reply) override {
    const auto byte = inner().read(reply);
    if (!byte) {
      end_part(Ending::kStop, byte.error().code);
    } else if (part_) {
      part_->bytes.push_back(*byte);
    }
    return byte;
  }
  Result<void> stop() override {
    const auto stopped = inner().stop();
    end_part(Ending::kStop, stopped ? std::nullopt : std::optional{stopped.error().code});
    return stopped;
  }
  Result<void> recover() override {
    end_part(Ending::kNextStart);
    const auto begin = now();
    const auto recovered = inner().recover();
    Keys keys{{"op", "recover"}};
    if (!recovered) keys.push_back({"error", std::string{describe(recovered.error().code)}});
    talk_.log().add_event(begin, keys);
    return recovered;
  }
  bool touch(std::string_view input, std::int64_t value) override {
    if (!inner().touch(input, value)) return false;
    end_part(Ending::kNextStart);
    talk_.log().add_input(now(), "op", input, value);
    return true;
  }

 private:
  /// From a start to the next one, or to the stop.
  struct Part {
    Instant begin{};
    BusAddress address{};
    Access access{};
    std::vector<std::byte> bytes{};
    std::string acks{};  ///< `A` or `N` for each byte that was answered
  };

  void end_part(Ending ending, std::optional<ErrorCode> error = {}) {
    if (part_) note(*std::exchange(part_, std::nullopt), ending, error);
  }
  void note(const Part& part, Ending ending, std::optional<ErrorCode> error,
            const Keys& more = {}) {
    talk_.add({.begin = part.begin,
               .end = now(),
               .address = part.address.value,
               .is_read = part.access == Access::kRead,
               .bytes = part.bytes,
               .acks = part.acks,
               .ending = ending,
               .error = error},
              more);
  }

  WireLog::Talk talk_;
  std::optional<Part> part_;
};

}  // namespace

std::unique_ptr<StreamPort> put_log_on(std::unique_ptr<StreamPort> port,
                                       std::shared_ptr<WireLog> log) {
  return std::make_unique<LoggedStream>(std::move(port), std::move(log));
}
std::unique_ptr<SessionPort> put_log_on(std::unique_ptr<SessionPort> port,
                                        std::shared_ptr<WireLog> log) {
  return std::make_unique<LoggedSession>(std::move(port), std::move(log));
}
std::unique_ptr<SessionSource> put_log_on(std::unique_ptr<SessionSource> source,
                                          std::shared_ptr<WireLog> log) {
  return std::make_unique<LoggedSource>(std::move(source), std::move(log));
}
std::unique_ptr<BusPort> put_log_on(std::unique_ptr<BusPort> port, std::shared_ptr<WireLog> log) {
  return std::make_unique<LoggedBus>(std::move(port), std::move(log));
}

}  // namespace armjig
