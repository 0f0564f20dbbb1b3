// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/host_role.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "harness/core/hex.hpp"
#include "harness/core/text_member.hpp"
#include "harness/link/session_port.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using OrderedJson = nlohmann::ordered_json;
using Arrival = SessionPort::Arrival;
using Records = std::span<const KeptRecord>;

constexpr auto kConnectPatience = 2s;
constexpr auto kTurn = 1ms;  ///< of each connection, if several are open

OrderedJson details_of(const KeptRecord& record) {
  auto json = OrderedJson::parse('{' + record.details + '}', nullptr, /*allow_exceptions=*/false);
  return json.is_object() ? json : OrderedJson::object();
}

/// The other way round.
std::string members_of(const OrderedJson& json) {
  const auto text = json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  return text.substr(1, text.size() - 2);
}

template <class Number>
Number number_of(const OrderedJson& json, const char* key, Number otherwise) {
  const auto value = json.value(key, OrderedJson{});
  return value.is_number_integer() ? value.get<Number>() : otherwise;
}

std::string name_of_event(const OrderedJson& json) {
  const auto name = text_member(json, "dir");
  return name.empty() ? text_member(json, "op") : name;
}

/// Without the bits of which the recording says that nobody can know them.
KeptRecord masked(KeptRecord record) {
  const auto mask = from_hex(text_in(record, "mask"));
  if (!mask) return record;
  for (std::size_t i = 0; i < std::min(mask->size(), record.bytes.size()); ++i) {
    record.bytes[i] &= (*mask)[i];
  }
  return record;
}

/// Times of the recording on the clock of the port. A port whose clock is already beyond the first
/// record begins with that.
class Clock {
 public:
  Clock(Instant now, Records records, double speed) : begin_{now}, speed_{speed} {
    if (!records.empty()) base_ = std::max(Duration{}, now - due(records.front().time));
  }
  [[nodiscard]] Instant due(Instant recorded) const {
    return Instant{base_ + scaled(recorded.time_since_epoch(), 1 / speed_)};
  }
  /// Before the port was opened: not to be waited for, not even on virtual time.
  [[nodiscard]] bool is_over(Instant recorded) const { return due(recorded) < begin_; }
  [[nodiscard]] Instant recorded(Instant now) const {
    return Instant{scaled(now.time_since_epoch() - base_, speed_)};
  }
  /// What follows is due so much later.
  void stand_still(Duration time) { base_ += time; }

 private:
  static Duration scaled(Duration time, double factor) {
    if (factor == 1) return time;  // to the nanosecond
    return std::chrono::duration_cast<Duration>(std::chrono::duration<double>{time} * factor);
  }
  Instant begin_;
  double speed_;
  Duration base_{};
};

/// What all of them keep.
class Playing {
 public:
  Playing(Instant now, Records records, const PlayHow& how)
      : clock_{now, records, how.speed},
        touches_of_{how.touches_of},
        by_hand_{how.by_hand},
        after_late_{how.after_late} {}
  [[nodiscard]] Played take() { return std::move(played_); }
  /// That record, the last one that was played, has passed.
  void note_passed(const KeptRecord& record, Instant now) {
    played_.passed.push_back(clock_.recorded(now));
    const auto due = clock_.due(record.time);
    if (after_late_ == AfterLate::kShifted && now > due) clock_.stand_still(now - due);
  }

 protected:
  Result<void> expect(KeptRecord record) {
    played_.expected.push_back(std::move(record));
    return {};
  }
  void hear(KeptRecord like, Instant now, Bytes bytes) {
    like.time = clock_.recorded(now);
    like.bytes.assign(bytes.begin(), bytes.end());
    played_.actual.push_back(std::move(like));
  }
  /// What was done beside the link. Answers false if nothing of it can be done there.
  bool touch(Endpoint& port, const KeptRecord& record) {
    bool is_done = false;
    for (const auto& [name, value] : touches_of(record, touches_of_)) {
      if (port.touch(name, value) || do_by_hand(port, name, value)) is_done = true;
    }
    if (is_done) ++played_.sent;
    return is_done;
  }
  void leave_out(const std::string& what) { ++played_.left_out[what]; }
  void leave_out(const KeptRecord& record) { leave_out(label_of(record)); }

