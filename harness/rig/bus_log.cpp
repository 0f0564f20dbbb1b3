// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/bus_log.hpp"

#include <fmt/core.h>

#include <utility>

#include "harness/capture/trace.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

/// Keys of a line, each behind a comma.
constexpr std::string_view kWithStop;
constexpr std::string_view kWithoutStop = R"(,"stop":false)";

std::string failed(ErrorCode code) { return fmt::format(R"(,"error":"{}")", describe(code)); }

std::string_view refused(Transfer transfer) noexcept {
  if (transfer == Transfer::kDone) return {};
  return transfer == Transfer::kAddressRefused ? R"(,"refused":"address")" : R"(,"refused":"byte")";
}

/// What is known of the answers to a message of a transaction with so many.
std::string acks_of(const BusMessage& message, const Result<Transfer>& result, std::size_t count) {
  if (!result) return {};
  if (*result == Transfer::kDone) return std::string(1 + message.write.size(), 'A');
  if (count > 1) return {};
  return *result == Transfer::kAddressRefused ? "N" : "A";
}

}  // namespace

Outcome<std::unique_ptr<BusPort>> LoggedBus::log(std::unique_ptr<BusPort> port,
                                                 const std::string& path,
                                                 const DissectorEntry& device) {
  auto file = LogFile::create(path, device.device);
  if (!file) return tl::unexpected{file.error()};
  return std::unique_ptr<BusPort>{new LoggedBus{std::move(port), *std::move(file), device.make()}};
}

LoggedBus::LoggedBus(std::unique_ptr<BusPort> port, LogFile file,
                     std::unique_ptr<Dissector> dissector)
    : port_{std::move(port)}, file_{std::move(file)}, dissector_{std::move(dissector)} {}

LoggedBus::~LoggedBus() { end_part(kWithoutStop); }

Result<Transfer> LoggedBus::transfer(std::span<const BusMessage> messages) {
  if (has_operations()) return BusPort::transfer(messages);
  const auto begin = now();
  const auto result = port_->transfer(messages);
  const auto outcome = result ? std::string{refused(*result)} : failed(result.error().code);
  for (const auto& message : messages) {
    const bool is_last = &message == &messages.back();
    const bool was_read = result && *result == Transfer::kDone;
    const auto bytes = message.access == Access::kWrite ? message.write
                       : was_read                       ? Bytes{message.read}
                                                        : Bytes{};
    note({begin,
          message.address,
          message.access,
          {bytes.begin(), bytes.end()},
          acks_of(message, result, messages.size())},
         outcome + std::string{is_last ? kWithStop : kWithoutStop});
  }
  return result;
}

Result<Ack> LoggedBus::start(BusAddress address, Access access) {
  end_part(kWithoutStop);
  part_ = Part{.begin = now(), .address = address, .access = access};
  const auto reply = port_->start(address, access);
  if (reply) {
    part_->acks += *reply == Ack::kAck ? 'A' : 'N';
  } else {
    end_part(failed(reply.error().code));
  }
  return reply;
}

Result<Ack> LoggedBus::write(std::byte byte) {
  const auto reply = port_->write(byte);
  if (!reply) {
    end_part(failed(reply.error().code));
  } else if (part_) {
    part_->bytes.push_back(byte);
    part_->acks += *reply == Ack::kAck ? 'A' : 'N';
  }
  return reply;
}

Result<std::byte> LoggedBus::read(Ack reply) {
  const auto byte = port_->read(reply);
  if (!byte) {
    end_part(failed(byte.error().code));
  } else if (part_) {
    part_->bytes.push_back(*byte);
  }
  return byte;
}

Result<void> LoggedBus::stop() {
  const auto stopped = port_->stop();
  end_part(stopped ? std::string{kWithStop} : failed(stopped.error().code));
  return stopped;
}

Result<void> LoggedBus::recover() {
  end_part(kWithoutStop);
  const auto begin = now();
  const auto recovered = port_->recover();
  file_.add(begin,
            R"("op":"recover")" + (recovered ? std::string{} : failed(recovered.error().code)));
  return recovered;
}

bool LoggedBus::touch(std::string_view input, std::int64_t value) {
  if (!port_->touch(input, value)) return false;
  end_part(kWithoutStop);
  file_.add(now(), fmt::format(R"("op":"input","name":"{}","value":{})", input, value));
  return true;
}

void LoggedBus::end_part(std::string_view keys) {
  if (part_) note(*std::exchange(part_, std::nullopt), keys);
}

void LoggedBus::note(const Part& part, std::string_view keys) {
  const bool is_read = part.access == Access::kRead;
  TraceEvent event;
  event.dir = is_read ? "read" : "write";
  event.bytes = part.bytes;
  event.id = part.address.value;
  event.text = part.acks;
  std::vector<Message> messages;
  const auto acknowledged = bus_message_of(event);
  if (!acknowledged.empty()) {
    dissector_->feed(is_read ? Direction::kFromDevice : Direction::kToDevice, part.begin,
                     acknowledged, messages);
  }
  file_.add(part.begin,
            fmt::format(R"("op":"{}","addr":{},"hex":"{}","ack":"{}"{})", event.dir, event.id,
                        to_hex(part.bytes), part.acks, keys),
            messages);
}

}  // namespace armjig
