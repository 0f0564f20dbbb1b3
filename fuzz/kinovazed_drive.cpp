// SPDX-License-Identifier: Apache-2.0
// The client's side on whatever a server says: what leaves is whole lines of the protocol, each
// request ends once, and nothing is waited for without end.
//
// Input: one byte of choices, then operations, each one byte and its arguments.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>

#include "fuzz/input.hpp"
#include "fuzz/require.hpp"
#include "harness/drive/kinovazed/drive.hpp"

namespace armjig::fuzz::server_drive {
namespace {

using namespace std::chrono_literals;
using namespace kinovazed;
using drive::Drive;
using drive::DriveEvent;

constexpr int kMostOperations = 400;

class Bench {
 public:
  explicit Bench(std::uint8_t choices)
      : drive_{{.profile = (choices & 1) != 0 ? kinovazed::Profile::kDocumented
                                              : kinovazed::Profile::kFirmware,
                .stick_watchdog = (choices & 2) != 0 ? 0ms : 500ms}} {}

  void operate(Input& input) {
    const auto what = input.u8();
    switch (what % 10) {
      case 0:
        drive_.connect(now_);
        break;
      case 1:
        if (what > 200) drive_.disconnect(now_);
        break;
      case 2:
      case 3:
        begin(input);
        break;
      case 4:
        if (const auto id = drive_.cancel(now_); id && *id) open_.insert(**id);
        break;
      case 5:
        drive_.receive(now_, input.bytes(input.u8()));
        break;
      case 6:
      case 7:
        drive_.receive(now_, encode(Event{static_cast<Event>(what / 10 % kEventCount)}).bytes());
        break;
      case 8:
        drive_.receive(now_, encode(Heartbeat{.flags = input.u8()}).bytes());
        break;
      default:
        wait(std::chrono::milliseconds{16 * input.u8()});
    }
    look();
  }

  /// Nobody says anything any more.
  void end() {
    drive_.disconnect(now_);
    wait(1h);
    look();
    require(open_.empty(), "every request has ended");
    require(!drive_.due(), "and nothing is waited for");
  }

 private:
  static constexpr std::size_t kEventCount = kEventNames.size();

  void begin(Input& input) {
    Command command{.verb = Verb{static_cast<std::uint8_t>(input.u8() % kVerbNames.size())}};
    command.mode = Mode{static_cast<std::uint8_t>(input.u8() % kModeNames.size())};
    command.objective = Objective{static_cast<std::uint8_t>(input.u8() % kObjectiveNames.size())};
    command.deflection = {.x = input.i16(), .y = input.i16(), .z = input.i16()};
    const auto id = drive_.begin(now_, command);
    if (id) require(open_.insert(*id).second, "each request has a number of its own");
  }
  void wait(Duration duration) {
    const auto until = now_ + duration;
    while (drive_.due() && *drive_.due() <= until) {
      const auto before = drive_.due();
      now_ = std::max(now_, *before);
      drive_.tick(now_);
      require(drive_.due() != before, "what was due has been done");
      look();
    }
    now_ = until;
    drive_.tick(now_);
  }
  void look() {
    for (const auto& event : drive_.take_events()) {
      require(event.time <= now_, "events have happened");
      require(!describe(event).empty(), "an event has words");
      if (event.kind == DriveEvent::Kind::kEnded) open_.erase(event.request);
    }
    auto text = drive_.take_outgoing();
    while (!text.empty()) {
      const auto line = text.find('\n');
      require(line != std::string::npos, "whole lines leave");
      require(
          decode_command(std::string_view{text}.substr(0, line), kinovazed::Profile::kDocumented)
              .has_value(),
          "a line is a command");
      text.erase(0, line + 1);
    }
  }

  Drive drive_;
  Instant now_{};
  std::set<drive::RequestId> open_;  ///< that were begun here; the watchdog begins some, too
};

}  // namespace
}  // namespace armjig::fuzz::server_drive

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace armjig::fuzz;
  Input input{std::as_bytes(std::span{data, size})};
  server_drive::Bench bench{input.u8()};
  for (int i = 0; i < server_drive::kMostOperations && !input.is_empty(); ++i) bench.operate(input);
  bench.end();
  return 0;
}
