// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/on_port.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/link/session_port.hpp"

namespace armjig {
namespace {

using Json = nlohmann::json;
using Arrival = SessionPort::Arrival;

tl::unexpected<Problem> not_of_a_capture(const Trace& trace, const TraceEvent& event) {
  return problem(ErrorCode::kMalformed, fmt::format("{}:{}", trace.path, event.line),
                 "not a line of a recording of such a device by --capture");
}

/// The same event with what the device says.
TraceEvent answered(const TraceEvent& event, std::vector<std::byte> bytes) {
  auto actual = event;
  actual.bytes = std::move(bytes);
  return actual;
}

/// How a connection began or ended, which the event has in words of its own.
TraceEvent with_text(TraceEvent event) {
  const auto json = Json::parse(event.json, nullptr, /*allow_exceptions=*/false);
  const auto text = json.is_object() ? json.value("text", Json{}) : Json{};
  if (text.is_string()) event.text = text.get<std::string>();
  return event;
}

/// Bytes that have come and that the recording has not had yet.
class Backlog {
 public:
  void add(Bytes bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  /// As many as the event has, if there are so many.
  [[nodiscard]] std::vector<std::byte> take(std::size_t size) {
    const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(size, bytes_.size()));
    std::vector<std::byte> taken{bytes_.begin(), end};
    bytes_.erase(bytes_.begin(), end);
    return taken;
  }

 private:
  std::vector<std::byte> bytes_;
};

/// A connection of a server; its clock runs as the server's does.
struct Connection {
  std::unique_ptr<SessionPort> port;
  Backlog came;
  bool is_open = false;

  /// Takes what comes until then. How it ended, as recordings say it; empty: it goes on.
  std::string listen_until(Instant time) {
    std::array<std::byte, 4096> buffer;
    while (is_open) {
      const auto received = port->receive(buffer, time);
      if (!received || received->arrival == Arrival::kDeadline) return {};
      if (received->arrival == Arrival::kData) {
        came.add(Bytes{buffer}.first(received->size));
        continue;
      }
      is_open = false;
      return received->arrival == Arrival::kEnd ? "device-eof" : "device-reset";
    }
    return {};
  }
};

/// What all of them keep.
class Replaying {
 public:
  [[nodiscard]] Replayed take() { return std::move(replayed_); }

 protected:
  Replayed replayed_;
};

class ServerReplay : public Replaying {
 public:
  explicit ServerReplay(SessionSource& server) : server_{server} {}

  /// False: it is no such line.
  bool apply(const TraceEvent& event) {
    wait_until(event.time);
    if (event.dir == "input") return server_.touch(event.name, event.value);
    if (event.dir == "connect") return connect(with_text(event));
    const auto found = connections_.find(event.id);
    if (found == connections_.end()) return false;
    auto& connection = found->second;
    if (event.dir == "to_device") {
      (void)connection.port->send(event.bytes);  // what became of it, answers tell
      return true;
    }
    if (event.dir == "from_device") {
      replayed_.add(event, answered(event, connection.came.take(event.bytes.size())));
      return true;
    }
    return event.dir == "disconnect" && disconnect(with_text(event), connection);
  }

 private:
  void wait_until(Instant time) {
    for (auto& [id, connection] : connections_) {
      if (auto end = connection.listen_until(time); !end.empty()) ends_[id] = std::move(end);
    }
    if (server_.now() < time) server_.pause(time - server_.now());
  }

  bool connect(const TraceEvent& event) {
    auto port = server_.make_port();
    const auto connected = port->connect(port->now());
    auto actual = event;
    actual.text = connected ? "ok" : "refused";
    replayed_.add(event, std::move(actual));
    connections_[event.id] = {std::move(port), {}, connected.has_value()};
    return true;
  }

  bool disconnect(const TraceEvent& event, Connection& connection) {
    if (event.text == "client-half-close") {
      connection.port->half_close();
    } else if (event.text == "client-close") {
      connection.port->close();
      connection.is_open = false;
    } else if (event.text == "client-reset") {
      connection.port->reset();
      connection.is_open = false;
    } else {
      auto actual = event;
      const auto end = ends_.find(event.id);
      // Of hosted servers a recording does not tell a reset from an end.
      const bool is_alike = end != ends_.end() && event.text == "device-eof";
      if (!is_alike) actual.text = end == ends_.end() ? "no end" : end->second;
      replayed_.add(event, std::move(actual));
    }
    return true;
  }

