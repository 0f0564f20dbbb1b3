// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/defects/defects.hpp"

#include <algorithm>
#include <utility>

namespace armjig::parol6::emulation {
namespace {

constexpr bool has_meaning(Command code) noexcept {
  switch (code) {
    case Command::kDemo:
    case Command::kHome:
    case Command::kEnable:
    case Command::kDisable:
    case Command::kClearError:
    case Command::kJog:
    case Command::kGoTo:
    case Command::kIdle:
      return true;
  }
  return false;
}

}  // namespace

DefectiveArm::DefectiveArm(const ArmOptions& options, Defects defects)
    : arm_{options},
      defects_{std::move(defects)},
      ears_{defects_.ears, options.profile},
      heard_memories_(defects_.heard.size()),
      quirk_memories_(defects_.quirks.size()) {}

void DefectiveArm::receive(Instant time, Bytes bytes) {
  if (defects_.are_none()) {
    arm_.receive(time, bytes);
  } else {
    advance_to(time - Duration{1});
    for (const auto& body : ears_.hear(time, bytes)) hear(time, body);
  }
  take_answers();
}

void DefectiveArm::advance_to(Instant time) {
  arm_.advance_to(time);
  take_answers();
}

bool DefectiveArm::set_input(Instant time, std::string_view name, std::int64_t value) {
  if (name == "power") {  // what waited for an answer has lost it
    asked_.clear();
    last_asked_ = {};
    last_passed_ = {};
    std::ranges::fill(quirk_memories_, QuirkMemory{});
  }
  const bool is_known = arm_.set_input(time, name, value);
  take_answers();
  return is_known;
}

void DefectiveArm::hear(Instant time, const Ears::Body& body) {
  const auto asked = decode_command(body);
  const auto gap = time - std::exchange(last_heard_, time);
  const auto passed = changed(asked, gap);
  asked_.push_back({asked, passed, gap});
  last_asked_ = asked;
  last_passed_ = passed;
  arm_.receive(time, encode(passed));
}

CommandFrame DefectiveArm::changed(const CommandFrame& asked, Duration gap) {
  auto bytes = encode(asked);
  for (std::size_t i = 0; i < defects_.heard.size(); ++i) {
    apply_fault(defects_.heard[i], bytes, heard_memories_[i]);
  }
  auto frame = decode_command(body_of(bytes));
  for (const auto& [what, code] : defects_.deaf) {
    if (frame.command != code) continue;
    if (what == DeafFields::What::kOutputs) frame.in_out = last_passed_.in_out;
    if (what == DeafFields::What::kGripper) frame.gripper = last_passed_.gripper;
  }
  for (std::size_t i = 0; i < defects_.quirks.size(); ++i) {
    quirk_memories_[i].gap = gap;
    if (const auto hear = defects_.quirks[i]->hear) hear(frame, quirk_memories_[i], arm_.board());
  }
  apply_row(frame);
  return frame;
}

void DefectiveArm::apply_row(CommandFrame& frame) const {
  const auto meaning = has_meaning(frame.command) ? frame.command : kUnknown;
  for (const auto& row : defects_.rows) {
    if (row.state != state() || row.code != meaning) continue;
    if (row.acts_as) {
      frame.command = *row.acts_as;
    } else {  // the command before goes on, with all that belongs to it
      frame.command = last_passed_.command;
      frame.position = last_passed_.position;
      frame.speed = last_passed_.speed;
    }
    return;
  }
}

BoardState DefectiveArm::state() const noexcept {
  if (!arm_.board().is_enabled()) return BoardState::kDisabled;
  return arm_.board().is_homing() ? BoardState::kHoming : BoardState::kEnabled;
}

void DefectiveArm::take_answers() {
  for (const auto& answer : arm_.sent()) {
    sent_.push_back(defects_.are_none() ? answer : changed(answer));
  }
  arm_.clear_sent();
}

/// Each frame that was passed on has one answer, in the same order.
SentBytes DefectiveArm::changed(const SentBytes& answer) {
  if (asked_.empty()) return answer;
  const auto asked = asked_.front();
  asked_.erase(asked_.begin());
  auto frame = decode_telemetry(body_of(Bytes{answer.bytes}.first<kTelemetryFrameSize>()));
  const auto truth = frame;
  // Which code the defect made of it, nobody is told, unless it stands in the frame itself.
  const bool is_heard_wrong = std::ranges::any_of(
      defects_.heard, [](const Fault& fault) { return fault.field->name == "command"; });
  if (!is_heard_wrong) frame.echo = asked.asked.command;
  for (std::size_t i = 0; i < defects_.quirks.size(); ++i) {
    auto& memory = quirk_memories_[i];
    memory.gap = asked.gap;
    if (const auto say = defects_.quirks[i]->say) say(frame, asked.asked, memory, arm_.board());
    memory.before = {asked.asked, asked.passed, truth, frame};
  }
  const auto bytes = encode(frame);
  return {answer.time, {bytes.begin(), bytes.end()}};
}

}  // namespace armjig::parol6::emulation