  Clock clock_;
  Played played_;

 private:
  /// Nobody knows how long it takes, so what follows leaves as much later.
  bool do_by_hand(const Endpoint& port, std::string_view name, std::int64_t value) {
    if (!by_hand_) return false;
    const auto begun = port.now();
    const bool is_done = by_hand_(name, value);
    clock_.stand_still(port.now() - begun);
    return is_done;
  }

  TouchesOf touches_of_;
  const std::function<bool(std::string_view, std::int64_t)>& by_hand_;
  AfterLate after_late_;
};

class StreamPlaying : public Playing {
 public:
  StreamPlaying(StreamPort& port, Records records, const PlayHow& how)
      : Playing{port.now(), records, how}, port_{port}, lead_{how.lead} {}

  Result<void> play(const KeptRecord& record) {
    if (record.kind == LinkKind::kStream && record.direction == Direction::kFromDevice) {
      return expect(record);
    }
    if (auto heard = listen_until(record.time - lead_); !heard) return heard;
    if (record.kind == LinkKind::kStream) {
      ++played_.sent;
      return port_.write(record.bytes);
    }
    if (!touch(port_, record)) leave_out(record);
    return {};
  }

  Result<void> listen_until(Instant recorded) {
    if (clock_.is_over(recorded)) return {};
    std::array<std::byte, 4096> buffer;
    for (;;) {
      const auto size = port_.read(buffer, clock_.due(recorded));
      if (!size) return tl::unexpected{size.error()};
      if (*size == 0) return {};
      hear({.kind = LinkKind::kStream, .direction = Direction::kFromDevice}, port_.now(),
           Bytes{buffer}.first(*size));
    }
  }

 private:
  StreamPort& port_;
  Duration lead_;
};

class ServerPlaying : public Playing {
 public:
  ServerPlaying(SessionSource& server, Records records, const PlayHow& how)
      : Playing{server.now(), records, how}, server_{server} {
    for (const auto& record : records) {
      if (record.kind != LinkKind::kEvents) continue;
      const auto event = details_of(record);
      if (text_member(event, "text") == "device-eof") ends_alike_.push_back(id_of(event));
    }
  }

  Result<void> play(const KeptRecord& record) {
    if (record.kind == LinkKind::kEvents) return play_event(record);
    if (record.kind != LinkKind::kSession) {
      leave_out(record);
      return {};
    }
    if (!connections_.contains(record.id)) {
      if (auto begun = connect(record.id, record.time); !begun) return begun;
    }
    if (record.direction == Direction::kFromDevice) return expect(record);
    if (auto heard = listen_until(record.time); !heard) return heard;
    ++played_.sent;
    return only_if_grave(connections_[record.id].port->send(record.bytes));
  }

  Result<void> listen_until(Instant recorded) {
    const auto end = clock_.due(recorded);
    for (;;) {
      const auto open = std::ranges::count_if(
          connections_, [](const auto& entry) { return entry.second.is_open; });
      const auto turn = open > 1 ? std::min(end, server_.now() + kTurn) : end;
      for (auto& [id, connection] : connections_) {
        if (auto heard = listen(id, connection, turn); !heard) return heard;
      }
      if (server_.now() < turn) server_.pause(turn - server_.now());
      if (server_.now() >= end) return {};
    }
  }

 private:
  struct Connection {
    std::unique_ptr<SessionPort> port;
    bool is_open = false;
  };

