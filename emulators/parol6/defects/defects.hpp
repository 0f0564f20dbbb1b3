// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "emulators/faults/fault.hpp"
#include "emulators/faults/named_fault.hpp"
#include "emulators/parol6/arm.hpp"
#include "emulators/parol6/defects/ears.hpp"
#include "emulators/parol6/defects/quirks.hpp"
#include "harness/core/error.hpp"

namespace armjig::parol6::emulation {

/// The states of the command table (docs/spec/parol6.md, "Commands").
enum class BoardState : std::uint8_t { kEnabled, kDisabled, kHoming };

/// A wrong row of that table: in a state a code acts as another one, or as if the command before
/// went on.
struct WrongRow {
  BoardState state{};
  Command code{};  ///< `kUnknown` stands for all that have no meaning
  std::optional<Command> acts_as{};
};
inline constexpr Command kUnknown{42};

/// Outputs or gripper fields that are not taken from frames of one code.
struct DeafFields {
  enum class What : std::uint8_t { kOutputs, kGripper };
  What what{};
  Command code{};
};

/// What is wrong with a board, apart from what its answers go through (`Faulty`).
struct Defects {
  std::vector<Fault> heard;  ///< of the fields of command frames
  std::vector<WrongRow> rows;
  std::vector<DeafFields> deaf;
  std::vector<const Quirk*> quirks;
  EarDefect ears = EarDefect::kNone;

  [[nodiscard]] bool are_none() const noexcept {
    return heard.empty() && rows.empty() && deaf.empty() && quirks.empty() &&
           ears == EarDefect::kNone;
  }
};

/// A fault of an emulated board as users write it. All forms of `parse_fault` with telemetry
/// fields go to `sent`; others change `arm` or `defects`:
///
/// - `in.KIND:FIELD`: a field of command frames.
/// - `row:STATE.CODE.CODE`: in a state a code acts as another, or, with `kept`, as the one before.
/// - `deaf:outputs.CODE`: outputs, or `gripper`, are not taken from frames of that code.
/// - `ears:NAME`, `quirk:NAME`, `rare:NAME`: a defect of reception, a wrong behaviour, one that no
///   suite asks for.
/// - `profile:NAME`: one difference of the profile turned round.
/// - `homing:jN.FIGURE`, `demo:jN.FIGURE`: a wrong figure.
/// - `plant:mirrored.jN`, `timer:BITS`: an axis that turns the wrong way, a narrower timer.
/// - `check:d4`, `check:d4-or-e4`: only these check bytes are taken.
///
/// Problems: `kBadValue`.
[[nodiscard]] Outcome<void> add_fault(std::string_view text, ArmOptions& arm, Defects& defects,
                                      std::vector<Fault>& sent);

/// Every fault that there is, as `add_fault` reads it.
[[nodiscard]] std::vector<NamedFault> all_faults();

/// An arm with defects. Without any it is the arm itself.
class DefectiveArm : public Sending<SentBytes> {
 public:
  DefectiveArm(const ArmOptions& options, Defects defects);

  void receive(Instant time, Bytes bytes);
  void advance_to(Instant time);
  [[nodiscard]] std::optional<Instant> next_event() const noexcept { return arm_.next_event(); }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value);
  [[nodiscard]] static std::span<const DeviceInput> inputs() noexcept { return arm_inputs(); }

 private:
  /// A frame that waits for its answer.
  struct Asked {
    CommandFrame asked;
    CommandFrame passed;
    Duration gap{};
  };

  void hear(Instant time, const Ears::Body& body);
  [[nodiscard]] CommandFrame changed(const CommandFrame& asked, Duration gap);
  void apply_row(CommandFrame& frame) const;
  [[nodiscard]] BoardState state() const noexcept;
  void take_answers();
  [[nodiscard]] SentBytes changed(const SentBytes& answer);

  Arm arm_;
  Defects defects_;
  Ears ears_;
  std::vector<std::optional<std::int64_t>> heard_memories_;
  std::vector<QuirkMemory> quirk_memories_;
  std::vector<Asked> asked_;  ///< oldest first
  CommandFrame last_asked_{};
  CommandFrame last_passed_{};
  Instant last_heard_{};
};

static_assert(EmulatedStream<DefectiveArm>);

}  // namespace armjig::parol6::emulation
