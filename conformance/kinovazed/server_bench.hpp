// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/port_bench.hpp"
#include "harness/wire/kinovazed/line.hpp"

namespace armjig::kinovazed::conformance {

/// The states in which cases begin, as indices into the suite's `starts`. One client is connected,
/// and nothing is under way.
enum Start : std::uint8_t {
  kStopped,  ///< emergencyStopped
  kOff,      ///< poweredOff
  kReady,    ///< idle, the arm at its ready pose
  kInMode,   ///< in mode XYZ, the arm at its ready pose
  kFolded,   ///< retracted
  kFresh,    ///< just started, nothing was said yet
};

/// A message of the server and when it was read. `order` counts all messages of a connection.
struct Heard {
  Instant time{};
  std::size_t order{};
  ServerMessage message;
  std::string raw{};  ///< the bytes that came, which are judged, with their CR LF

  /// The line as it may be shown.
  [[nodiscard]] std::string_view text() const noexcept {
    return std::string_view{raw}.substr(0, raw.find("\r\n"));
  }
  [[nodiscard]] bool is(Event event) const noexcept {
    return text() == to_string(event) && raw.size() == text().size() + 2;
  }
};

/// A conversation with a KinovaZED server, in the words of its protocol. Words are about one client
/// at a time, the first one unless `as` says otherwise.
class ServerBench final : public PortBench<SessionSource> {
 public:
  /// Whether an arm that is in use may be stopped: who only looks must not.
  enum class MayStop : std::uint8_t { kYes, kNo };

  /// When a server opened its port.
  struct Opening {
    Instant earliest;
    Instant latest;
  };

  explicit ServerBench(Rig<SessionSource> rig, MayStop may_stop = MayStop::kYes);
  ~ServerBench() override;

  [[nodiscard]] bool is_documented() const noexcept {
    return profile() == armjig::Profile::kDocumented;
  }

  /// Connects the first client. Errors: those of `SessionPort::connect`.
  [[nodiscard]] Result<void> begin_session();

  [[nodiscard]] bool is_alive() override;
  [[nodiscard]] bool can_restart() override;
  [[nodiscard]] bool revive() override;
  void bring_to(std::size_t start) override;
  void measure_noise() override;
  [[nodiscard]] Instant now() const override;
  [[nodiscard]] std::string last_exchange() const override;

  // Connections.
  /// Which client acts and listens from now on, from 0. Those beyond the first begin unconnected,
  /// and are gone when the case is over.
  void as(std::size_t client);
  void connect();
  void leave();           ///< closes both directions
  void finish_sending();  ///< and still reads
  void throw_away();      ///< resets
  /// Of a server that a case found fresh.
  [[nodiscard]] Opening opened() const noexcept { return opened_; }
  /// The server closes or resets the connection, now.
  void expect_end();
  /// It closes it, as who has read all that came.
  void expect_close();
  /// It does not, and says nothing but beats, for so long.
  void expect_quiet(Duration time);

  /// Not even a beat comes for so long.
  void expect_no_message(Duration time);

  // Lines.
  void send(std::string_view segment);
  void say(std::string_view line) { send(std::string{line} + "\r\n"); }
  void pause(Duration time);

  // Answers. Beats are passed over.
  /// The next word, now.
  Heard expect(Event wanted) { return expect(wanted, answer_time()); }
  Heard expect(Event wanted, Duration within);
  /// Nothing but beats for as long as an answer may take.
  void expect_silence();
  void refuse(std::string_view command);
  /// Says such a command each millisecond, as long as a motion may take, until the event of an
  /// earlier one comes.
  void refuse_until(std::string_view command, Event event);
  /// Commands without an event of their own, and in profile firmware all, are `Accepted`. In
  /// profile documented the others may be.
  void accept(std::string_view command);
  /// A command and its event. If the arm is there already, they come in any order.
  /// Gives the event.
  Heard perform(std::string_view command, Event event, Duration within = kMotionTime);
  /// What comes besides `Accepted`, whatever it is; none: nothing, which is no finding.
  [[nodiscard]] std::optional<Heard> event_of(std::string_view command, Event event,
                                              Duration within = kMotionTime);
  /// A line that is no command, alone and together with one: silence in profile firmware,
  /// `Rejected` in documented.
  void not_understood(std::string_view line);
  /// Bytes that get no answer, in no profile.
  void ignored(std::string_view bytes);
  /// The server still answers, and has nothing else to say.
  void expect_probe();