  static std::uint32_t id_of(const OrderedJson& event) {
    return number_of<std::uint32_t>(event, "conn", 0);
  }
  /// What became of other failures, answers tell.
  static Result<void> only_if_grave(const Result<void>& done) {
    if (!done && done.error().code == ErrorCode::kForbidden) return done;
    return {};
  }
  static KeptRecord border(std::uint32_t id, Instant recorded, std::string_view dir,
                           std::string_view text) {
    return {.time = recorded,
            .kind = LinkKind::kEvents,
            .details = fmt::format(R"("dir":"{}","conn":{},"text":"{}")", dir, id, text)};
  }

  Result<void> play_event(const KeptRecord& record) {
    const auto event = details_of(record);
    const auto dir = name_of_event(event);
    const auto id = id_of(event);
    const auto text = text_member(event, "text");
    const auto found = connections_.find(id);
    const bool is_end = dir == "disconnect" && found != connections_.end();
    if (is_end && text.starts_with("device-")) {
      return expect(border(id, record.time, dir, text));
    }
    if (auto heard = listen_until(record.time); !heard) return heard;
    if (dir == "connect") {
      played_.expected.push_back(border(id, record.time, dir, text));
      return connect(id, std::nullopt);
    }
    if (is_end && disconnect(found->second, text)) {
      ++played_.sent;
      if (!found->second.is_open) played_.ends.emplace_back(id, record.time);
    } else if (!touch(server_, record)) {
      leave_out(record);
    }
    return {};
  }

  static bool disconnect(Connection& connection, std::string_view how) {
    if (how == "client-half-close") {
      connection.port->half_close();
      return true;
    }
    if (how == "client-close") {
      connection.port->close();
    } else if (how == "client-reset") {
      connection.port->reset();
    } else {
      return false;
    }
    connection.is_open = false;
    return true;
  }

  /// `unsaid`: the recording does not have how it began, only what passed then.
  Result<void> connect(std::uint32_t id, std::optional<Instant> unsaid) {
    if (unsaid) {
      if (auto heard = listen_until(*unsaid); !heard) return heard;
    }
    auto port = server_.make_port();
    const auto connected = port->connect(port->now() + kConnectPatience);
    if (!connected && (unsaid || connected.error().code != ErrorCode::kRefused)) return connected;
    ++played_.sent;
    if (!unsaid) {
      played_.actual.push_back(
          border(id, clock_.recorded(port->now()), "connect", connected ? "ok" : "refused"));
    }
    auto& connection = connections_[id];
    // One that the recording did not end is left here as a client leaves, not as an operator does.
    if (connection.port) connection.port->close();
    connection = {std::move(port), connected.has_value()};
    return {};
  }

  Result<void> listen(std::uint32_t id, Connection& connection, Instant until) {
    std::array<std::byte, 4096> buffer;
    while (connection.is_open) {
      const auto received = connection.port->receive(buffer, until);
      if (!received) return tl::unexpected{received.error()};
      if (received->arrival == Arrival::kDeadline) return {};
      const auto now = connection.port->now();
      if (received->arrival == Arrival::kData) {
        hear({.kind = LinkKind::kSession, .direction = Direction::kFromDevice, .id = id}, now,
             Bytes{buffer}.first(received->size));
        continue;
      }
      connection.is_open = false;
      // Of hosted servers a recording does not tell a reset from an end.
      const bool is_end =
          received->arrival == Arrival::kEnd || std::ranges::count(ends_alike_, id) > 0;
      played_.actual.push_back(
          border(id, clock_.recorded(now), "disconnect", is_end ? "device-eof" : "device-reset"));
    }
    return {};
  }

  SessionSource& server_;
  std::map<std::uint32_t, Connection> connections_;
  std::vector<std::uint32_t> ends_alike_;
};

class BusPlaying : public Playing {
 public:
  BusPlaying(BusPort& port, Records records, const PlayHow& how)
      : Playing{port.now(), records, how}, port_{port} {}

