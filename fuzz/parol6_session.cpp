// SPDX-License-Identifier: Apache-2.0
// Whole sessions with the emulated board: frames, splits, inputs, resets, CAN, at their times.
//
// Input: what falls when a session is drawn (`Roll`).
#include <array>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "emulators/parol6/firmware_receiver.hpp"
#include "fuzz/session.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::fuzz {
namespace {

using parol6::kJointCount;

class BoardPromises {
 public:
  using Device = parol6::emulation::Board;
  static constexpr auto replay_watched = parol6::replay::replay_watched;
  static constexpr std::size_t kMostHeap = 256 * 1024;

  explicit BoardPromises(const Trace& session)
      : pass_{nlohmann::json::parse(session.header).at("loop_us").get<std::int64_t>()} {
    parol6::emulation::FirmwareReceiver receiver;
    for (const auto& event : session.events) {
      if (event.dir != "to_device") continue;
      for (Bytes rest{event.bytes}; !rest.empty();) {
        const auto step = receiver.step(rest);
        rest = rest.subspan(step.used);
        if (step.accepted) ++accepted_;
      }
    }
  }

  /// A joint makes no more than a step in each pass, and none of the bits stands for no joint.
  void see(const Device& board, Instant time) {
    const auto plant = board.plant();
    const auto most = (time - time_) / pass_ + 2;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const std::int64_t position = plant.axes[j].position.value;
      const bool is_possible = !was_seen_ || std::abs(position - positions_[j]) <= most;
      require(is_possible, "a joint makes no more than a step in each pass");
      positions_[j] = position;
    }
    constexpr unsigned kNoJoints = 0xFFU >> kJointCount;  // joints are the bits from 7 down
    require((board.homing().homed() & kNoJoints) == 0, "only joints are homed");
    was_seen_ = true;
    time_ = time;
  }

  void hear(const std::vector<TraceEvent>& answers) const {
    const auto count = std::ranges::count(answers, "from_device", &TraceEvent::dir);
    require(std::cmp_less_equal(count, accepted_), "no frame is answered twice");
    require(count > 0 || accepted_ == 0, "frames are answered");
  }

  static void take_what_it_said(Device& board) { board.clear_sent(); }

 private:
  std::chrono::microseconds pass_;
  std::size_t accepted_ = 0;
  std::array<std::int64_t, kJointCount> positions_{};
  Instant time_{};
  bool was_seen_ = false;
};

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace std::chrono_literals;
  using armjig::fuzz::BoardPromises;
  armjig::fuzz::check_session<BoardPromises>(armjig::test::kDrawnDevices[0], {data, size}, 2s);
  return 0;
}
