// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <vector>

#include "emulators/kinovazed/arm_port.hpp"
#include "emulators/sessions/odd_fields.hpp"
#include "emulators/sessions/sessions.hpp"
#include "emulators/sessions/theme.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/kinovazed/fields.hpp"
#include "harness/wire/kinovazed/line.hpp"

namespace armjig::kinovazed::sessions {
namespace {

using namespace armjig::sessions;
using emulation::ArmCall;
using emulation::kArmCallNames;

constexpr std::uint32_t kMostClients = 12;

class Session : public Draft {
 public:
  explicit Session(const Start& start) : Draft{start, TimeUnit::kMillisecond} {
    arm_ = describe_arm();
    if (is_missing_) rest();
    connect();
    while (is_missing_ && dice_.one_in(2)) rest();
    if (is_missing_) {
      touch({R"("event":"plug")"});
      wait(3'000);
      connect();
    }
    if (theme_ == "framing" || theme_ == "faults") return;
    if (!dice_.one_in(6)) make_ready();
  }

  [[nodiscard]] std::string finish() {
    wait(dice_.between(100, 3'000));
    touch({R"("event":"clear_failures")"});  // until here time passes
    return text("kinovazed",
                fmt::format(R"("category":"{}","seed":{},"listening_since_ms":{},"arm":{},)"
                            R"("server_after":"running","final_state":"emergencyStopped")",
                            theme_, seed_, is_missing_ ? "null" : "0", arm_));
  }

  // Commands.
  void make_ready() {
    say(command(Verb::kQuitEStop));
    wait(dice_.between(10, 100));
    say(command(Verb::kInitialize));
    wait(dice_.one_in(5) ? dice_.between(10, 2'000) : 2'500);
  }
  void order() {
    say(command(dice_.number<Verb>(0, kVerbNames.size() - 1)));
    pause();
  }
  void stop() {
    say(command(Verb::kEStop));
    pause();
    if (!dice_.one_in(3)) make_ready();
  }
  void freeze() {
    say(command(Verb::kFreeze));
    pause();
    say(command(dice_.one_in(5) ? Verb::kFreeze : Verb::kUnfreeze));
    pause();
  }
  void fold() {
    say(command(Verb::kRetract));
    wait(dice_.one_in(3) ? dice_.between(5, 1'700) : 2'000);
    say(command(dice_.one_in(4) ? Verb::kInitialize : Verb::kUnfold));
    wait(dice_.one_in(3) ? dice_.between(5, 1'700) : 2'000);
  }
  void choose_mode() {
    say(encode(Command{.verb = Verb::kSetJoystickMode, .mode = dice_.number<Mode>(0, 4)}).view());
    wait(dice_.one_in(4) ? dice_.between(1, 700) : 600);
  }
  void steer() {
    for (auto left = dice_.between(1, 8); left > 0; --left) {
      Command move{.verb = Verb::kMoveJoystick};
      for (auto* axis : {&move.deflection.x, &move.deflection.y, &move.deflection.z}) {
        *axis = dice_.one_in(3) ? 0 : dice_.number<std::int32_t>(-400, 400);
      }
      if (dice_.one_in(8)) {
        move.deflection.x = static_cast<std::int32_t>(odd_number(dice_));
      }
      say(encode(move).view());
      pause();
    }
  }
  void run() {
    say(encode(Command{.verb = Verb::kRunObjective,
                       .objective = dice_.number<Objective>(0, kObjectiveNames.size() - 1)})
            .view());
    wait(dice_.one_in(3) ? dice_.between(1, 2'000) : dice_.between(1'000, 6'000));
  }

  // Lines that are none.
  void odd_line() {
    auto line = text_of(command(dice_.number<Verb>(0, kVerbNames.size() - 1)));
    for (auto left = dice_.between(1, 3); left > 0; --left) spoil(line);
    if (!dice_.one_in(5)) line += "\r\n";
    say(line);
    pause();
  }
  void odd_arguments() {
    const auto verb = dice_.number<Verb>(0, kVerbNames.size() - 1);
    std::string line{kVerbNames[static_cast<std::size_t>(verb)]};
    for (auto left = dice_.between(0, 4); left > 0; --left) {
      line += ':';
      line += dice_.one_in(3)   ? std::string{dice_.one_of(kModeNames)}
              : dice_.one_in(3) ? std::string{dice_.one_of(kObjectiveNames)}
                                : Words{"{}{}", dice_.one_in(6) ? " " : "", odd_number(dice_)}.text;
    }
    say(line + "\r\n");
    pause();
  }
  void garbage() {
    auto bytes = dice_.bytes(1, 40);
    for (auto& byte : bytes) {
      if (dice_.one_in(8)) byte = dice_.one_in(2) ? std::byte{'\n'} : std::byte{'\r'};
    }
    send(bytes);
    pause();
  }
  void endless_line() {
    const std::string line(dice_.number<std::size_t>(100, dice_.one_in(3) ? 1'300 : 600), 'x');
    say(dice_.one_in(2) ? line + "\r\n" : line);
    pause();
  }
  void several() {  // commands in one segment
    std::string text;
    for (auto left = dice_.between(2, 6); left > 0; --left) {
      text += command(dice_.number<Verb>(0, kVerbNames.size() - 1));
    }
    say(text);
    pause();
  }
  void in_pieces() {
    const auto line = command(dice_.number<Verb>(0, kVerbNames.size() - 1));
    const auto gap = dice_.one_in(2) ? 0 : dice_.between(1, 300);
    for (std::string_view rest{line}; !rest.empty();) {
      const auto size = std::min(rest.size(), dice_.number<std::size_t>(1, 8));
      say(rest.substr(0, size));
      rest.remove_prefix(size);
      wait(gap);
    }
    pause();
  }

  // Connections.
  void connect() {
    if (next_ > kMostClients) return;
    add({R"("dir":"connect","conn":{},"text":"ok")", next_});
    open_.push_back(next_++);
    wait(dice_.mostly_low(1, 300));
  }
  void disconnect() {
    constexpr std::array<std::string_view, 3> kHow{"client-close", "client-reset",
                                                   "client-half-close"};
    if (open_.empty()) return connect();
    const auto which = dice_.number<std::size_t>(0, std::ssize(open_) - 1);
    add({R"("dir":"disconnect","conn":{},"text":"{}")", open_[which], dice_.one_of(kHow)});
    open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(which));
    wait(dice_.mostly_low(1, 2'000));
    if (open_.empty() || dice_.one_in(2)) connect();
  }

  void knock() {  // clients that are gone again before they are served
    constexpr std::array<std::string_view, 2> kHow{"client-reset", "client-close"};
    for (auto left = dice_.between(1, 3); left > 0 && next_ <= kMostClients; --left) {
      connect();
      if (dice_.one_in(3)) say(command(Verb::kFreeze));
      add({R"("dir":"disconnect","conn":{},"text":"{}")", open_.back(), dice_.one_of(kHow)});
      open_.pop_back();
    }
    pause();
  }
  void console() {
    constexpr std::array kVerbs{Verb::kSetActiveObjective, Verb::kGetObjectivePosition,
                                Verb::kGetAbsolutePosition};
    say(command(dice_.one_of(kVerbs)));
    pause();
  }

  // What befalls the arm.
  void fail() {
    const auto count = dice_.one_in(4) ? -1 : dice_.between(1, 4);
    touch({R"("event":"fail","call":"{}","count":{},"skip":{})", dice_.one_of(kArmCallNames), count,
           dice_.between(0, 4)});
    pause();
    if (!dice_.one_in(3)) touch({R"("event":"clear_failures")"});
  }
  /// What comes before the server looks at the arm again.
  void order_at_once() {
    constexpr std::array kVerbs{Verb::kRetract, Verb::kRetract, Verb::kSetJoystickMode,
                                Verb::kUnfold,  Verb::kFreeze,  Verb::kInitialize,
                                Verb::kEStop};
    say(command(dice_.one_of(kVerbs)));
    pause();
  }
  void fail_in_command() {
    constexpr std::array kCalls{ArmCall::kReadStatus, ArmCall::kReleaseStick,
                                ArmCall::kPressHome,  ArmCall::kErase,
                                ArmCall::kWriteAxes,  ArmCall::kTakeControl};
    if (dice_.one_in(2)) make_ready();
    touch({R"("event":"fail","call":"{}","count":1,"skip":{})", to_string(dice_.one_of(kCalls)),
           dice_.one_in(3) ? 1 : 0});
    order_at_once();
    touch({R"("event":"clear_failures")"});
  }
  void misplace() {
    if (dice_.one_in(2)) make_ready();
    touch({R"("event":"mode","value":{})", dice_.between(0, 6)});
    order_at_once();
  }
  void unplug() {
    touch({R"("event":"unplug")"});
    wait(dice_.mostly_low(1, 3'000));
    touch({R"("event":"plug")"});
    pause();
  }
  void surge() {
    touch({R"("event":"current","value":{}.5)", dice_.between(0, 20)});
    pause();
    touch({R"("event":"current","value":0.8)"});
  }
  void move_arm() {
    constexpr std::array kModes{0, 1, 2, 3, 4, 5, 6, 25'000};
    touch({R"("event":"mode","value":{})", dice_.one_of(kModes)});
    pause();
  }
  void terminate() { add({R"("dir":"note","text":"server process is asked to terminate")"}); }

  void rest() { wait(dice_.mostly_low(1, 6'000)); }
  void meet_beat() {
    const auto beat = now_ / 1'000 * 1'000 + 1'000 + dice_.between(-3, 8);
    now_ = std::max(now_, beat);
  }

 private:
  [[nodiscard]] std::string describe_arm() {
    constexpr std::array kModes{6, 6, 6, 1, 3, 0, 2, 4, 5, 25'000};
    is_missing_ = dice_.one_in(25);
    std::string arm = fmt::format(R"("start_mode":{})", dice_.one_of(kModes));
    if (dice_.one_in(3)) {
      arm +=
          Words{R"(,"initialise_s":{}.25,"unfold_s":{}.5,"retract_s":{}.75,"to_ready_s":1.{})",
                dice_.between(0, 2), dice_.between(0, 2), dice_.between(0, 2), dice_.between(0, 9)}
              .text;
    }
    if (dice_.one_in(3)) {
      arm += Words{R"(,"linear_m_s":{}.25,"rotation_rad_s":{}.5)", dice_.between(0, 2),
                   dice_.between(0, 4)}
                 .text;
    }
    if (is_missing_) arm += R"(,"missing_at_start":true)";
    return "{" + arm + "}";
  }

  [[nodiscard]] std::string command(Verb verb) {
    Command some{.verb = verb,
                 .mode = dice_.number<Mode>(0, kModeNames.size() - 1),
                 .objective = dice_.number<Objective>(0, kObjectiveNames.size() - 1),
                 .deflection = {dice_.number<std::int32_t>(-400, 400), 0, 0}};
    return std::string{encode(some).view()};
  }
  /// Without its line end.
  [[nodiscard]] static std::string text_of(std::string line) {
    line.resize(line.find('\r'));
    return line;
  }
  void spoil(std::string& line) {
    constexpr std::string_view kOdd{" :\t\0\r+-0a\x80", 10};
    const auto place = dice_.number<std::size_t>(0, std::ssize(line));
    if (dice_.one_in(3) && place < line.size()) {
      line.erase(place, 1);
    } else {
      line.insert(place, 1, dice_.one_of(kOdd));
    }
  }

  void say(std::string_view text) { send(std::as_bytes(std::span{text})); }
  void send(Bytes bytes) {
    if (open_.empty()) return connect();
    const auto who = dice_.one_in(5) ? dice_.one_of(open_) : open_.front();
    add({R"("dir":"to_device","conn":{},"hex":"{}")", who, to_hex(bytes)});
  }
  void touch(const Words& what) { add({R"("dir":"arm",{})", what.text}); }

  void pause() {
    if (dice_.one_in(6)) return;
    wait(dice_.one_in(3) ? dice_.between(1, 30) : dice_.mostly_low(20, 1'500));
  }

  std::string arm_;
  bool is_missing_ = false;
  std::vector<std::uint32_t> open_;
  std::uint32_t next_ = 1;
};

constexpr auto kCommands = std::to_array<Deed<Session>>({{10, &Session::order},
                                                         {4, &Session::make_ready},
                                                         {4, &Session::stop},
                                                         {5, &Session::freeze},
                                                         {6, &Session::fold},
                                                         {6, &Session::choose_mode},
                                                         {6, &Session::steer},
                                                         {6, &Session::run},
                                                         {2, &Session::odd_line},
                                                         {1, &Session::several},
                                                         {1, &Session::disconnect},
                                                         {3, &Session::rest},
                                                         {4, &Session::meet_beat}});
constexpr auto kSteering = std::to_array<Deed<Session>>({{8, &Session::choose_mode},
                                                         {12, &Session::steer},
                                                         {2, &Session::odd_arguments},
                                                         {2, &Session::freeze},
                                                         {1, &Session::stop},
                                                         {1, &Session::order},
                                                         {2, &Session::rest}});
constexpr auto kObjectives = std::to_array<Deed<Session>>({{12, &Session::run},
                                                           {2, &Session::freeze},
                                                           {1, &Session::stop},
                                                           {1, &Session::order},
                                                           {2, &Session::make_ready},
                                                           {3, &Session::rest}});
constexpr auto kFraming = std::to_array<Deed<Session>>({{6, &Session::odd_line},
                                                        {6, &Session::odd_arguments},
                                                        {4, &Session::garbage},
                                                        {2, &Session::endless_line},
                                                        {5, &Session::several},
                                                        {5, &Session::in_pieces},
                                                        {3, &Session::order},
                                                        {2, &Session::disconnect}});
constexpr auto kConnections = std::to_array<Deed<Session>>({{8, &Session::disconnect},
                                                            {4, &Session::connect},
                                                            {6, &Session::order},
                                                            {3, &Session::in_pieces},
                                                            {2, &Session::several},
                                                            {2, &Session::make_ready},
                                                            {2, &Session::run},
                                                            {1, &Session::terminate},
                                                            {3, &Session::rest},
                                                            {2, &Session::meet_beat}});
constexpr auto kFaults = std::to_array<Deed<Session>>({{10, &Session::fail},
                                                       {4, &Session::unplug},
                                                       {4, &Session::surge},
                                                       {3, &Session::move_arm},
                                                       {6, &Session::make_ready},
                                                       {6, &Session::order},
                                                       {3, &Session::fold},
                                                       {3, &Session::choose_mode},
                                                       {3, &Session::steer},
                                                       {3, &Session::run},
                                                       {2, &Session::rest}});

constexpr auto kDeaths = std::to_array<Deed<Session>>({{10, &Session::fail_in_command},
                                                       {4, &Session::misplace},
                                                       {4, &Session::knock},
                                                       {4, &Session::disconnect},
                                                       {6, &Session::console},
                                                       {4, &Session::run},
                                                       {3, &Session::fold},
                                                       {3, &Session::steer},
                                                       {3, &Session::choose_mode},
                                                       {3, &Session::make_ready},
                                                       {2, &Session::freeze}});

constexpr auto kThemes =
    std::to_array<Theme<Session>>({{"commands", 10, 2'000'000, 60'000'000, kCommands},
                                   {"steering", 5, 2'000'000, 40'000'000, kSteering},
                                   {"objectives", 4, 5'000'000, 80'000'000, kObjectives},
                                   {"framing", 6, 500'000, 10'000'000, kFraming},
                                   {"connections", 6, 1'000'000, 30'000'000, kConnections},
                                   {"faults", 4, 2'000'000, 40'000'000, kFaults},
                                   {"deaths", 4, 500'000, 20'000'000, kDeaths}});

}  // namespace

std::string draw(const Roll& roll) { return play<Session>(roll, kThemes); }

}  // namespace armjig::kinovazed::sessions