  Result<void> play(const KeptRecord& record) {
    auto details = details_of(record);
    if (record.kind != LinkKind::kBus) {
      // Whole transactions end before it: nothing comes between their parts.
      if (auto passed = pass_all(true); !passed) return passed;
      wait_until(record.time);
      if (name_of_event(details) == "recover") {
        ++played_.sent;
        (void)port_.recover();
      } else if (!touch(port_, record) && name_of_event(details) != "advance") {
        leave_out(record);
      }
      return {};
    }
    details.erase("messages");  // what they meant is seen anew
    auto wanted = record;
    wanted.details = members_of(details);
    const auto size =
        std::max<std::size_t>(record.bytes.size(), number_of<std::uint16_t>(details, "n", 0));
    parts_.push_back({std::move(wanted), details, std::vector<std::byte>(size)});
    const auto stop = details.find("stop");
    const bool is_last = stop == details.end() || *stop != false;
    return is_last || port_.has_operations() ? pass_all(is_last) : Result<void>{};
  }

  Result<void> listen_until(Instant recorded) {
    auto passed = pass_all(true);
    if (std::exchange(is_open_, false)) (void)port_.stop();
    wait_until(recorded);
    return passed;
  }

 private:
  struct Part {
    KeptRecord record;
    OrderedJson details;
    std::vector<std::byte> read;
    std::string acks{};
    std::string error{};
    bool is_unseen = false;  ///< it passed, and the bus does not show what came

    [[nodiscard]] bool is_read() const { return record.direction == Direction::kFromDevice; }
    [[nodiscard]] bool was_refused() const { return text_member(details, "ack").ends_with('N'); }
    [[nodiscard]] BusAddress address() const { return {static_cast<std::uint8_t>(record.id)}; }
  };

  void wait_until(Instant recorded) {
    const auto due = clock_.due(recorded);
    if (port_.now() < due) port_.wait_until(due);
  }

