// SPDX-License-Identifier: Apache-2.0
#include "emulators/shadow/shadow.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "harness/compare/likeness.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

constexpr std::string_view kEnded = "end of the connection";

std::string name_of(const Message& message) {
  return message.name.empty() ? to_hex(message.raw) : std::string{message.name};
}

RecordedMessage end_message(Instant time) {
  return {{.direction = Direction::kFromDevice, .time = time, .name = kEnded}, {}, {}};
}

/// A bus transaction's part, done to the twin.
struct TwinPart {
  std::vector<std::byte> bytes;
  std::string acks;
};

TwinPart pass(HostedBus& bus, const BusPart& part) {
  TwinPart twin;
  const auto note = [&twin](const BusReply& reply) {
    twin.acks += reply.outcome == BusReply::Outcome::kAck ? 'A' : 'N';
    return reply.outcome == BusReply::Outcome::kAck;
  };
  auto reply = bus.start(part.begin, part.address, part.is_read);
  bool is_acked = note(reply);
  for (std::size_t i = 0; i < part.bytes.size() && is_acked; ++i) {
    if (part.is_read) {
      reply = bus.read(reply.end);
      twin.bytes.push_back(reply.byte);
    } else {
      reply = bus.write(reply.end, part.bytes[i]);
      twin.bytes.push_back(part.bytes[i]);
      is_acked = note(reply);
    }
  }
  if (part.ending == BusPart::Ending::kStop) (void)bus.stop(std::max(part.end, reply.end));
  return twin;
}

}  // namespace

std::string describe(const Divergence& divergence) {
  const auto& first = divergence.device ? *divergence.device : *divergence.twin;
  auto text = fmt::format("{:.6f} s{}{}: '{}' ",
                          std::chrono::duration<double>{divergence.time.time_since_epoch()}.count(),
                          divergence.lane.empty() ? "" : ", ", divergence.lane, name_of(first));
  if (divergence.change == Change::kMissing) return text + "comes from the emulated one only";
  if (divergence.change == Change::kExtra) return text + "comes from the device only";
  text += "differs (device, emulated)";
  for (std::size_t i = 0; i < divergence.what.size(); ++i) {
    text += (i == 0 ? ": " : "; ") + divergence.what[i];
  }
  return text;
}

Shadow::Shadow(AnyHosted twin, MakeDissector make_dissector, ComparisonRules rules,
               Listener listener)
    : twin_{std::move(twin)},
      make_dissector_{make_dissector},
      rules_{std::move(rules)},
      listener_{std::move(listener)} {
  auto* const server = std::get_if<std::unique_ptr<HostedServer>>(&twin_);
  if (server != nullptr) now_ = wait_until_listening(**server);
}

void Shadow::to_device(Instant time, Bytes bytes) {
  lead_to(time);
  catch_up();
  hear_host(time, 0, bytes);
  if (auto* const stream = std::get_if<std::unique_ptr<HostedStream>>(&twin_)) {
    (*stream)->receive(now_, bytes);
    take_sent(**stream);
  }
}

void Shadow::from_device(Instant time, Bytes bytes) {
  lead_to(time);
  hear(lane_of(0).device, time, Direction::kFromDevice, bytes, {});
  match(lane_of(0), now_);
}

void Shadow::on_connection(const ConnectionEvent& event) {
  using Kind = ConnectionEvent::Kind;
  lead_to(event.time);
  auto* const held = std::get_if<std::unique_ptr<HostedServer>>(&twin_);
  if (held == nullptr) return;
  auto& server = **held;
  const auto id = event.connection;
  if (event.kind == Kind::kBegun) {
    if (const auto number = server.connect(now_)) {
      connections_[id] = *number;
      devices_[*number] = id;
    }
  } else if (event.kind == Kind::kFromServer) {
    hear(lane_of(id).device, event.time, Direction::kFromDevice, event.bytes, {});
  } else if (event.kind == Kind::kDropped) {
    lane_of(id).device.said.push_back(end_message(event.time));
    ++counts_.messages;
  } else if (const auto found = connections_.find(id); found != connections_.end()) {
    catch_up();
    if (event.kind == Kind::kToServer) {
      hear_host(event.time, id, event.bytes);
      server.receive(now_, found->second, event.bytes);
    } else if (event.kind == Kind::kHalfClosed) {
      server.half_close(now_, found->second);
    } else {
      event.kind == Kind::kReset ? server.reset(now_, found->second)
                                 : server.close(now_, found->second);
      lanes_.erase(id);  // who has gone hears nothing more
      devices_.erase(found->second);
      connections_.erase(found);
      return;
    }
  }
  take_sent(server);
  match(lane_of(id), now_);
}

