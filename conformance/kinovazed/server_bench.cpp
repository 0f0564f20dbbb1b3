// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/server_bench.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "conformance/kinovazed/laws.hpp"
#include "harness/wire/kinovazed/dissector.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kRemembered = 8;
/// A server that its supervisor starts again is there by then.
constexpr Duration kRestartTime = 15s;
/// Two modes within half a second, by way of EStop, hang the shipped server.
constexpr Duration kBetweenModes = 700ms;
/// A beat nearer to a change than that may be from before it.
constexpr Duration kBeatIsOld = 100ms;
/// The slowest real server takes 110 ms.
constexpr Duration kAcceptedTime = 150ms;
/// When they come is a requirement of its own.
constexpr Duration kBeatTime = 2500ms;

/// Control characters and what is no ASCII as escapes; long lines cut.
std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : text.substr(0, 60)) {
    const auto byte = static_cast<unsigned char>(c);
    shown += byte >= 0x20 && byte < 0x7F ? std::string{c} : fmt::format("\\x{:02X}", byte);
  }
  return text.size() > 60 ? fmt::format("{}... ({} bytes)", shown, text.size()) : shown;
}

/// The mark of a line of the server.
std::string mark_of(std::string_view line, const Judgement& judgement) {
  std::vector<Message> messages;
  make_dissector()->feed(Direction::kFromDevice, {}, std::as_bytes(std::span{line}), messages);
  return messages.empty() ? std::string{} : armjig::mark_of(messages.front(), judgement);
}

/// Kinova's number of an arm that is not at its ready pose, so that Initialize leads it there.
constexpr std::int64_t kModeElsewhere = 5;

bool is_event_free(std::string_view command) {
  return command == "EStop" || command == "QuitEStop" || command.starts_with("MoveJoystick");
}

}  // namespace

ServerBench::ServerBench(Rig<SessionSource> rig, MayStop may_stop)
    : PortBench{std::move(rig)}, may_stop_{may_stop} {
  clients_.emplace_back().port = port().make_port();
}

/// Whoever comes next finds an arm that nobody holds.
ServerBench::~ServerBench() { put_inputs_back(); }

Result<void> ServerBench::begin_session() {
  auto& first = clients_.front();
  const auto deadline = first.port->now() + 3s;
  auto connected = first.port->connect(deadline);
  while (!connected && first.port->now() < deadline) {
    port().pause(100ms);
    auto again = first.port->connect(deadline);
    // A refusal says more than that the time was up in the last try.
    if (again || again.error().code != ErrorCode::kTimedOut) connected = again;
  }
  first.is_connected = connected.has_value();
  return connected;
}

Instant ServerBench::now() const { return clients_[current_].port->now(); }

ServerBench::Client& ServerBench::client() { return clients_[current_]; }

Duration ServerBench::answer_time() const { return std::max<Duration>(2s, 20 * noise()); }
Duration ServerBench::silence_time() const { return std::max<Duration>(250ms, 5 * noise()); }

void ServerBench::forget_exchange() {
  exchange_.clear();
  pass_over_stops();
}

std::string ServerBench::last_exchange() const {
  const auto judged = std::ranges::find(exchange_.rbegin(), exchange_.rend(),
                                        judgement().actual + "\r\n", &Passed::raw);
  std::string text;
  for (const auto& each : exchange_) {
    text += each.line;
    if (judged != exchange_.rend() && &each == &*judged) text += mark_of(each.raw, judgement());
  }
  return text;
}

void ServerBench::remember(std::string_view arrow, std::string_view text) {
  exchange_.push_back({fmt::format("{:.3f} ms {} {} {}\n", milliseconds(now().time_since_epoch()),
                                   current_, arrow, printable(text)),
                       std::string{text}});
  if (exchange_.size() > kRemembered) exchange_.pop_front();
}

void ServerBench::fail_by(std::string_view wanted, const Heard& heard) {
  const auto text = heard.text();
  const auto differs = std::ranges::mismatch(wanted, text).in2 - text.begin();
  fail_at(static_cast<std::size_t>(differs), in_context(wanted), std::string{text});
}