  /// The transaction that is complete now; by operations, its next part.
  Result<void> pass_all(bool is_last) {
    auto parts = std::exchange(parts_, {});
    if (parts.empty()) return {};
    const auto recorded = parts;
    const auto passed =
        port_.has_operations() ? pass_by_operations(parts.front(), is_last) : pass_whole(parts);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      auto& part = parts[i];
      ++played_.sent;
      if (part.is_unseen) {
        leave_out("read before a refusal");
        continue;
      }
      played_.expected.push_back(masked(recorded[i].record));
      played_.actual.push_back(masked(said_of(std::move(part))));
    }
    return passed;
  }

  Result<void> pass_by_operations(Part& part, bool is_last) {
    const auto& wanted = part.record;
    wait_until(wanted.time);
    const auto begin = port_.now();
    auto done = operate(part);
    part.record.time = begin;
    is_open_ = !is_last;
    if (is_last) (void)port_.stop();
    return note(part, done);
  }

  /// Reads into `part.read`, which gets as long as what came.
  Result<void> operate(Part& part) {
    const auto wanted = std::exchange(part.read, {}).size();
    const auto note_ack = [&part](const Result<Ack>& reply) -> Result<bool> {
      if (!reply) return tl::unexpected{reply.error()};
      part.acks += *reply == Ack::kAck ? 'A' : 'N';
      return *reply == Ack::kAck;
    };
    auto acked =
        note_ack(port_.start(part.address(), part.is_read() ? Access::kRead : Access::kWrite));
    if (part.is_read()) {
      while (acked && *acked && part.read.size() < wanted) {
        const auto byte = port_.read(part.read.size() + 1 < wanted ? Ack::kAck : Ack::kNack);
        if (!byte) return tl::unexpected{byte.error()};
        part.read.push_back(*byte);
      }
    } else {
      for (const auto byte : part.record.bytes) {
        if (!acked || !*acked) break;
        acked = note_ack(port_.write(byte));
      }
    }
    if (!acked) return tl::unexpected{acked.error()};
    return {};
  }

  Result<void> pass_whole(std::vector<Part>& parts) {
    wait_until(parts.front().record.time);
    // Of one transaction only its beginning is known; what lies between is as recorded.
    const auto late = port_.now() - clock_.due(parts.front().record.time);
    std::vector<BusMessage> messages;
    for (auto& part : parts) {
      messages.push_back(part.is_read() ? read_from(part.address(), part.read)
                                        : write_to(part.address(), part.record.bytes));
    }
    const auto done = port_.transfer(messages);
    Result<void> passed;
    for (auto& part : parts) {
      part.record.time = clock_.due(part.record.time) + late;
      const bool is_done = done && *done == Transfer::kDone;
      if (is_done) {
        part.acks = std::string(1 + (part.is_read() ? 0 : part.record.bytes.size()), 'A');
      } else {
        part.read.clear();
        part.is_unseen = done && part.is_read() && parts.size() > 1 && !part.was_refused();
        if (done) part.acks = refusal_of(part, *done, parts.size());
        passed = note(part, done ? Result<void>{} : tl::unexpected{done.error()});
      }
    }
    return passed;
  }

  /// Such buses do not say which byte was refused: the recorded one, if there is one.
  static std::string refusal_of(const Part& part, Transfer how, std::size_t count) {
    auto recorded = text_member(part.details, "ack");
    const bool is_address = recorded == "N";
    const bool is_byte = recorded.size() > 1 && recorded.ends_with('N');
    if (count > 1 || (how == Transfer::kAddressRefused ? is_address : is_byte)) return recorded;
    return how == Transfer::kAddressRefused ? "N" : "A?";
  }

  /// What a bus says is compared; that it is gone, or that it was forbidden, ends the session.
  static Result<void> note(Part& part, const Result<void>& done) {
    if (done) return {};
    const auto code = done.error().code;
    if (code == ErrorCode::kDisconnected || code == ErrorCode::kForbidden) return done;
    part.error = describe(code);
    return {};
  }

  [[nodiscard]] KeptRecord said_of(Part part) const {
    const bool is_read = part.is_read();
    auto actual = std::move(part.record);
    actual.time = clock_.recorded(actual.time);
    auto& details = part.details;
    if (details.contains("ack") || part.acks.find_first_not_of('A') != std::string::npos) {
      details["ack"] = part.acks;
    }
    if (part.error.empty()) {
      details.erase("error");
    } else {
      details["error"] = part.error;
    }
    if (is_read) actual.bytes = std::move(part.read);
    actual.details = members_of(details);
    return actual;
  }

  BusPort& port_;
  std::vector<Part> parts_;
  bool is_open_ = false;  ///< a transaction, of which not all was played
};

template <class Kind>
Outcome<Played> play(Kind playing, const Endpoint& port, Records records, const PlayHow& how) {
  const auto ended = [](const Error& error) {
    return problem(error.code, "replay", "the device did not take what the host sent");
  };
  for (const auto& record : records) {
    if (const auto played = playing.play(record); !played) return ended(played.error());
    playing.note_passed(record, port.now());
  }
  if (!records.empty()) {
    const auto heard = playing.listen_until(records.back().time + how.trailing);
    // Who has nothing to say any more may go.
    const bool has_gone = !heard && heard.error().code == ErrorCode::kDisconnected;
    if (!heard && !has_gone) return ended(heard.error());
  }
  return playing.take();
}

}  // namespace

Outcome<Played> play_host(StreamPort& port, Records records, const PlayHow& how) {
  return play(StreamPlaying{port, records, how}, port, records, how);
}
Outcome<Played> play_host(SessionSource& server, Records records, const PlayHow& how) {
  return play(ServerPlaying{server, records, how}, server, records, how);
}
Outcome<Played> play_host(BusPort& port, Records records, const PlayHow& how) {
  return play(BusPlaying{port, records, how}, port, records, how);
}

}  // namespace armjig
