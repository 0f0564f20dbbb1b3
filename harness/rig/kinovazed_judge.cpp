// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/kinovazed_judge.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <variant>

#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::kinovazed::rig {
namespace {

/// By `Verb`.
constexpr std::array<Hazard, kVerbNames.size()> kHazards{
    Hazard::kObserve,  // EStop
    Hazard::kState,    // QuitEStop
    Hazard::kHome,     // Initialize
    Hazard::kMove,     // Unfold
    Hazard::kMove,     // Retract
    Hazard::kState,    // Freeze
    Hazard::kState,    // Unfreeze
    Hazard::kState,    // SetJoystickMode
    Hazard::kMove,     // MoveJoystick
    Hazard::kMove,     // RunObjective
    Hazard::kMove,     // SetActiveObjective: also of an objective that runs
    Hazard::kState,    // GetObjectivePosition
    Hazard::kObserve,  // GetAbsolutePosition
};

constexpr std::size_t kLongestWord =
    std::ranges::max(kVerbNames, {}, &std::string_view::size).size();
constexpr int kBeatsAtRest = 2;  ///< the first may be older than what was written last
/// Ends whatever was half sent; an empty line means nothing.
constexpr std::string_view kLineEnd = "\r\n";
constexpr std::string_view kStop = "\r\nEStop\r\n";

bool moves(Hazard hazard) noexcept { return hazard == Hazard::kMove || hazard == Hazard::kHome; }

class KinovaJudge final : public OneStopJudge {
 public:
  KinovaJudge() { stop_by(std::as_bytes(std::span{kStop})); }

  /// The shipped server keeps some of a line whose client has gone, and nobody here knows how much
  /// (kinovazed.line.carry-over).
  [[nodiscard]] Bytes opening_bytes() const override {
    return std::as_bytes(std::span{kStop}).first(written_.line.empty() ? 0 : kLineEnd.size());
  }
  [[nodiscard]] bool needs_opening() const override { return written_.may_begin_word; }

  std::optional<Refusal> judge(Messages messages, const Permissions& permissions) override {
    auto next = written_;
    for (const auto byte : messages.front()) {
      next.add(static_cast<char>(byte));
      const auto verb = next.completed();
      if (!verb) continue;
      const auto hazard = kHazards[static_cast<std::size_t>(*verb)];
      if (auto refusal = demand(hazard, permissions, to_string(*verb))) return refusal;
      if (moves(hazard)) next.may_be_moving = true;
      if (*verb == Verb::kMoveJoystick) next.is_stick_deflected = true;
      if (hazard != Hazard::kObserve) next.beats_at_rest = 0;
    }
    written_ = next;
    return std::nullopt;
  }

  void observe(Bytes bytes) override {
    for_each_step(splitter_, bytes, [this](const LineSplitter::Step& step) {
      if (step.found != LineSplitter::Found::kLine) return;
      const auto message = decode_message(step.line);
      if (!message) return;
      if (const auto* const beat = std::get_if<Heartbeat>(&*message)) take(*beat);
    });
  }

  [[nodiscard]] bool may_be_moving() const override { return written_.may_be_moving; }

 private:
  /// What was written, as far as it matters.
  struct Written {
    std::string line;  ///< the end of the one that is being written, also across connections
    bool may_begin_word = false;  ///< a byte of that line may be the first of a command
    bool may_be_moving = false;
    bool is_stick_deflected = false;
    int beats_at_rest = 0;

    void add(char byte) {
      if (byte == '\n') {
        if (line.ends_with("MoveJoystick:0:0:0\r")) is_stick_deflected = false;
        may_begin_word = false;
        return line.clear();
      }
      may_begin_word =
          may_begin_word || std::ranges::any_of(kVerbNames, [byte](std::string_view name) {
            return name.front() == byte;
          });
      if (line.size() == 2 * kLongestWord) line.erase(0, 1);
      line.push_back(byte);
    }
    [[nodiscard]] std::optional<Verb> completed() const {
      // The longest counts: QuitEStop, not EStop.
      std::optional<Verb> found;
      for (std::size_t i = 0; i < kVerbNames.size(); ++i) {
        const bool is_longer = !found || kVerbNames[i].size() > to_string(*found).size();
        if (is_longer && line.ends_with(kVerbNames[i])) found = static_cast<Verb>(i);
      }
      return found;
    }
  };

  void take(Heartbeat beat) {
    constexpr auto kRest = beat::kEmergencyStop | beat::kFreezed | beat::kIdle | beat::kRetracted;
    const bool is_steered = (beat.flags & beat::kInJoystickMode) != 0;
    const bool is_at_rest =
        (beat.flags & kRest) != 0 || (is_steered && !written_.is_stick_deflected);
    written_.beats_at_rest = is_at_rest ? written_.beats_at_rest + 1 : 0;
    if (written_.beats_at_rest < kBeatsAtRest) return;
    written_.may_be_moving = false;
    if (!is_steered) written_.is_stick_deflected = false;
  }

  Written written_;
  LineSplitter splitter_;
};

}  // namespace

std::unique_ptr<Judge> make_judge() { return std::make_unique<KinovaJudge>(); }

}  // namespace armjig::kinovazed::rig