/// Nothing that is a line came. What did come is the finding.
void ServerBench::fail_by_no_line(std::string wanted, Duration time) {
  is_owed_ = true;
  const auto& rest = client().unfinished;
  if (rest.empty()) return fail_by_silence(std::move(wanted), silence_of(time));
  fail(wanted + " and CR LF",
       fmt::format("'{}' and no LF within {:.0f} ms", printable(rest), milliseconds(time)));
}

std::string ServerBench::silence_of(Duration time) {
  if (client().has_ended) return "the end of the connection";
  return fmt::format("nothing within {:.0f} ms", milliseconds(time));
}

// Connections.

void ServerBench::as(std::size_t client) {
  while (clients_.size() <= client) clients_.emplace_back().port = port().make_port();
  current_ = client;
}

bool ServerBench::connect_again(Duration patience) {
  auto& one = client();
  one.port->close();
  one = Client{.port = std::move(one.port)};
  is_seen_stopped_ = false;
  const auto deadline = one.port->now() + patience;
  for (;;) {
    const auto asked = one.port->now();
    const auto connected = one.port->connect(asked + answer_time());
    one.is_connected = connected.has_value();
    opened_.latest = one.port->now();
    if (connected) {
      is_missed_ = false;
      return true;
    }
    opened_.earliest = asked;
    if (one.port->now() >= deadline) return false;
    port().pause(100ms);
  }
}

/// One that was waited for in vain is not waited for again.
bool ServerBench::find_again() {
  const bool is_found = connect_again(is_missed_ ? Duration{} : kRestartTime);
  is_missed_ = !is_found;
  return is_found;
}

void ServerBench::connect() {
  if (is_deaf()) return;
  remember("connects", "");
  if (!connect_again(answer_time())) fail_by_silence(in_context("a connection"), "it is refused");
}

void ServerBench::leave() {
  if (is_deaf()) return;
  remember("closes", "");
  session().close();
  client().is_connected = false;
}

void ServerBench::finish_sending() {
  if (is_deaf()) return;
  remember("closes its side", "");
  session().half_close();
}

void ServerBench::throw_away() {
  if (is_deaf()) return;
  remember("resets", "");
  session().reset();
  client().is_connected = false;
}

void ServerBench::expect_end() {
  const auto word = next_word(answer_time());
  if (word) return fail_by("the end of the connection", *word);
  if (!is_deaf() && !client().has_ended) {
    fail(in_context("the end of the connection"), silence_of(answer_time()));
  }
}

void ServerBench::expect_close() {
  expect_end();
  expect_true(!client().was_reset, "the end of the connection", "its reset");
}

void ServerBench::expect_quiet(Duration time) {
  const auto word = next_word(time);
  if (word) return fail_by("nothing but beats", *word);
  expect_connected();
}

void ServerBench::expect_connected() {
  if (is_deaf() || !client().has_ended) return;
  fail_by_silence(in_context("an open connection"), "the end of the connection");
}

void ServerBench::expect_no_message(Duration time) {
  client().beats.clear();
  expect_quiet(time);
  if (client().beats.empty()) return;
  fail_by("no message at all", client().beats.front());
}

// Lines.

void ServerBench::send(std::string_view segment) {
  if (is_deaf()) return;
  if (segment.starts_with("SetJoystickMode")) mode_said_ = now();
  remember(">", segment);
  const auto sent = session().send(std::as_bytes(std::span{segment}));
  if (sent) return;
  if (sent.error().code == ErrorCode::kForbidden) return (void)is_done(sent);
  client().has_ended = true;
}

void ServerBench::pause(Duration time) {
  const auto deadline = now() + time;
  while (!is_deaf() && now() < deadline) {
    if (!client().is_connected || client().has_ended) return port().pause(deadline - now());
    read_until(deadline);
  }
}

