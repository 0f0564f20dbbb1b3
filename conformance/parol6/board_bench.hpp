// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/stream_bench.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/parol6/joints.hpp"

namespace armjig::parol6::conformance {

/// The states in which cases begin, as indices into the suite's `starts`.
enum Start : std::uint8_t {
  kListening,  ///< answers idle frames
  kFresh,      ///< just switched on
  kHomed,      ///< homed, at its standby position, enabled
  kEnabled,    ///< enabled, standing, speeds 0, outputs off; homed or not, but where it was homed
               ///< if it may be: cases here begin to home, and must not meet a switch
};

/// A telemetry frame and when it came. The board made it between `asked` and `received`. Fields are
/// judged by the bytes that came.
struct Answer : TelemetryFrame {
  TelemetryBytes raw{};
  Instant asked{};     ///< when the last byte of the frame that it answers was handed over
  Instant received{};  ///< when its own last byte had come
};

/// Whether somebody looked all the time: from no answer to the next question is more than 100 ms.
[[nodiscard]] bool is_without_gap(std::span<const Answer> answers) noexcept;

// Frames with the board's own check byte, which every profile takes.
[[nodiscard]] CommandFrame with_code(int code);  ///< any, also one that means nothing
[[nodiscard]] CommandFrame with_code(Command code);
[[nodiscard]] CommandFrame idle();
using Speeds = std::array<int, kJointCount>;  ///< steps/s
[[nodiscard]] CommandFrame with_speeds(int code, const Speeds& speeds);
[[nodiscard]] CommandFrame jog(const Speeds& speeds);
[[nodiscard]] CommandFrame jog(std::size_t joint, int speed);
/// Positions are absolute counts.
[[nodiscard]] CommandFrame go_to(const std::array<Steps, kJointCount>& positions,
                                 const Speeds& speeds = {});

/// Idle, with something for the gripper.
[[nodiscard]] CommandFrame with_gripper(const GripperSetPoint& set_point);

/// A conversation with a PAROL6 board, in the words of its protocol.
class BoardBench final : public StreamBench {
 public:
  explicit BoardBench(Rig<StreamPort> rig);

  [[nodiscard]] bool is_alive() override;
  [[nodiscard]] bool revive() override;
  void bring_to(std::size_t start) override;
  void measure_noise() override;

  /// Sends a frame and takes its answer. None in time is a silence (`Bench::fail_by_silence`).
  Answer ask(const CommandFrame& frame) { return ask(frame, answer_time()); }
  Answer ask(const CommandFrame& frame, Duration within);
  /// Sends several frames in one write and takes an answer to each.
  std::vector<Answer> ask_together(const std::vector<CommandFrame>& frames);
  /// `ask`, then time for the board to act on it.
  Answer act(const CommandFrame& frame);
  /// Repeats a frame every 10 ms for a time and gives the last answer.
  Answer keep_asking(const CommandFrame& frame, Duration time);
  /// Repeats a frame every 10 ms until `is_reached` holds for an answer; none if it does not within
  /// the time, which is no finding yet.
  template <class Condition>
  std::optional<Answer> ask_until(const CommandFrame& frame, Condition is_reached,
                                  Duration within) {
    const auto deadline = now() + within;
    while (!is_over() && !error() && now() < deadline) {
      auto answer = ask(frame);
      if (!is_over() && is_reached(answer)) return answer;
      pause(kFramePeriod);
    }
    return std::nullopt;
  }

  /// Expects one answer to what was sent, now.
  Answer expect_answer();
  Answer expect_answer(Bytes sent) {
    send(sent);
    return expect_answer();
  }
  /// Expects none.
  void expect_silence();
  void expect_silence(Bytes sent) {
    send(sent);
    expect_silence();
  }
  /// Expects the answer to an idle frame to be whole, whatever it says.
  void expect_whole();
  /// Sends idle frames until one is answered, at most `most`; behind `about`.
  void expect_recovery(int most);

  /// Expects a field of telemetry, by its name in docs/spec, to have a value.
  void expect(const Answer& answer, std::string_view field, std::int64_t wanted);
  /// Expects some bits of a flag field.
  void expect_bits(const Answer& answer, std::string_view field, std::uint8_t mask,
                   std::uint8_t wanted);
  void expect_between(const Answer& answer, std::string_view field, std::int64_t least,
                      std::int64_t most);
  void expect_same(const Answer& answer, std::string_view field, const Answer& before);

  /// All answers of the last whole run of homing, 10 ms apart or less, the first one from before.
  /// If this machine did not look all the time, of an earlier one.
  [[nodiscard]] const std::vector<Answer>& homing_log() const noexcept { return homing_log_; }

  /// Time in which an answer has to come.
  [[nodiscard]] Duration answer_time() const;
  /// Time after which none will.
  [[nodiscard]] Duration silence_time() const;
  /// The board is switched off and on before the next case, and all around it put back, for this
  /// one leaves traces that no command takes away. Skips the case where nobody can do that, which
  /// is also where a guard would not let it pass.
  void spoil();
  /// The same of one that leaves a homed arm at its standby position, so that nothing but the board
  /// has to be put back: skips it where nobody can switch that off.
  void spoil_memory();
  /// Leads a homed arm to its standby position, in pieces.
  void walk_to_standby();

  /// Longer than two passes of any board's loop.
  static constexpr Duration kPassTime = std::chrono::milliseconds{2};

 protected:
  /// It answers at 100 Hz before the next frame comes (parol6.frame.rate).
  [[nodiscard]] Duration longest_answer() const noexcept override { return kFramePeriod; }

 private:
  [[nodiscard]] std::optional<Answer> next_answer(Instant asked, Duration within);
  [[nodiscard]] bool has_switch();
  void power_cycle();
  void put_back_surroundings();
  void fail_to_understand();
  void fail_if_late(Instant asked, Duration within);
  Answer say_enable();
  void enable();
  void walk_back();
  void leave_switch();
  void home();
  void home_once();

  std::vector<Answer> homing_log_;
  bool has_seen_homing_ = false;                          ///< or given that up
  std::optional<std::array<Steps, kJointCount>> origin_;  ///< where `kEnabled` cases begin
  Instant last_answered_{};
  std::string not_understood_;  ///< what came last that is no answer, for people
  bool is_spoiled_ = false;
};

}  // namespace armjig::parol6::conformance