void Shadow::on_bus(const BusPart& part) {
  auto* const bus = std::get_if<std::unique_ptr<HostedBus>>(&twin_);
  if (bus == nullptr) return;
  const auto twin = pass(**bus, part);
  auto other = part;
  other.bytes = twin.bytes;
  other.acks = twin.acks;
  auto& lane = lane_of(part.address);
  const auto direction = part.is_read ? Direction::kFromDevice : Direction::kToDevice;
  hear(lane.device, part.end, direction, acknowledged(part), std::string{part.acks});
  hear(lane.twin, part.end, direction, acknowledged(other), twin.acks);
  now_ = std::max(now_, part.end);
  match(lane, now_);
}

void Shadow::on_input(Instant time, std::string_view name, std::int64_t value) {
  lead_to(time);
  std::visit([&](const auto& device) { (void)device->set_input(now_, name, value); }, twin_);
}

void Shadow::wait_until(Instant time) {
  lead_to(time);
  for (auto& [id, lane] : lanes_) match(lane, now_);
}

void Shadow::finish() {
  for (auto& [id, lane] : lanes_) {
    // What the device said last may still have been on its way from the twin.
    while (!lane.device.said.empty() && !lane.twin.said.empty() &&
           match_first(lane, now_ + 2 * rules_.time_tolerance)) {
    }
  }
}

Shadow::Lane& Shadow::lane_of(std::uint32_t id) {
  const auto [found, is_new] = lanes_.try_emplace(id);
  if (is_new) {
    found->second.device.dissector = make_dissector_();
    found->second.twin.dissector = make_dissector_();
    if (std::holds_alternative<std::unique_ptr<HostedServer>>(twin_)) {
      found->second.name = fmt::format("connection {}", id);
    } else if (std::holds_alternative<std::unique_ptr<HostedBus>>(twin_)) {
      found->second.name = fmt::format("address {:02X}", id);
    }
  }
  return found->second;
}

/// Some messages can only be told apart by what was asked.
void Shadow::hear_host(Instant time, std::uint32_t id, Bytes bytes) {
  auto& lane = lane_of(id);
  std::vector<Message> asked;
  for (auto* const side : {&lane.device, &lane.twin}) {
    side->dissector->feed(Direction::kToDevice, time, bytes, asked);
  }
}

void Shadow::hear(Side& side, Instant time, Direction direction, Bytes bytes,
                  const std::string& note) {
  std::vector<Message> messages;
  if (!bytes.empty()) side.dissector->feed(direction, time, bytes, messages);
  if (messages.empty() && !note.empty()) {  // nobody answered
    messages.push_back({.direction = direction, .time = time, .name = "transaction"});
  }
  std::erase_if(messages, [this](const Message& one) { return rules_.ignores(one.name); });
  for (auto& message : messages) side.said.push_back({std::move(message), note, {}});
  for (auto& [id, lane] : lanes_) {
    if (&lane.device == &side) counts_.messages += messages.size();
  }
}

void Shadow::lead_to(Instant time) {
  now_ = std::max(now_, time);
  std::visit(
      [this](const auto& device) {
        device->advance_to(now_);
        take_sent(*device);
      },
      twin_);
}

void Shadow::catch_up() {
  while (const auto latest = owes_until()) {
    const auto next = std::visit([](const auto& device) { return device->next_event(); }, twin_);
    if (!next || *next > *latest) return;
    lead_to(*next);
    for (auto& [id, lane] : lanes_) match(lane, now_);
  }
}