/// Reads once.
void ServerBench::read_until(Instant deadline) {
  std::array<std::byte, 4096> buffer;
  const auto received = session().receive(buffer, deadline);
  if (!received || received->arrival == SessionPort::Arrival::kEnd ||
      received->arrival == SessionPort::Arrival::kReset) {
    client().has_ended = true;
    client().was_reset = received && received->arrival == SessionPort::Arrival::kReset;
    remember("<", "the end of the connection");
    return;
  }
  auto& text = client().unfinished;
  for (const auto byte : std::span{buffer}.first(received->size)) {
    text += static_cast<char>(byte);
    if (text.back() != '\n') continue;
    take_line(text);
    text.clear();
  }
}

void ServerBench::take_line(std::string_view line) {
  auto& one = client();
  remember("<", line);
  const auto message = decode_message(line.substr(0, line.size() - 1));
  if (!message) {
    return fail(in_context("one of the server's words and CR LF"),
                fmt::format("'{}': {}", printable(line), describe(message.error())));
  }
  const Heard heard{now(), one.count++, *message, std::string{line}};
  if (std::holds_alternative<Heartbeat>(*message)) {
    one.last_beat = heard.time;
    one.beats.push_back(heard);
  } else {
    one.words.push_back(heard);
  }
}

// Answers.

std::optional<Heard> ServerBench::next_word(Duration within) {
  auto& one = client();
  const auto deadline = now() + within;
  while (one.words.empty() && !is_deaf() && !one.has_ended && now() < deadline) {
    read_until(deadline);
  }
  if (one.words.empty() || is_over()) return std::nullopt;
  auto word = one.words.front();
  one.words.pop_front();
  return word;
}

Heard ServerBench::expect(Event wanted, Duration within) {
  const auto word = next_word(within);
  if (!word) {
    fail_by_no_line(in_context(to_string(wanted)), within);
    return {now()};
  }
  if (!word->is(wanted)) {
    fail_by(to_string(wanted), *word);
  }
  return *word;
}

void ServerBench::expect_silence() {
  const auto word = next_word(silence_time());
  if (word) fail_by("no answer", *word);
}

void ServerBench::refuse(std::string_view command) {
  about(std::string{command});
  say(command);
  expect(Event::kRejected);
}

void ServerBench::refuse_until(std::string_view command, Event event) {
  for (const auto end = now() + kMotionTime; now() < end;) {
    say(command);
    const auto word = next_word(answer_time());
    if (!word) return fail_by_no_line(in_context(to_string(Event::kRejected)), answer_time());
    if (word->is(event)) return (void)expect(Event::kRejected);
    if (!word->is(Event::kRejected)) return fail_by(to_string(event), *word);
    pause(1ms);
  }
  fail(in_context(to_string(event)), "Rejected, and nothing else");
}

void ServerBench::accept(std::string_view command) {
  about(std::string{command});
  say(command);
  if (!is_documented() || is_event_free(command)) {
    expect(Event::kAccepted);
  } else {
    pass_over_accepted();
  }
}

std::optional<Heard> ServerBench::event_of(std::string_view command, Event event, Duration within) {
  about(std::string{command});
  say(command);
  auto word = next_word(within);
  if (word && word->is(event))
    is_documented() ? pass_over_accepted() : void(expect(Event::kAccepted));
  if (word && word->is(Event::kAccepted)) word = next_word(within);
  return word;
}

Heard ServerBench::perform(std::string_view command, Event event, Duration within) {
  const auto word = event_of(command, event, within);
  if (!word) {
    fail_by_no_line(in_context(to_string(event)), within);
    return {now()};
  }
  if (!word->is(event)) fail_by(to_string(event), *word);
  return *word;
}

/// A shipped server sends it, in front of the event or at times behind it.
void ServerBench::pass_over_accepted() {
  const auto word = next_word(kAcceptedTime);
  if (word && !word->is(Event::kAccepted)) client().words.push_front(*word);
}

ServerBench::Probe ServerBench::probe() const noexcept {
  if (start_ == kStopped || start_ == kFresh) return {"EStop", Event::kAccepted};
  return {"QuitEStop", start_ == kOff ? Event::kAccepted : Event::kRejected};
}

void ServerBench::expect_probe() {
  say(probe().command);
  expect(probe().answer);
}

