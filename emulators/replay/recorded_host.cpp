// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/recorded_host.hpp"

#include <algorithm>
#include <utility>

#include "emulators/memory/clocked.hpp"

namespace armjig {
AnyHosted clone(const AnyHosted& device) {
  return std::visit([](const auto& held) -> AnyHosted { return held->clone(); }, device);
}

bool is_by_host(const KeptRecord& record) {
  if (record.kind == LinkKind::kBus) return true;  // the master reads, too
  if (record.kind != LinkKind::kEvents) return record.direction == Direction::kToDevice;
  return !text_in(record, "text").starts_with("device-");
}

RecordedHost::RecordedHost(AnyHosted device, TouchesOf touches_of, Duration lead)
    : device_{std::move(device)}, touches_of_{touches_of}, lead_{lead} {
  auto* const server = std::get_if<std::unique_ptr<HostedServer>>(&device_);
  if (server == nullptr) return;
  const auto listening = wait_until_listening(**server);
  *server = put_on_clock(std::move(*server), {.begin = listening});
}

RecordedHost::RecordedHost(const RecordedHost& like, AnyHosted device)
    : device_{std::move(device)},
      touches_of_{like.touches_of_},
      lead_{like.lead_},
      now_{like.now_},
      is_idle_{like.is_idle_},
      connections_{like.connections_} {}

void RecordedHost::play(const KeptRecord& record) {
  if (!is_by_host(record)) return;
  const bool is_stream = record.kind == LinkKind::kStream;
  advance_to(is_stream ? record.time - lead_ : record.time);
  if (record.kind == LinkKind::kEvents || record.kind == LinkKind::kCan) {
    play_event(record);
  } else {
    std::visit([&](const auto& device) { play_on(*device, record); }, device_);
  }
  clear_sent();
}

void RecordedHost::advance_to(Instant time) {
  if (time < now_) return;
  now_ = time;
  std::visit([this](const auto& device) { device->advance_to(now_); }, device_);
  clear_sent();
}

void RecordedHost::clear_sent() {
  std::visit(
      [](const auto& device) {
        if constexpr (requires { device->clear_sent(); }) device->clear_sent();
      },
      device_);
}

AnyHosted RecordedHost::leave() && {
  if (auto* const server = std::get_if<std::unique_ptr<HostedServer>>(&device_)) {
    for (const auto& [number, id] : connections_) (*server)->close(now_, id);
    advance_to(now_);
  }
  return std::move(device_);
}

void RecordedHost::play_on(HostedStream& device, const KeptRecord& record) {
  device.receive(now_, record.bytes);
}

void RecordedHost::play_on(HostedServer& device, const KeptRecord& record) {
  auto found = connections_.find(record.id);
  if (found == connections_.end()) {  // it has it from its middle on
    const auto id = device.connect(now_);
    if (!id) return;
    found = connections_.emplace(record.id, *id).first;
  }
  device.receive(now_, found->second, record.bytes);
}

void RecordedHost::play_on(HostedBus& device, const KeptRecord& record) {
  const bool is_read = record.direction == Direction::kFromDevice;
  auto reply = device.start(now_, static_cast<std::uint8_t>(record.id), is_read);
  const auto wanted = std::max<std::int64_t>(static_cast<std::int64_t>(record.bytes.size()),
                                             is_read ? number_in(record, "n", 0) : 0);
  for (std::int64_t i = 0; i < wanted && reply.outcome == BusReply::Outcome::kAck; ++i) {
    reply = is_read ? device.read(reply.end)
                    : device.write(reply.end, record.bytes[static_cast<std::size_t>(i)]);
  }
  is_idle_ = has_stop(record);
  if (is_idle_) reply = device.stop(reply.end);
  now_ = std::max(now_, reply.end);
}

void RecordedHost::play_event(const KeptRecord& record) {
  if (auto* const server = std::get_if<std::unique_ptr<HostedServer>>(&device_)) {
    if (play_border(**server, record)) return;
  }
  for (const auto& [name, value] : touches_of(record, touches_of_)) {
    std::visit([&](const auto& device) { (void)device->set_input(now_, name, value); }, device_);
  }
}

bool RecordedHost::play_border(HostedServer& server, const KeptRecord& record) {
  const auto what = what_of(record);
  const auto number = static_cast<std::uint32_t>(number_in(record, "conn", 0));
  if (what == "connect") {
    if (const auto id = server.connect(now_)) connections_[number] = *id;
    return true;
  }
  const auto found = connections_.find(number);
  if (what != "disconnect" || found == connections_.end()) return false;
  const auto how = text_in(record, "text");
  if (how == "client-half-close") {
    server.half_close(now_, found->second);
    return true;
  }
  how == "client-reset" ? server.reset(now_, found->second) : server.close(now_, found->second);
  connections_.erase(found);
  return true;
}

}  // namespace armjig
