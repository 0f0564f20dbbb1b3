// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulators/kinovazed/behaviour.hpp"
#include "emulators/kinovazed/connections.hpp"
#include "emulators/kinovazed/machine.hpp"
#include "emulators/kinovazed/objectives.hpp"
#include "emulators/kinovazed/worker.hpp"
#include "harness/wire/kinovazed/line_receiver.hpp"

namespace armjig::kinovazed::emulation {

/// What happens when the original's process would end (kinovazed.death.process).
enum class OnDeath : std::uint8_t {
  kStay,     ///< it stays dead: connections are refused
  kRestart,  ///< a new one begins two seconds later, as its supervisor sees to
};

struct ServerOptions {
  Behaviour behaviour = kFirmwareBehaviour;
  Machine machine = shipped_machine();
  ObjectiveSet objectives = published_objectives();
  Duration call_time = std::chrono::microseconds{600};  ///< of every call to the arm
  RaceOrder race = RaceOrder::kReplyFirst;
  OnDeath on_death = OnDeath::kStay;
  std::uint32_t late_repairs = 0;  ///< see `Worker`
};

/// A line that the server writes to its log.
struct LogLine {
  Instant time{};
  std::string text;
};

/// The KinovaZED server and the arm behind it, from the start of its process
/// (docs/spec/kinovazed.md). One thread serves the network, another one the arm (`Worker`); the
/// first waits for the second. A copy is a snapshot; same inputs at the same times give the same
/// bytes. Times given never decrease.
class Server {
 public:
  explicit Server(ArmPort arm, ServerOptions options = {});

  // Clients. The server reacts when time is advanced. `connect` answers none if nobody listens: the
  // connection is refused.
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time);
  void receive(Instant time, ConnectionId id, Bytes segment);
  void half_close(Instant time, ConnectionId id);
  void close(Instant time, ConnectionId id);
  void reset(Instant time, ConnectionId id);
  /// Bytes of a client that wait in the kernel for the server to read them.
  [[nodiscard]] std::size_t unread(ConnectionId id) const noexcept {
    return connections_.unread(id);
  }

  /// SIGTERM. Without effect while the supervision of the arm is dead.
  void terminate(Instant time);

  /// Calls `use(ArmPort&)` with the arm at `time`, to move it by hand or to break it.
  template <class Use>
  void touch(Instant time, Use&& use) {
    reach(time);
    worker_.arm().with_plant(time, [](auto& /*plant*/) {});
    use(worker_.arm());
  }

  void advance_to(Instant time);
  [[nodiscard]] std::optional<Instant> next_event() const noexcept;

  [[nodiscard]] std::span<const ServerEvent> sent() const noexcept { return connections_.sent(); }
  void clear_sent() noexcept { connections_.clear_sent(); }
  /// The newest lines, at most 256.
  [[nodiscard]] const std::deque<LogLine>& log() const noexcept { return log_; }
  void clear_log() noexcept { log_.clear(); }

  enum class Life : std::uint8_t {
    kStarting,  ///< looks for its arm, does not listen
    kRunning,
    kHung,   ///< alive and deaf: the supervision of the arm is dead
    kEnded,  ///< nobody listens
  };
  [[nodiscard]] Life life() const noexcept;
  [[nodiscard]] bool is_listening() const noexcept {
    return life() == Life::kRunning || life() == Life::kHung;
  }
  [[nodiscard]] State state() const noexcept { return state_; }
  /// When the server began to listen; none before.
  [[nodiscard]] std::optional<Instant> listening_since() const noexcept { return listening_since_; }
  [[nodiscard]] const ArmPort& arm() const noexcept { return worker_.arm(); }
  [[nodiscard]] std::uint32_t repair_races() const noexcept { return worker_.repair_races(); }

 private:
  /// What the event loop of the network thread has to do; first come, first served.
  struct Task {
    enum class Kind : std::uint8_t { kAccept, kRead, kPush, kWritten, kPoll, kBeat };
    Kind kind{};
    bool was_written = false;  ///< of `kWritten`
    ServerMessage message;     ///< of `kPush`
  };
  /// Why the network thread stands still.
  enum class Waiting : std::uint8_t { kNo, kForTurn, kForJobs, kForBeat };
  /// An objective on its way.
  struct Course {
    ObjectivePath path;
    Frame origin;
    std::size_t next = 0;  ///< of `path.points`
  };

  void reach(Instant time);
  [[nodiscard]] bool has_task() const noexcept;
  void start_listening();
  [[nodiscard]] bool turn();
  [[nodiscard]] bool run_worker(Instant limit);
  void on_job_done();
  void on_event(ArmEvent event);
  void on_event_over(ArmEvent event);
  void run(Task task);

  void read();
  [[nodiscard]] bool is_readable() const noexcept;
  void arm_read();
  void serve_line(std::string_view line);
  void end_connection();
  void push(ServerMessage message);
  void start_write();
  void on_written(bool was_written);
  void say(Event event);
  void say_heartbeat();

  void begin(const Command& command);
  void decide();
  void finish_command();
  void wait_for(Job job, Waiting why);
  [[nodiscard]] bool repeats();
  [[nodiscard]] bool take_course();
  void plan_jobs(State from);
  [[nodiscard]] bool point_is_allowed(const Pose& pose) const noexcept;
  void go_on_with_course();

  void serve_console(const Command& command);
  void set_active_objective(Objective objective);
  void log_position(std::string_view frame, const Pose& pose);
  void log(std::string text);

  void die();
  void end_process();

  ServerOptions options_;
  Worker worker_;
  Connections connections_;
  LineReceiver receiver_;
  Instant now_{};
  Life life_ = Life::kStarting;
  std::optional<Instant> restart_;
  std::optional<Instant> listening_since_;
  Noise dice_{51'717};

  std::deque<Task> tasks_;
  bool is_connected_ = false;  ///< as the server believes
  bool is_read_armed_ = false;
  bool may_hold_line_ = false;  ///< behind the one that was served
  int failed_writes_ = 0;       ///< on the connection that is served
  int silent_resets_ = 0;       ///< see `Behaviour::dies_of_resets`
  std::deque<ServerMessage> outbox_;
  Instant beat_due_{};

  Waiting waiting_{};
  bool resumes_late_ = false;  ///< what waited goes on after the arm's side had its turn
  Command command_;
  std::deque<Job> planned_;

  State state_ = State::kEmergencyStopped;
  bool is_initialized_ = false;
  Verb led_to_idle_{};
  Mode mode_{};
  std::optional<Event> said_by_arm_;
  std::optional<Course> course_;  ///< the current objective
  std::optional<Course> running_course_;
  std::deque<LogLine> log_;
};

}  // namespace armjig::kinovazed::emulation