void ServerBench::not_understood(std::string_view line) {
  about(printable(line));
  say(line);
  if (is_documented()) expect(Event::kRejected);
  expect_probe();
  about(fmt::format("{}, with {} in the same segment", printable(line), probe().command));
  send(fmt::format("{}\r\n{}\r\n", line, probe().command));
  if (is_documented()) expect(Event::kRejected);
  expect(probe().answer);
}

void ServerBench::ignored(std::string_view bytes) {
  about(printable(bytes));
  send(bytes);
  expect_probe();
}

// Beats.

std::optional<Heard> ServerBench::next_beat(Instant after, Duration within) {
  auto& one = client();
  const auto deadline = now() + within;
  for (;;) {
    while (!one.beats.empty() && one.beats.front().time <= after) one.beats.pop_front();
    if (!one.beats.empty() || is_deaf() || one.has_ended || now() >= deadline) break;
    read_until(deadline);
  }
  if (one.beats.empty() || is_over()) return std::nullopt;
  auto beat = one.beats.front();
  one.beats.pop_front();
  return beat;
}

Heard ServerBench::await_beat() { return await_beat_behind(now()); }

Heard ServerBench::await_beat_behind(Instant time) {
  const auto beat = next_beat(time, kBeatTime + noise());
  if (!beat) fail_by_no_line(in_context("a heartbeat"), kBeatTime);
  return beat.value_or(Heard{now()});
}

void ServerBench::expect_beat(int flags) {
  const auto wanted = fmt::format("Heartbeat:{}", flags);
  const auto beat = next_beat(now() + kBeatIsOld, kBeatTime + kBeatIsOld + noise());
  if (!beat) return fail_by_no_line(in_context(wanted), kBeatTime);
  if (beat->raw != wanted + "\r\n") fail_by(wanted, *beat);
}

std::size_t ServerBench::count_beats(Duration time) {
  client().beats.clear();
  pause(time);
  expect_connected();
  return client().beats.size();
}

void ServerBench::wait_until_before_beat(Duration time) {
  (void)await_beat();
  pause(kBeatPeriod - time);
}

// The server and its machine.

void ServerBench::touch(std::string_view input, std::int64_t value) {
  if (is_deaf()) return;
  // A hand that says that it failed may have got half way.
  if (input == "arm.held" || input.starts_with("arm.fail.")) left_.emplace(input, 0);
  if (input == "arm.mode") left_.emplace(input, kModeElsewhere);
  if (!reach(input, value)) miss_hand(input);
}

void ServerBench::put_inputs_back() {
  for (const auto& [input, usual] : std::exchange(left_, {})) (void)reach(input, usual);
}

bool ServerBench::can_restart() {
  // As it is anyway; it shows whether the server is an emulated one.
  return hand().has("restart") || port().touch("arm.fail.arm_open", 0);
}

bool ServerBench::revive() {
  is_spoiled_ = can_restart();
  is_missed_ = false;
  return is_spoiled_ && is_alive();
}

void ServerBench::spoil() {
  if (is_deaf()) return;
  is_spoiled_ = can_restart();
  if (!is_spoiled_) {
    skip("ends or hangs the server: --restart has to bring it back, for no client can");
  }
}

bool ServerBench::answers() {
  if (is_deaf()) return true;
  client().words.clear();
  send("EStop\r\n");
  auto word = next_word(answer_time());
  while (word && !word->is(Event::kAccepted) && !word->is(Event::kRejected)) {
    word = next_word(answer_time());
  }
  return word.has_value();
}

bool ServerBench::is_served() { return is_deaf() || (connect_again(Duration{}) && answers()); }

/// EStop ends whatever is under way; what was said before is passed over, an answer that a case
/// missed, too.
bool ServerBench::stop_all() {
  auto& one = client();
  if (std::exchange(is_owed_, false)) pause(answer_time());
  one.words.clear();
  send("\r\nEStop\r\n");
  for (auto word = next_word(answer_time()); word; word = next_word(answer_time())) {
    if (!word->is(Event::kAccepted)) continue;
    pause(30ms + 3 * noise());
    one.words.clear();
    return true;
  }
  return false;
}

