// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"

namespace armjig::kinovazed::drive {

/// How long a drive waits (docs/spec/kinovazed.md, "Times"; arm and TCP have their share in it).
namespace patience {
using std::chrono::milliseconds;
using std::chrono::seconds;
inline constexpr Duration kReply = seconds{3};
/// Behind the event of a command whose `Accepted` should have come with it.
inline constexpr Duration kOvertakenReply = milliseconds{500};
/// Three beats.
inline constexpr Duration kBeat = seconds{3};
/// Between two changes of the joystick mode, or the shipped server hangs
/// (kinovazed.mode.guard).
inline constexpr Duration kModeChange = milliseconds{600};
}  // namespace patience

struct DriveOptions {
  /// Which server is there. A documented one says `Accepted` only for commands without an event of
  /// their own; taken for a shipped one, it costs `kOvertakenReply` a command.
  Profile profile{};
  /// A deflected stick that the user does not renew for so long is let go: the server would go on
  /// for ever. 0: never.
  Duration stick_watchdog = std::chrono::milliseconds{500};
};

/// What the server says when such a command is done; none: nothing.
[[nodiscard]] std::optional<Event> completion_of(Verb verb) noexcept;

using RequestId = std::uint32_t;

/// How a command ended.
enum class Ending : std::uint8_t {
  kDone,
  kRejected,
  kNoReply,      ///< within `patience::kReply`
  kNoEvent,      ///< accepted, but not over within its time
  kInterrupted,  ///< another command took its place
  kLost,         ///< the connection ended first; nobody knows
};

/// Something that the user of a drive should know.
struct DriveEvent {
  enum class Kind : std::uint8_t {
    kEnded,          ///< the command `request`, as `ending` says
    kUnasked,        ///< the server said `said`, and nobody waits for it
    kUnreadable,     ///< the server said something that is no message
    kArmStopped,     ///< emergency stop that the drive did not ask for: trouble with the arm, or a
                     ///< guard
    kStickReleased,  ///< by the watchdog
    kSilent,         ///< no beat for `patience::kBeat`
    kBack,           ///< a beat again
  };
  Kind kind{};
  Instant time{};
  RequestId request{};
  Command command;  ///< of `kEnded`
  Ending ending{};
  Event said{};
};

/// For people, without a full stop: `Initialize was rejected`.
[[nodiscard]] std::string describe(const DriveEvent& event);

/// The event with which the server tells that such a command is over; none if `Accepted` says it
/// all.
[[nodiscard]] std::optional<Event> event_of(Verb verb) noexcept;

/// How long the event of such a command may take: arm at its slowest, and some more.
[[nodiscard]] Duration time_for(Verb verb) noexcept;

/// The client side of a KinovaZED server, without I/O: commands and received bytes go in, bytes to
/// send and events come out. It knows that an event may overtake its `Accepted`, and that an
/// accepted command ends what was under way without a word.
class Drive {
 public:
  explicit Drive(DriveOptions options = {}) noexcept : options_{options} {}

  /// A connection has begun. What the server does is not known before its first beat.
  void connect(Instant now) noexcept;
  /// It has ended: so has everything that was asked for. The arm may go on.
  void disconnect(Instant now);

  /// Sends a command. Errors: `kDisconnected`; `kBusy` while a reply is awaited or before
  /// `not_before`. An EStop may always be sent, and a stick that is let go.
  [[nodiscard]] Result<RequestId> begin(Instant now, const Command& command);
  /// Ends what goes on: an objective by `SetJoystickMode:NoMode`, anything else that moves by an
  /// EStop. None: nothing goes on. Errors as for `begin`.
  [[nodiscard]] Result<std::optional<RequestId>> cancel(Instant now);
  /// When such a command may be sent at the earliest.
  [[nodiscard]] Instant not_before(const Command& command) const noexcept;
  /// It could not be sent after all.
  void withdraw(RequestId request);

  void receive(Instant now, Bytes bytes);

  /// Gives up what takes too long, and lets the stick go. Call it when `due` has come.
  void tick(Instant now);
  /// When something has to happen although nothing comes.
  [[nodiscard]] std::optional<Instant> due() const noexcept;

  /// What has to be sent, in whole lines.
  [[nodiscard]] std::string take_outgoing();
  /// What happened since the last call.
  [[nodiscard]] std::vector<DriveEvent> take_events();

  /// The newest of this connection.
  [[nodiscard]] const std::optional<Heartbeat>& heartbeat() const noexcept { return beat_; }
  [[nodiscard]] std::uint64_t beats() const noexcept { return beats_; }
  [[nodiscard]] bool is_connected() const noexcept { return is_connected_; }
  [[nodiscard]] bool is_silent() const noexcept { return is_silent_; }
  [[nodiscard]] bool awaits_reply() const noexcept;
  /// What was accepted and goes on, or may have been; none if nothing does.
  [[nodiscard]] std::optional<Command> under_way() const noexcept;
  [[nodiscard]] bool is_stick_deflected() const noexcept { return stick_renewed_.has_value(); }

 private:
  struct Request {
    RequestId id{};
    Command command;
    Instant sent{};
    Instant reply_due{};
    Instant event_due{};
    bool is_accepted = false;
    bool has_event = false;
  };
  using Place = std::deque<Request>::iterator;

  [[nodiscard]] bool needs_reply(const Request& request) const noexcept;
  void take_for_granted(Instant now) noexcept;
  void follow_stick(Instant now, const Command& command) noexcept;
  void take_line(Instant now, std::string_view line);
  void take_reply(Instant now, Event reply);
  void take_event(Instant now, Event event);
  void take_beat(Instant now, Heartbeat beat);
  void accept(Instant now, Place request);
  void end(Instant now, Place request, Ending ending);
  void add_event(DriveEvent event) { events_.push_back(event); }

  DriveOptions options_;
  LineSplitter splitter_;
  std::string outgoing_;
  std::vector<DriveEvent> events_;
  std::deque<Request> requests_;  ///< that have not ended, oldest first
  RequestId next_id_ = 1;

  bool is_connected_ = false;
  std::optional<Heartbeat> beat_;
  std::uint64_t beats_ = 0;
  Instant heard_{};  ///< the last beat, or the beginning of the connection
  bool is_silent_ = false;
  bool has_stopped_it_ = false;  ///< an EStop of ours explains the emergency stop
  std::optional<Instant> stick_renewed_;
  std::optional<Instant> mode_changed_;
};

}  // namespace armjig::kinovazed::drive
