// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/kinovazed/defects/quirks.hpp"
#include "emulators/kinovazed/server.hpp"
#include "harness/core/device_input.hpp"
#include "harness/core/emulation.hpp"

namespace armjig::kinovazed::emulation {

/// All that `DefectiveServer::set_input` knows; `CALL` stands for each of `kArmCallNames`.
[[nodiscard]] std::span<const DeviceInput> server_inputs() noexcept;

/// A server with quirks at its sockets, and what people can do at its machine. Without quirks it is
/// the server itself. Times given never decrease.
class DefectiveServer : public Sending<ServerEvent> {
 public:
  /// `start`: when its process began, by the clock of its clients.
  explicit DefectiveServer(Server server, std::vector<Quirk> quirks = {}, Instant start = {});

  [[nodiscard]] bool is_listening() const noexcept;
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time);
  void receive(Instant time, ConnectionId id, Bytes segment);
  void half_close(Instant time, ConnectionId id);
  void close(Instant time, ConnectionId id);
  void reset(Instant time, ConnectionId id);
  [[nodiscard]] std::size_t unread(ConnectionId id) const noexcept;

  /// Does at the server's machine or arm what no client can, by `server_inputs`. False: nothing has
  /// that name; the arm of the recordings has no joystick of its own.
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value);

  void advance_to(Instant time);
  [[nodiscard]] std::optional<Instant> next_event() const noexcept;
  [[nodiscard]] static std::span<const DeviceInput> inputs() noexcept { return server_inputs(); }
  [[nodiscard]] const std::deque<LogLine>& log() const noexcept { return server_.log(); }
  void clear_log() noexcept { server_.clear_log(); }
  /// What the server has written to its log since the last call.
  [[nodiscard]] std::vector<std::string> take_log();

 private:
  [[nodiscard]] bool is_known(ConnectionId id) const noexcept { return id >= first_id_; }
  [[nodiscard]] Instant inner(Instant time) const noexcept { return Instant{time - epoch_}; }
  void take_sent(Instant time);
  void take(ServerEvent event);
  void say(Instant time, ConnectionId id, std::string_view text);
  [[nodiscard]] bool leave(Instant time, ConnectionId id);
  void restart(Instant time);
  [[nodiscard]] bool set_arm(ArmPort& arm, std::string_view name, std::int64_t value);
  [[nodiscard]] bool set_joystick(Plant& plant, std::string_view name, std::int64_t value);

  Server fresh_;  ///< as it is at the start of its process
  Server server_;
  std::vector<Quirk> quirks_;
  std::vector<QuirkMemory> memories_;
  Stick by_hand_;              ///< where the arm's own joystick is
  Instant epoch_{};            ///< when the process began
  ConnectionId first_id_ = 0;  ///< of the process; it counts from 0
  ConnectionId next_id_ = 0;
  std::set<ConnectionId> open_;
  std::vector<ServerEvent> later_;  ///< by time
};

static_assert(EmulatedMultiServer<DefectiveServer>);

}  // namespace armjig::kinovazed::emulation