/// The beat of an arm that somebody uses, and that may not be stopped; none if it may be, for it
/// is stopped, or allowed. Nothing is sent. A server that says nothing counts as in use.
std::optional<Heard> ServerBench::beat_in_use() {
  if (may_stop_ == MayStop::kYes || is_seen_stopped_) return std::nullopt;
  const auto beat = next_beat(now(), kBeatTime + noise());
  if (!beat) return Heard{now()};
  const auto* const heartbeat = std::get_if<Heartbeat>(&beat->message);
  is_seen_stopped_ =
      heartbeat != nullptr && heartbeat->flags == beat_of(State::kEmergencyStopped).flags;
  return is_seen_stopped_ ? std::nullopt : beat;
}

/// What clients have said while they waited is carried out when the first one leaves, so it does.
void ServerBench::drop_others() {
  current_ = 0;
  if (clients_.size() == 1) return;
  clients_.erase(clients_.begin() + 1, clients_.end());
  session().close();
  client().is_connected = false;
}

bool ServerBench::is_alive() {
  drop_others();
  if (std::exchange(is_spoiled_, false)) restart();
  const auto& one = client();
  if ((!one.is_connected || one.has_ended) && !find_again()) return false;
  if (const auto beat = beat_in_use()) {
    if (!beat->raw.empty()) return true;
  } else if (stop_all()) {
    return true;
  }
  if (!client().unfinished.empty()) {
    fail_by_no_line("Accepted (EStop)", answer_time());
  } else if (next_beat(now(), kBeatTime + noise())) {
    fail("Accepted (EStop)", "heartbeats and no answer");
  }
  return false;
}

void ServerBench::measure_noise() {
  constexpr int kSamples = 20;
  if (beat_in_use()) return;
  for (int i = 0; i < kSamples && !client().has_ended; ++i) {
    port().pause(std::chrono::milliseconds{1 + i});
    const auto asked = now();
    send("EStop\r\n");
    if (const auto answer = next_word(answer_time())) {
      hear_noise(answer->time - asked);
    }
  }
}

void ServerBench::restart() {
  opened_.earliest = now();
  const bool has_hand = reach("restart", 1);
  if (!has_hand && start_ == kFresh) return skip("needs somebody who can start the server anew");
  port().pause(100ms);
  client().has_ended = true;
  mode_said_.reset();
}

/// For a server that does not stop.
bool ServerBench::start_anew() {
  return reach("restart", 1) && connect_again(kRestartTime) && stop_all();
}

/// An arm that was stopped soon after it was folded may end folded once more; EStop is the way out.
void ServerBench::initialize() {
  const auto event = event_of("Initialize", Event::kInitialized, kMotionTime);
  if (!event || event->is(Event::kInitialized)) return;
  if (!event->is(Event::kRetracted) || !stop_all()) {
    return fail_by(to_string(Event::kInitialized), *event);
  }
  accept("QuitEStop");
  perform("Initialize", Event::kInitialized);
}

void ServerBench::bring_to(std::size_t start) {
  drop_others();
  put_inputs_back();
  start_ = static_cast<Start>(start);
  if (std::exchange(is_spoiled_, false) || start_ == kFresh) restart();
  auto& one = client();
  if (!one.is_connected || one.has_ended) {
    if (!find_again()) return fail_by_silence("a connection", "it is refused");
  }
  if (start_ == kFresh || is_over()) return;
  if (const auto beat = beat_in_use()) {
    return skip(fmt::format("the arm is in use ({}), and needs --allow state to be stopped",
                            beat->raw.empty() ? "no beat comes" : beat->text()));
  }
  if (!stop_all() && !start_anew()) {
    return fail_by_no_line("Accepted (EStop)", answer_time());
  }
  if (start_ == kStopped) return;
  accept("QuitEStop");
  if (start_ == kOff) return;
  if (mode_said_) pause(*mode_said_ + kBetweenModes - now());
  initialize();
  if (start_ == kInMode) perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  if (start_ == kFolded) perform("Retract", Event::kRetracted);
  about({});
}

}  // namespace armjig::kinovazed::conformance
