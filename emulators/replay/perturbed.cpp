// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/perturbed.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <iterator>

#include "emulators/memory/hosted_around.hpp"

namespace armjig {
namespace {

using Kind = Perturbation::Kind;

/// A piece that waits for a time, or for the next one in its direction.
struct HeldPiece {
  std::optional<Instant> due;  ///< none: for the next one
  Direction direction{};
  ServerEvent what;
};

/// What a stream and a server have in common. `Link` says how bytes go in, and how what was sent
/// looks.
template <class Hosted, class Link>
class BehindGate : public hosted_by::SenderAround<Hosted> {
 public:
  using Sent = typename hosted_by::SenderAround<Hosted>::Sent;

  BehindGate(Gate& gate, std::unique_ptr<Hosted> device)
      : hosted_by::SenderAround<Hosted>{std::move(device)}, gate_{gate} {}

 protected:
  /// What is due before that, and what the device does before that, comes first.
  template <class Work>
  auto act(Instant time, Work work) {
    for (auto due = next_due(); due && *due <= time; due = next_due()) advance_inner_to(*due);
    advance_inner_to(time);
    return hosted_by::do_then([&] { return work(time); }, [&] { take(time); });
  }
  void pass(Instant time, ConnectionId id, Bytes bytes) {
    act(time, [&](Instant now) {
      const auto* const what = gate_.pass(now, Direction::kToDevice, bytes);
      ServerEvent piece{now, id, SessionEvent::Kind::kData, {bytes.begin(), bytes.end()}};
      decide(what, Direction::kToDevice, std::move(piece));
    });
  }
  [[nodiscard]] std::optional<Instant> next_due() const {
    std::optional<Instant> next;
    for (const auto& held : held_) {
      if (held.due && (!next || *held.due < *next)) next = held.due;
    }
    return next;
  }

 private:
  void advance_inner_to(Instant time) {
    this->device().advance_to(time);
    take(time);
  }
  void take(Instant time) {
    this->take_sent([this](const Sent& sent) {
      auto piece = Link::event_of(sent);
      const bool is_data = piece.kind == SessionEvent::Kind::kData;
      const auto* const what =
          is_data ? gate_.pass(piece.time, Direction::kFromDevice, piece.bytes) : nullptr;
      decide(what, Direction::kFromDevice, std::move(piece));
    });
    release(time);
  }
  void decide(const Perturbation* what, Direction direction, ServerEvent piece) {
    if (what == nullptr || what->kind == Kind::kTwice) {
      const auto time = piece.time;
      if (what != nullptr) deliver(direction, piece);
      deliver(direction, std::move(piece));
      let_pass(time, direction);
    } else if (what->kind != Kind::kLost) {
      const auto due = what->kind == Kind::kLate ? std::optional{piece.time + what->delay}
                                                 : std::optional<Instant>{};
      held_.push_back({due, direction, std::move(piece)});
    }
  }
  void deliver(Direction direction, ServerEvent piece) {
    if (direction == Direction::kFromDevice) {
      this->sent_.push_back(Link::sent_of(std::move(piece)));
    } else {
      Link::receive(this->device(), piece);
    }
  }
  /// What waited for the next one comes after it.
  void let_pass(Instant time, Direction direction) {
    release_if(time, [direction](const HeldPiece& held) {
      return !held.due && held.direction == direction;
    });
  }
  void release(Instant time) {
    release_if(time, [time](const HeldPiece& held) { return held.due && *held.due <= time; });
  }
  template <class IsOver>
  void release_if(Instant time, IsOver is_over) {
    std::vector<HeldPiece> over;
    std::ranges::copy_if(held_, std::back_inserter(over), is_over);
    if (over.empty()) return;
    std::erase_if(held_, is_over);
    for (auto& held : over) {
      held.what.time = held.due.value_or(time);
      deliver(held.direction, std::move(held.what));
    }
  }
  Gate& gate_;
  std::vector<HeldPiece> held_;
};

struct StreamLinkOfGate {
  static ServerEvent event_of(const SentBytes& sent) {
    return {sent.time, 0, SessionEvent::Kind::kData, sent.bytes};
  }
  static SentBytes sent_of(ServerEvent piece) { return {piece.time, std::move(piece.bytes)}; }
  static void receive(HostedStream& device, const ServerEvent& piece) {
    device.receive(piece.time, piece.bytes);
  }
};

struct ServerLinkOfGate {
  static ServerEvent event_of(const ServerEvent& sent) { return sent; }
  static ServerEvent sent_of(ServerEvent piece) { return piece; }
  static void receive(HostedServer& device, const ServerEvent& piece) {
    device.receive(piece.time, piece.connection, piece.bytes);
  }
};

/// What comes by itself may be something that was held.
template <class Layers>
class HoldingBack : public Layers {
 public:
  using Layers::Layers;

  [[nodiscard]] std::optional<Instant> next_event() const override {
    const auto next = Layers::next_event();
    const auto due = this->next_due();
    return next && due ? std::min(next, due) : (next ? next : due);
  }
};

class StreamBehindGate final
    : public HoldingBack<hosted_by::Stream<BehindGate<HostedStream, StreamLinkOfGate>>> {
 public:
  using HoldingBack::HoldingBack;
  void receive(Instant time, Bytes bytes) override { pass(time, 0, bytes); }
};

class ServerBehindGate final
    : public HoldingBack<hosted_by::Server<BehindGate<HostedServer, ServerLinkOfGate>>> {
 public:
  using HoldingBack::HoldingBack;
  void receive(Instant time, ConnectionId id, Bytes segment) override { pass(time, id, segment); }
};

/// A part of a bus transaction that the device has still to see.
struct BusPiece {
  std::uint8_t address{};
  bool is_read{};
  std::vector<std::byte> bytes{};  ///< written
  std::size_t read{};              ///< so many bytes
};

/// The gate of a bus, where nothing comes by itself.
class GateOfBus : public hosted_by::Around<HostedBus> {
 public:
  GateOfBus(Gate& gate, std::unique_ptr<HostedBus> device)
      : Around{std::move(device)}, gate_{gate} {}

