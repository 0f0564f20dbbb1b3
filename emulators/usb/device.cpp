// SPDX-License-Identifier: Apache-2.0
#include "emulators/usb/device.hpp"

#include <algorithm>
#include <utility>

namespace armjig::usb {
namespace {

// Of a setup's type.
constexpr std::uint8_t kKind = 0x60;  // 0: standard
constexpr std::uint8_t kRecipient = 0x1F;
enum Recipient : std::uint8_t { kToDevice = 0, kToInterface = 1, kToEndpoint = 2 };

// Standard requests (USB 2.0, table 9-4).
enum Request : std::uint8_t {
  kGetStatus = 0,
  kClearFeature = 1,
  kSetFeature = 3,
  kSetAddress = 5,
  kGetDescriptor = 6,
  kGetConfiguration = 8,
  kSetConfiguration = 9,
  kGetInterface = 10,
  kSetInterface = 11,
};
constexpr std::uint16_t kEndpointHalt = 0;

ControlReply reply_of(std::initializer_list<std::uint8_t> bytes) {
  ControlReply reply;
  for (const auto byte : bytes) reply.bytes.push_back(static_cast<std::byte>(byte));
  return reply;
}

std::optional<ControlReply> reply_if(bool is_done) {
  return is_done ? std::optional{ControlReply{}} : std::nullopt;
}

std::uint8_t low_byte(std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFFU); }

}  // namespace

void Device::submit(Instant time, Transfer transfer) {
  if ((transfer.endpoint & ~kIn) == 0) return control(time, transfer);
  const auto* const endpoint = find_endpoint(description(), transfer.endpoint);
  if (endpoint == nullptr || configuration_ == 0 || !has_room_for(transfer)) {
    return end(transfer, Status::kInvalid);
  }
  if (halted_.contains(transfer.endpoint)) return end(transfer, Status::kStalled);
  queues_[transfer.endpoint].push_back({.transfer = std::move(transfer)});
  advance();
}

bool Device::cancel(std::uint64_t id) {
  for (auto& [address, queue] : queues_) {
    const auto found =
        std::ranges::find(queue, id, [](const Waiting& one) { return one.transfer.id; });
    if (found == queue.end()) continue;
    // What the device gave for it already is not lost.
    end(found->transfer, Status::kCancelled, found->passed + found->received.size(),
        std::move(found->received));
    queue.erase(found);
    return true;
  }
  const auto late =
      std::ranges::find(ended_, id, [](const Ended& one) { return one.completion.id; });
  if (late == ended_.end()) return false;
  late->completion = {.id = id,
                      .endpoint = late->completion.endpoint,
                      .setup = late->completion.setup,
                      .status = Status::kCancelled};
  return true;
}

void Device::advance() {
  if (is_advancing_) {
    is_asked_again_ = true;
    return;
  }
  is_advancing_ = true;
  do {
    is_asked_again_ = false;
    for (auto& [address, queue] : queues_) {
      const auto* const endpoint = find_endpoint(description(), address);
      while (!queue.empty() && step(*endpoint, queue)) continue;
    }
  } while (is_asked_again_);
  is_advancing_ = false;
}

void Device::reset(Instant time) {
  (void)configure(0);
  function_.reset(time);
}

void Device::unplug(Instant time) {
  reset(time);
  ended_.clear();
}

bool Device::configure(std::uint8_t value) {
  if (value > kConfiguration) return false;
  configuration_ = value;
  halted_.clear();
  for (auto& [address, queue] : queues_) end_all(queue, Status::kCancelled);
  return true;
}

std::optional<Completion> Device::next(Instant time) {
  if (ended_.empty() || ended_.front().due > time) return std::nullopt;
  auto completion = std::move(ended_.front().completion);
  ended_.pop_front();
  return completion;
}

std::optional<Instant> Device::next_due() const {
  if (ended_.empty()) return std::nullopt;
  return ended_.front().due;
}

bool Device::has_room_for(const Transfer& transfer) const {
  std::size_t count = 1;
  std::size_t bytes = transfer.bytes.size();
  for (const auto& [address, queue] : queues_) {
    count += queue.size();
    for (const auto& waiting : queue) bytes += waiting.transfer.bytes.size();
  }
  return count <= kMostTransfers && bytes <= kMostBytes;
}

// Packets.

bool Device::step(const Endpoint& endpoint, Queue& queue) {
  return is_in(endpoint.address) ? step_in(endpoint, queue) : step_out(endpoint, queue);
}

/// One packet to the device. False: it does not take it now.
bool Device::step_out(const Endpoint& endpoint, Queue& queue) {
  auto& waiting = queue.front();
  const auto rest = Bytes{waiting.transfer.bytes}.subspan(waiting.passed);
  const auto packet = rest.first(std::min<std::size_t>(rest.size(), endpoint.packet_size));
  if (!function_.take(endpoint.address, packet)) return false;
  waiting.passed += packet.size();
  if (waiting.passed < waiting.transfer.bytes.size()) return true;
  end(waiting.transfer, Status::kDone, waiting.passed);
  queue.pop_front();
  return true;
}