  SessionSource& server_;
  std::map<std::uint32_t, Connection> connections_;
  std::map<std::uint32_t, std::string> ends_;  ///< by the server
};

/// One message of a transaction. What the bus or the device says, as recordings have it.
class BusReplay : public Replaying {
 public:
  explicit BusReplay(BusPort& port) : port_{port} {}

  bool apply(const TraceEvent& event) {
    const auto json = Json::parse(event.json, nullptr, /*allow_exceptions=*/false);
    if (!json.is_object()) return false;
    if (port_.now() < event.time) port_.wait_until(event.time);
    if (event.dir == "input") return port_.touch(event.name, event.value);
    if (event.dir == "recover") {
      (void)port_.recover();
      return true;
    }
    if (event.dir != "write" && event.dir != "read") return false;
    const auto error = json.value("error", std::string{});
    auto actual = pass(event);
    if (json.value("stop", true)) (void)port_.stop();
    auto recorded = event;
    if (!error.empty()) recorded.text += " " + error;
    replayed_.add(std::move(recorded), std::move(actual));
    return true;
  }

 private:
  TraceEvent pass(const TraceEvent& event) {
    auto actual = answered(event, {});
    actual.time = port_.now();
    actual.text.clear();
    const auto note = [&actual](const auto& reply) {
      if (!reply) actual.text += fmt::format(" {}", describe(reply.error().code));
      return reply.has_value();
    };
    const auto note_ack = [&](const Result<Ack>& reply) {
      if (!note(reply)) return false;
      actual.text += *reply == Ack::kAck ? 'A' : 'N';
      return *reply == Ack::kAck;
    };
    const bool is_read = event.dir == "read";
    const BusAddress address{static_cast<std::uint8_t>(event.id)};
    if (!note_ack(port_.start(address, is_read ? Access::kRead : Access::kWrite))) return actual;
    for (std::size_t i = 0; i < event.bytes.size(); ++i) {
      if (is_read) {
        const auto byte = port_.read(i + 1 < event.bytes.size() ? Ack::kAck : Ack::kNack);
        if (!note(byte)) return actual;
        actual.bytes.push_back(*byte);
      } else {
        actual.bytes.push_back(event.bytes[i]);
        if (!note_ack(port_.write(event.bytes[i]))) return actual;
      }
    }
    return actual;
  }

  BusPort& port_;
};

template <class Replay>
Outcome<Replayed> replay_with(Replay replay, const Trace& trace) {
  for (const auto& event : trace.events) {
    if (event.dir == "overlooked") continue;  // of whoever carried the bytes, not of the device
    if (!replay.apply(event)) return not_of_a_capture(trace, event);
  }
  return replay.take();
}

class StreamReplay : public Replaying {
 public:
  explicit StreamReplay(StreamPort& port) : port_{port} {}

  bool apply(const TraceEvent& event) {
    listen_until(event.time);
    if (event.dir == "to_device") return port_.write(event.bytes).has_value();
    if (event.dir == "input") return port_.touch(event.name, event.value);
    if (event.dir != "from_device") return false;
    replayed_.add(event, answered(event, came_.take(event.bytes.size())));
    return true;
  }

 private:
  void listen_until(Instant time) {
    std::array<std::byte, 4096> buffer;
    for (;;) {
      const auto size = port_.read(buffer, time);
      if (!size || *size == 0) return;
      came_.add(Bytes{buffer}.first(*size));
    }
  }

  StreamPort& port_;
  Backlog came_;
};

}  // namespace

Outcome<Replayed> replay_on(StreamPort& port, const Trace& trace) {
  return replay_with(StreamReplay{port}, trace);
}
Outcome<Replayed> replay_on(SessionSource& server, const Trace& trace) {
  return replay_with(ServerReplay{server}, trace);
}
Outcome<Replayed> replay_on(BusPort& port, const Trace& trace) {
  return replay_with(BusReplay{port}, trace);
}

bool is_of_capture(std::string_view header) {
  const auto json = Json::parse(header, nullptr, /*allow_exceptions=*/false);
  return json.is_object() && json.value("title", Json{}) == "capture";
}

Outcome<std::string> emulated_target_of(const Trace& trace) {
  const auto header = Json::parse(trace.header, nullptr, /*allow_exceptions=*/false);
  auto target = header.value("target", std::string{});
  if (target.starts_with("emulated:")) return target;
  return problem(ErrorCode::kUnsupported, trace.path,
                 target.empty()
                     ? "its header does not say what device it was (--redact leaves that out)"
                     : fmt::format("it was recorded at {}: only what an emulated device "
                                   "was is known",
                                   target));
}

}  // namespace armjig