 protected:
  [[nodiscard]] Gate& gate() noexcept { return gate_; }
  template <class Work>
  auto act(Instant time, Work work) {
    return work(time);
  }

 private:
  Gate& gate_;
};

class BusBehindGate final : public hosted_by::Bus<GateOfBus> {
 public:
  using Bus::Bus;

  BusReply start(Instant time, std::uint8_t address, bool is_read) override {
    const auto* const what = gate().pass(time, address, is_read);
    kind_ = what == nullptr ? std::nullopt : std::optional{what->kind};
    if (kind_ == Kind::kSwapped && is_read) kind_.reset();  // nobody knows yet what it reads
    current_ = {address, is_read};
    if (kind_ == Kind::kLost) return idle(time, BusReply::Outcome::kNack);
    if (kind_ == Kind::kSwapped) return idle(time, BusReply::Outcome::kAck);
    if (kind_ == Kind::kLate) time += what->delay;
    return device().start(time, address, is_read);
  }
  BusReply write(Instant time, std::byte byte) override {
    current_.bytes.push_back(byte);
    if (kind_ == Kind::kLost) return idle(time, BusReply::Outcome::kNack);
    if (kind_ == Kind::kSwapped) return idle(time, BusReply::Outcome::kAck);
    return device().write(time, byte);
  }
  BusReply read(Instant time) override {
    ++current_.read;
    if (kind_ != Kind::kLost) return device().read(time);
    auto reply = idle(time, BusReply::Outcome::kAck);
    reply.byte = std::byte{0xFF};
    return reply;
  }
  BusReply stop(Instant time) override {
    const auto kind = std::exchange(kind_, std::nullopt);
    if (kind == Kind::kSwapped) {
      later_.push_back(std::move(current_));
      return idle(time, BusReply::Outcome::kAck);
    }
    auto reply = device().stop(time);
    if (kind == Kind::kTwice) later_.push_back(std::move(current_));
    for (const auto& piece : std::exchange(later_, {})) reply.end = pass(reply.end, piece);
    return reply;
  }

 private:
  /// A byte's time on a bus of 100 kHz, in which the device sees nothing.
  static BusReply idle(Instant time, BusReply::Outcome outcome) {
    return {outcome, time + std::chrono::microseconds{90}, {}};
  }
  Instant pass(Instant time, const BusPiece& piece) {
    auto reply = device().start(time, piece.address, piece.is_read);
    for (const auto byte : piece.bytes) reply = device().write(reply.end, byte);
    for (std::size_t i = 0; i < piece.read; ++i) reply = device().read(reply.end);
    return device().stop(reply.end).end;
  }

  std::optional<Kind> kind_;  ///< of the part that is on the bus
  BusPiece current_;
  std::vector<BusPiece> later_;
};

}  // namespace

std::string_view to_string(Perturbation::Kind kind) noexcept {
  constexpr std::array<std::string_view, 4> kWords{"lost", "doubled", "late",
                                                   "swapped with the next"};
  return kWords.at(static_cast<std::size_t>(kind));
}

std::string name_of_piece(MakeDissector make_dissector, Direction direction, Bytes bytes) {
  std::vector<Message> messages;
  if (make_dissector != nullptr) make_dissector()->feed(direction, {}, bytes, messages);
  const auto whole =
      std::ranges::find_if(messages, [](const Message& one) { return one.fault.empty(); });
  return whole == messages.end() ? "bytes" : std::string{whole->name};
}

const Perturbation* Gate::pass(Instant time, Direction direction, Bytes bytes) {
  return pass(time, direction, name_of_piece(make_dissector_, direction, bytes));
}

const Perturbation* Gate::pass(Instant time, std::uint8_t address, bool is_read) {
  return pass(time, is_read ? Direction::kFromDevice : Direction::kToDevice,
              fmt::format("{} {:02X}", is_read ? "read" : "write", address));
}

const Perturbation* Gate::pass(Instant time, Direction direction, std::string name) {
  const auto nth = ++counts_[{direction, name}];
  passed_.push_back({{direction, std::move(name), nth}, time});
  const auto found = std::ranges::find(wanted_, passed_.back().name, &Perturbation::piece);
  return found == wanted_.end() ? nullptr : &*found;
}

std::unique_ptr<HostedStream> put_behind(Gate& gate, std::unique_ptr<HostedStream> device) {
  return std::make_unique<StreamBehindGate>(gate, std::move(device));
}
std::unique_ptr<HostedServer> put_behind(Gate& gate, std::unique_ptr<HostedServer> device) {
  return std::make_unique<ServerBehindGate>(gate, std::move(device));
}
std::unique_ptr<HostedBus> put_behind(Gate& gate, std::unique_ptr<HostedBus> device) {
  return std::make_unique<BusBehindGate>(gate, std::move(device));
}

}  // namespace armjig