/// One packet from the device. False: it has none now.
bool Device::step_in(const Endpoint& endpoint, Queue& queue) {
  auto& waiting = queue.front();
  const auto room = waiting.transfer.room - waiting.received.size();
  if (room > 0) {
    const auto packet = function_.give(endpoint.address);
    if (!packet) return false;
    const auto taken = std::min(packet->size(), room);
    waiting.received.insert(waiting.received.end(), packet->begin(),
                            packet->begin() + static_cast<std::ptrdiff_t>(taken));
    const bool is_last = packet->size() < endpoint.packet_size || taken == room;
    if (packet->size() <= room && !is_last) return true;
    const auto status = packet->size() <= room ? Status::kDone : Status::kBabbled;
    const auto size = waiting.received.size();
    end(waiting.transfer, status, size, std::move(waiting.received));
  } else {
    end(waiting.transfer, Status::kDone);
  }
  queue.pop_front();
  return true;
}

// Requests.

void Device::control(Instant time, const Transfer& transfer) {
  const bool is_read = is_in(transfer.setup.type);
  const bool is_well_formed = is_read ? is_in(transfer.endpoint) || transfer.setup.length == 0
                                      : transfer.bytes.size() == transfer.setup.length;
  if (!is_well_formed) return end(transfer, Status::kInvalid);
  auto reply = answer(time, transfer);
  if (!reply) return end(transfer, Status::kStalled);
  if (is_read) {
    const auto room = std::min<std::size_t>(transfer.room, transfer.setup.length);
    reply->bytes.resize(std::min(reply->bytes.size(), room));
  }
  if (!is_read) reply->bytes.clear();
  const auto size = is_read ? reply->bytes.size() : transfer.bytes.size();
  end(transfer, Status::kDone, size, std::move(reply->bytes), reply->due);
  advance();  // what was asked for may have made it ready
}

std::optional<ControlReply> Device::answer(Instant time, const Transfer& transfer) {
  if ((transfer.setup.type & kKind) == 0) return standard(transfer.setup);
  return function_.control(time, transfer.setup, transfer.bytes);
}

std::optional<ControlReply> Device::standard(const Setup& setup) {
  switch (setup.request) {
    case kGetStatus:
      return status(setup);
    case kClearFeature:
    case kSetFeature:
      return reply_if(feature(setup));
    case kSetAddress:  // between the host's controller and the cable
      return ControlReply{};
    case kGetDescriptor:
      return descriptor(setup);
    case kGetConfiguration:
      return reply_of({configuration_});
    case kSetConfiguration:
      return reply_if(setup.value <= kConfiguration && configure(low_byte(setup.value)));
    case kGetInterface:
      return reply_of({0});
    case kSetInterface:  // each has one setting
      return reply_if(setup.value == 0 && setup.index < description().interfaces.size());
    default:
      return std::nullopt;
  }
}

std::optional<ControlReply> Device::descriptor(const Setup& setup) const {
  enum Wanted : std::uint8_t { kOfDevice = 1, kOfConfiguration = 2, kOfString = 3 };
  if ((setup.type & kRecipient) != kToDevice) return std::nullopt;
  switch (setup.value >> 8U) {
    case kOfDevice:
      return ControlReply{device_descriptor(description())};
    case kOfConfiguration:
      if (low_byte(setup.value) != 0) return std::nullopt;
      return ControlReply{configuration_descriptor(description())};
    case kOfString: {
      auto text = string_descriptor(description(), low_byte(setup.value));
      if (!text) return std::nullopt;
      return ControlReply{*std::move(text)};
    }
    default:
      return std::nullopt;
  }
}

std::optional<ControlReply> Device::status(const Setup& setup) const {
  const bool is_halted =
      (setup.type & kRecipient) == kToEndpoint && halted_.contains(low_byte(setup.index));
  return reply_of({static_cast<std::uint8_t>(is_halted ? 1 : 0), 0});
}

bool Device::feature(const Setup& setup) {
  const auto address = low_byte(setup.index);
  if ((setup.type & kRecipient) != kToEndpoint || setup.value != kEndpointHalt) return false;
  if (find_endpoint(description(), address) == nullptr) return false;
  if (setup.request == kClearFeature) {
    halted_.erase(address);
  } else {
    halted_.insert(address);
    end_all(queues_[address], Status::kStalled);
  }
  return true;
}

// Ends.

void Device::end(const Transfer& transfer, Status status, std::size_t size,
                 std::vector<std::byte> bytes, Instant due) {
  // Answers are told in their order, so none is told before one that ended earlier.
  if (!ended_.empty()) due = std::max(due, ended_.back().due);
  ended_.push_back({{.id = transfer.id,
                     .endpoint = transfer.endpoint,
                     .setup = transfer.setup,
                     .status = status,
                     .size = size,
                     .bytes = std::move(bytes)},
                    due});
}

void Device::end_all(Queue& queue, Status status) {
  for (auto& waiting : queue) end(waiting.transfer, status);
  queue.clear();
}

}  // namespace armjig::usb
