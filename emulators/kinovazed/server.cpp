// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/server.hpp"

#include <algorithm>
#include <utility>

namespace armjig::kinovazed::emulation {
namespace {

constexpr std::size_t kLogLines = 256;
constexpr int kDeadlyResets = 3;
constexpr int kPromptFailures = 2;

}  // namespace

Server::Server(ArmPort arm, ServerOptions options)
    : options_{std::move(options)},
      worker_{std::move(arm), options_.behaviour, options_.call_time, options_.late_repairs},
      receiver_{options_.behaviour.profile} {
  worker_.start(now_);
}

Server::Life Server::life() const noexcept {
  return life_ == Life::kRunning && worker_.is_dead() ? Life::kHung : life_;
}

std::optional<ConnectionId> Server::connect(Instant time) {
  reach(time);
  if (life_ != Life::kRunning) return std::nullopt;
  const auto id = connections_.connect();
  if (!connections_.is_serving()) tasks_.push_back({Task::Kind::kAccept});
  return id;
}

void Server::receive(Instant time, ConnectionId id, Bytes segment) {
  reach(time);
  connections_.receive(id, segment);
}

void Server::half_close(Instant time, ConnectionId id) {
  reach(time);
  connections_.half_close(id);
}

void Server::close(Instant time, ConnectionId id) {
  reach(time);
  connections_.close(id);
}

void Server::reset(Instant time, ConnectionId id) {
  reach(time);
  if (!connections_.reset(id) || !options_.behaviour.dies_of_resets) return;
  if (++silent_resets_ == kDeadlyResets) die();
}

void Server::terminate(Instant time) {
  reach(time);
  if (life_ != Life::kRunning || worker_.is_dead()) return;
  end_process();
}

std::optional<Instant> Server::next_event() const noexcept {
  if (life_ == Life::kEnded) return restart_;
  if (has_task()) return now_;
  auto next = worker_.next_event();
  const bool beats = life_ == Life::kRunning && waiting_ == Waiting::kNo;
  if (beats && (!next || beat_due_ < *next)) next = beat_due_;
  return next;
}

/// Up to, but not at a moment that is reached already: what comes at one moment comes before any
/// reaction to it.
void Server::reach(Instant time) {
  if (time > now_) advance_to(time);
}

bool Server::has_task() const noexcept {
  if (life_ != Life::kRunning || waiting_ != Waiting::kNo) return false;
  return !tasks_.empty() || is_readable();
}

void Server::advance_to(Instant time) {
  for (;;) {
    if (life_ == Life::kEnded) {
      if (!restart_ || *restart_ > time) break;
      now_ = *std::exchange(restart_, std::nullopt);
      life_ = Life::kStarting;
      worker_ = Worker{std::move(worker_.arm()), options_.behaviour, options_.call_time,
                       options_.late_repairs};
      worker_.start(now_);
    }
    if (turn()) continue;
    const bool is_free = life_ == Life::kRunning && waiting_ == Waiting::kNo;
    const auto limit = is_free ? std::clamp(beat_due_, now_, time) : time;
    if (run_worker(limit)) continue;
    now_ = limit;
    if (is_free && beat_due_ <= now_) {
      tasks_.push_back({Task::Kind::kBeat});
      continue;
    }
    if (limit == time) break;
  }
  now_ = std::max(now_, time);
}

/// One task of the network thread. False: it has nothing to do, or waits.
bool Server::turn() {
  if (life_ != Life::kRunning || waiting_ != Waiting::kNo) return false;
  arm_read();
  if (tasks_.empty()) return false;
  // A timer that is due waits for its turn like everybody else.
  if (beat_due_ <= now_ && tasks_.back().kind != Task::Kind::kBeat) {
    const bool is_queued = std::ranges::any_of(
        tasks_, [](const Task& task) { return task.kind == Task::Kind::kBeat; });
    if (!is_queued) tasks_.push_back({Task::Kind::kBeat});
  }
  const auto task = tasks_.front();
  tasks_.pop_front();
  run(task);
  return true;
}

/// False: nothing was reported.
bool Server::run_worker(Instant limit) {
  using Kind = Worker::Report::Kind;
  if (resumes_late_) limit = now_;
  const auto report = worker_.run_until(limit);
  now_ = std::max(now_, worker_.now());
  if (life_ == Life::kStarting && worker_.is_started()) start_listening();
  switch (report.kind) {
    case Kind::kNothing:
      if (!std::exchange(resumes_late_, false)) return false;
      on_job_done();
      return true;
    case Kind::kDone: {
      const bool event_first = options_.race == RaceOrder::kEventFirst ||
                               (options_.race == RaceOrder::kRandom && dice_.next() < -2.F / 3);
      resumes_late_ = waiting_ == Waiting::kForBeat || event_first;
      if (!resumes_late_) on_job_done();
      return true;
    }
    case Kind::kEvent:
      on_event(report.event);
      return true;
    case Kind::kEventOver:
      on_event_over(report.event);
      return true;
    case Kind::kAbort:
      die();
      return true;
  }
  return false;
}

void Server::start_listening() {
  life_ = Life::kRunning;
  listening_since_ = now_;
  beat_due_ = now_ + options_.behaviour.beat_period;
}

void Server::run(Task task) {
  switch (task.kind) {
    case Task::Kind::kAccept:
      if (connections_.is_serving() || !connections_.has_waiting()) return;
      if (connections_.accept() == Connections::Accepted::kWasReset) {
        // kinovazed.death.accept-reset
        if (options_.behaviour.dies) return die();
        return end_connection();
      }
      is_connected_ = true;
      failed_writes_ = 0;
      return;
    case Task::Kind::kRead:
      is_read_armed_ = false;
      return read();
    case Task::Kind::kPush:
      return push(task.message);
    case Task::Kind::kWritten:
      return on_written(task.was_written);
    case Task::Kind::kPoll:
      return tasks_.push_back({Task::Kind::kWritten, task.was_written});
    case Task::Kind::kBeat:
      if (options_.behaviour.beat_asks_supervision) {
        return wait_for({.kind = Job::Kind::kWait}, Waiting::kForBeat);
      }
      return say_heartbeat();
  }
}

bool Server::is_readable() const noexcept {
  return is_connected_ && !is_read_armed_ && (may_hold_line_ || connections_.is_readable());
}

/// Asks for the next bytes: what is there already is read at once, and looked at in its turn.
void Server::arm_read() {
  if (!is_readable()) return;
  is_read_armed_ = true;
  tasks_.push_back({Task::Kind::kRead});
}

void Server::read() {
  for (;;) {
    switch (receiver_.step()) {
      case LineReceiver::Found::kLine:
        may_hold_line_ = true;
        return serve_line(receiver_.line());
      case LineReceiver::Found::kTooLong:
        return end_connection();
      case LineReceiver::Found::kNothing:
        break;
    }
    if (connections_.is_at_end()) {
      receiver_.end_of_stream();
      return end_connection();
    }
    may_hold_line_ = false;
    const auto bytes = connections_.read(receiver_.room());
    if (bytes.empty()) return;
    receiver_.fill(bytes);
  }
}

void Server::end_connection() {
  connections_.drop(now_);
  is_connected_ = is_read_armed_ = may_hold_line_ = false;
  if (connections_.has_waiting()) tasks_.push_back({Task::Kind::kAccept});
}

/// A message joins the queue; the first one begins to leave.
void Server::push(ServerMessage message) {
  outbox_.push_back(message);
  if (outbox_.size() == 1) start_write();
}

void Server::start_write() {
  const bool was_written = connections_.write(now_, encode(outbox_.front()).view());
  // kinovazed.death.mute: two failures are told at once. Later writes are not tried before the
  // event loop has asked the system, and so fail after what comes up meanwhile.
  const bool is_late = !was_written && is_connected_ && ++failed_writes_ > kPromptFailures;
  tasks_.push_back({is_late ? Task::Kind::kPoll : Task::Kind::kWritten, was_written});
}

/// kinovazed.death.mute: after a failed write nothing more is begun; if a message waits behind it,
/// the queue never gets empty again, and nothing is ever sent.
void Server::on_written(bool was_written) {
  outbox_.pop_front();
  if (!was_written && !options_.behaviour.dies) outbox_.clear();
  if (was_written && !outbox_.empty()) start_write();
}

void Server::say(Event event) {
  if (is_connected_) tasks_.push_back({Task::Kind::kPush, false, event});
}

void Server::say_heartbeat() {
  beat_due_ = now_ + options_.behaviour.beat_period;
  Heartbeat heartbeat{options_.machine.flag(state_)};
  if (worker_.is_arm_well()) heartbeat.flags |= beat::kConnected;
  if (is_initialized_) heartbeat.flags |= beat::kInitialized;
  if (is_connected_) tasks_.push_back({Task::Kind::kPush, false, heartbeat});
}

void Server::wait_for(Job job, Waiting why) {
  job.is_awaited = true;
  waiting_ = why;
  worker_.post(job, now_);
}

void Server::on_job_done() {
  switch (std::exchange(waiting_, Waiting::kNo)) {
    case Waiting::kForTurn:
      return decide();
    case Waiting::kForJobs:
      return finish_command();
    case Waiting::kForBeat:
      return say_heartbeat();
    case Waiting::kNo:
      return;
  }
}

void Server::on_event(ArmEvent event) {
  if (event == ArmEvent::kReconnected) {
    is_initialized_ = false;
    if (std::exchange(state_, State::kEmergencyStopped) == State::kEmergencyStopped) return;
    worker_.then_stop();
    return worker_.then_release_control();
  }
  auto& course = running_course_;
  const bool is_last = course && course->next >= course->path.points.size();
  if (event == ArmEvent::kPointReached && is_last) event = ArmEvent::kLastPointReached;
  said_by_arm_.reset();
  const auto reacts = options_.machine.reaction(state_, event);
  if (event == ArmEvent::kInitialized) is_initialized_ = reacts.has_value();
  if (!reacts) {
    // kinovazed.retract.while-initializing
    const bool says_anyway =
        event == ArmEvent::kRetractionReached && options_.behaviour.sticks_when_folded;
    if (says_anyway) said_by_arm_ = Event::kRetracted;
    return;
  }
  state_ = reacts->next;
  said_by_arm_ = reacts->said;
  if (event == ArmEvent::kHomeReached) led_to_idle_ = Verb::kUnfold;
  if (event == ArmEvent::kInitialized) led_to_idle_ = Verb::kInitialize;
  if (event == ArmEvent::kLastPointReached) {
    led_to_idle_ = Verb::kRunObjective;
    worker_.then_stop();
  }
  if (event == ArmEvent::kPointReached) go_on_with_course();
}

void Server::on_event_over(ArmEvent /*event*/) {
  if (const auto event = std::exchange(said_by_arm_, std::nullopt)) say(*event);
}

void Server::log(std::string text) {
  log_.push_back({now_, std::move(text)});
  if (log_.size() > kLogLines) log_.pop_front();
}

/// The process ends with a core dump.
void Server::die() {
  log("the server process died");
  end_process();
  if (options_.on_death == OnDeath::kRestart) restart_ = now_ + pace::kRestart;
}

/// What a process has in memory ends with it; the arm does not.
void Server::end_process() {
  connections_.drop_all(now_);
  receiver_ = LineReceiver{options_.behaviour.profile};
  life_ = Life::kEnded;
  tasks_.clear();
  outbox_.clear();
  planned_.clear();
  is_connected_ = is_read_armed_ = may_hold_line_ = is_initialized_ = resumes_late_ = false;
  waiting_ = Waiting::kNo;
  silent_resets_ = 0;
  state_ = State::kEmergencyStopped;
  mode_ = Mode::kNoMode;
  said_by_arm_.reset();
  course_.reset();
  running_course_.reset();
}

}  // namespace armjig::kinovazed::emulation
