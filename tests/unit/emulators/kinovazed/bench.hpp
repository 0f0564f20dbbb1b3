// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "emulators/kinovazed/server.hpp"

namespace armjig::kinovazed::emulation::test {

/// A server with the arm of the recordings, and a client that waits in virtual time.
class Bench {
 public:
  explicit Bench(ServerOptions options = {}, BenchOptions arm = {.start_mode = ArmMode::kReady})
      : server{ArmPort{BenchArm{arm}}, std::move(options)} {
    pass(std::chrono::milliseconds{60});
    client = connect();
    pass(std::chrono::milliseconds{1});
  }

  ConnectionId connect() { return server.connect(now).value_or(9999); }
  void send(std::string_view text) { send(client, text); }
  void send(ConnectionId id, std::string_view text) {
    server.receive(now, id, std::as_bytes(std::span{text}));
  }
  void pass(Duration time) {
    now += time;
    server.advance_to(now);
  }

  /// What a client got since the last question, beats left out; `<end>`, `<reset>`.
  std::string heard(ConnectionId id) { return said(id, /*with_beats=*/false); }
  /// Sends, waits a quarter of a second, and answers what came.
  std::string ask(std::string_view text) {
    send(text);
    pass(std::chrono::milliseconds{250});
    return heard(client);
  }
  /// The next beat.
  std::string beat() {
    server.clear_sent();
    pass(std::chrono::milliseconds{1100});
    const auto text = said(client, /*with_beats=*/true);
    const auto begin = text.rfind("Heartbeat:");
    return begin == std::string::npos
               ? "none"
               : text.substr(begin + 10, text.find('\r', begin) - begin - 10);
  }
  /// Sends the lines one after the other and waits for each.
  Bench& go(std::initializer_list<std::string_view> lines) {
    for (const auto line : lines) {
      send(std::string{line} + "\r\n");
      pass(std::chrono::milliseconds{700});
    }
    server.clear_sent();
    return *this;
  }
  Bench& to_idle() { return go({"QuitEStop", "Initialize"}); }

  Server server;
  Instant now{};
  ConnectionId client{};

 private:
  std::string said(ConnectionId id, bool with_beats) {
    std::string text;
    for (const auto& event : server.sent()) {
      if (event.connection != id) continue;
      if (event.kind == SessionEvent::Kind::kEnd) text += "<end>";
      if (event.kind == SessionEvent::Kind::kReset) text += "<reset>";
      std::string line;
      for (const auto byte : event.bytes) line.push_back(static_cast<char>(byte));
      if (with_beats || !line.starts_with("Heartbeat:")) text += line;
    }
    server.clear_sent();
    return text;
  }
};

inline ServerOptions documented() {
  ServerOptions options;
  options.behaviour = kDocumentedBehaviour;
  return options;
}

}  // namespace armjig::kinovazed::emulation::test