  /// A finding: what was heard is not what was wanted. Its first character that differs is marked.
  void fail_by(std::string_view wanted, const Heard& heard);

  // Beats.
  /// The next beat, or what time it is if none comes.
  Heard await_beat();
  /// The same of beats that came later than that.
  Heard await_beat_behind(Instant time);
  /// The next beat that cannot be from before now.
  void expect_beat(int flags);
  /// Beats that come from now on, for so long.
  [[nodiscard]] std::size_t count_beats(Duration time);
  /// Lets time pass until a beat is that far away.
  void wait_until_before_beat(Duration time);

  /// Does at the server what no client can; skips the case where nobody can. A hand that is held,
  /// calls that fail and modes that the arm says are over with the case.
  void touch(std::string_view input, std::int64_t value);
  /// What follows ends the server, or leaves it as no client can put it right: it is started anew
  /// before the next case. Skips the case where nobody can do that.
  void spoil();
  /// Whether the server answers EStop; no finding yet. What came before is passed over, and what
  /// comes of earlier commands, too.
  [[nodiscard]] bool answers();
  /// Connects, once, and tells whether EStop is answered; no finding yet.
  [[nodiscard]] bool is_served();

  /// Time in which an answer has to come.
  [[nodiscard]] Duration answer_time() const;
  [[nodiscard]] Duration silence_time() const;

  /// In which a server answers (kinovazed.time.answer).
  static constexpr Duration kAnswerTime = std::chrono::milliseconds{500};
  /// Longer than any motion of any arm takes.
  static constexpr Duration kMotionTime = std::chrono::seconds{40};

 protected:
  void forget_exchange() override;
  [[nodiscard]] Duration longest_answer() const noexcept override { return kAnswerTime; }

 private:
  struct Client {
    std::unique_ptr<SessionPort> port;
    bool is_connected = false;
    bool has_ended = false;
    bool was_reset = false;  ///< if it has ended
    std::string unfinished;
    std::size_t count = 0;
    std::deque<Heard> words;
    std::deque<Heard> beats;
    std::optional<Instant> last_beat{};
  };

  /// Something that was said or done on a connection.
  /// A command, and the answer that shows in a case's start that the server still serves.
  struct Probe {
    std::string_view command;
    Event answer;
  };
  struct Passed {
    std::string line;  ///< for people
    std::string raw;   ///< what was said
  };

  [[nodiscard]] Client& client();
  [[nodiscard]] SessionPort& session() { return *client().port; }
  [[nodiscard]] bool connect_again(Duration patience);
  [[nodiscard]] bool find_again();
  void read_until(Instant deadline);
  void take_line(std::string_view line);
  [[nodiscard]] std::optional<Heard> next_word(Duration within);
  void pass_over_accepted();
  [[nodiscard]] std::optional<Heard> next_beat(Instant after, Duration within);
  [[nodiscard]] Probe probe() const noexcept;
  [[nodiscard]] bool stop_all();
  [[nodiscard]] std::optional<Heard> beat_in_use();
  void drop_others();
  void put_inputs_back();
  void restart();
  [[nodiscard]] bool start_anew();
  void initialize();
  void remember(std::string_view arrow, std::string_view text);
  void fail_by_no_line(std::string wanted, Duration time);
  /// The finding, if the connection has ended.
  void expect_connected();
  [[nodiscard]] std::string silence_of(Duration time);

  std::vector<Client> clients_;
  std::size_t current_ = 0;
  std::deque<Passed> exchange_;
  std::optional<Instant> mode_said_;
  Start start_ = kStopped;
  Opening opened_{};  ///< between what shows that it was not open yet, and that it is
  bool is_spoiled_ = false;
  bool is_missed_ = false;  ///< the server did not come back
  bool is_owed_ = false;    ///< an answer that did not come in its time may come yet
  std::map<std::string, std::int64_t, std::less<>> left_;  ///< inputs to put back after the case
  MayStop may_stop_;
  bool is_seen_stopped_ = false;  ///< since it was connected
};

}  // namespace armjig::kinovazed::conformance