/// How long the twin may take to say what the device has said.
std::optional<Instant> Shadow::owes_until() const {
  for (const auto& [id, lane] : lanes_) {
    for (const auto& one : lane.device.said) {
      const auto is_said = std::ranges::any_of(lane.twin.said, [&](const RecordedMessage& other) {
        return other.message.name == one.message.name;
      });
      if (!is_said) return one.message.time + rules_.time_tolerance;
    }
  }
  return std::nullopt;
}

template <class Device>
void Shadow::take_sent(Device& device) {
  if constexpr (requires { device.sent(); }) {
    for (const auto& one : device.sent()) {
      if constexpr (requires { one.connection; }) {
        const auto id = devices_.find(one.connection);
        if (id == devices_.end()) continue;
        auto& side = lane_of(id->second).twin;
        if (one.kind == SessionEvent::Kind::kData) {
          hear(side, one.time, Direction::kFromDevice, one.bytes, {});
        } else {
          side.said.push_back(end_message(one.time));
        }
      } else {
        hear(lane_of(0).twin, one.time, Direction::kFromDevice, one.bytes, {});
      }
    }
    device.clear_sent();
  }
}

void Shadow::match(Lane& lane, Instant now) {
  while (!lane.device.said.empty() && match_first(lane, now)) {
  }
  // What the device should have said by now.
  while (lane.device.said.empty() && !lane.twin.said.empty() &&
         lane.twin.said.front().message.time + rules_.time_tolerance < now) {
    tell(lane, Change::kMissing, nullptr, &lane.twin.said.front());
    lane.twin.said.pop_front();
  }
}

/// Judges the first thing that the device said. False: it is too early for that.
bool Shadow::match_first(Lane& lane, Instant now) {
  const Likeness likeness{rules_};
  auto& said = lane.device.said;
  auto& twin = lane.twin.said;
  const auto& one = said.front();
  const auto equal = std::ranges::find_if(twin, [&](const RecordedMessage& other) {
    return likeness.is_in_time(one, other) && likeness.has_same_content(one, other);
  });
  if (equal != twin.end()) {
    if (!rules_.is_order_free) {
      for (auto i = equal - twin.begin(); i > 0; --i) {
        tell(lane, Change::kMissing, nullptr, &twin.front());
        twin.pop_front();
      }
    }
    take_pair(lane, rules_.is_order_free ? equal : twin.begin());
    agree(lane, one.message.time);
    said.pop_front();
    return true;
  }
  if (one.message.time + rules_.time_tolerance >= now) return false;
  const auto like = std::ranges::find_if(
      twin, [&](const RecordedMessage& other) { return other.message.name == one.message.name; });
  if (like == twin.end()) {
    tell(lane, Change::kExtra, &one, nullptr);
  } else {
    if (likeness.is_in_time(one, *like) && likeness.is_come_past_by(one, lane.paired, twin)) {
      agree(lane, one.message.time);
    } else {
      tell(lane, Change::kChanged, &one, &*like, likeness.differences(one, *like));
    }
    take_pair(lane, like);
  }
  said.pop_front();
  return true;
}

void Shadow::take_pair(Lane& lane, const std::deque<RecordedMessage>::iterator& twin) {
  while (!lane.paired.empty() &&
         lane.paired.front().message.time + 2 * rules_.time_tolerance < twin->message.time) {
    lane.paired.pop_front();
  }
  lane.paired.push_back(std::move(*twin));
  lane.twin.said.erase(twin);
}

void Shadow::agree(Lane& lane, Instant time) {
  if (lane.apart == 0) return;
  ++counts_.agreements;
  listener_.on_agreement(time, lane.name, std::exchange(lane.apart, 0));
}

void Shadow::tell(Lane& lane, Change change, const RecordedMessage* device,
                  const RecordedMessage* twin, std::vector<std::string> what) {
  ++counts_.divergences;
  ++lane.apart;
  Divergence divergence{.change = change, .lane = lane.name, .what = std::move(what)};
  divergence.time = (device != nullptr ? device : twin)->message.time;
  if (device != nullptr) divergence.device = device->message;
  if (twin != nullptr) divergence.twin = twin->message;
  listener_.on_divergence(divergence);
}

}  // namespace armjig
