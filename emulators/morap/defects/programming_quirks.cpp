// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "emulators/morap/defects/quirk_words.hpp"
#include "emulators/morap/eeprom.hpp"

namespace armjig::morap::emulation {
namespace {

using enum CommandId;

constexpr std::size_t kInertiaPlace = 2;
constexpr std::size_t kPolePlace = 6;

// Parameter messages.
template <class Edit>
std::optional<SetBytes> edited(Bytes message, Edit edit) {
  const auto decoded = decode_set(message);
  const auto* good = std::get_if<ControllerSet>(&decoded);
  if (good == nullptr) return std::nullopt;
  auto set = *good;
  edit(set);
  return encode(set);
}
template <class Edit>
void edit_set(Words& command, Edit edit) {
  if (!is(command, kProgram)) return;
  const auto bytes = edited(Bytes{command}.subspan(1), edit);
  if (bytes) std::ranges::copy(bytes->view(), command.begin() + 1);
}
template <class Edit>
void edit_answer(Words& answer, Edit edit) {
  const auto bytes = edited(answer, edit);
  if (bytes) answer.assign(bytes->view().begin(), bytes->view().end());
}

/// Keeps the coefficients in the wrong order, or with the wrong sign, and reads them back right.
template <Coefficients ControllerSet::* filter>
void turn_round(ControllerSet& set) {
  const auto count = static_cast<std::ptrdiff_t>((set.*filter).count);
  std::reverse((set.*filter).values.begin(), (set.*filter).values.begin() + count);
}
template <Coefficients ControllerSet::* filter>
void negate(ControllerSet& set) {
  for (auto& value : (set.*filter).values) value = -value;
}
void negate_integral(ControllerSet& set) { set.integral = -set.integral; }
void exchange_filters(ControllerSet& set) { std::swap(set.d, set.c); }
template <void (*edit)(ControllerSet&)>
constexpr Change kHearSet =
    [](Words& command, QuirkMemory&, const Node&) { edit_set(command, edit); };
template <void (*edit)(ControllerSet&)>
constexpr Change kSaySet = [](Words& answer, QuirkMemory&, const Node& node) {
  // Stored sets were not turned round when they came; only the default ones are stored.
  if (answers_set(node)) edit_answer(answer, edit);
};

constexpr Change kKindsExchanged = [](Words& command, QuirkMemory&, const Node&) {
  edit_set(command, [](ControllerSet& set) {
    if (set.kind <= ControllerKind::kSpeed) {
      set.kind =
          set.kind == ControllerKind::kSpeed ? ControllerKind::kPosition : ControllerKind::kSpeed;
    }
  });
};

/// Takes a set with the checksum that `sum` makes of it, and no other.
template <std::uint8_t (*sum)(Bytes payload)>
constexpr Change kChecks = [](Words& command, QuirkMemory&, const Node&) {
  if (!is(command, kProgram) || command.size() < 1 + kSmallestSetSize) return;
  const auto payload = Bytes{command}.subspan(1, command.size() - 2);
  const auto good = checksum(payload);
  const bool is_taken = std::to_integer<std::uint8_t>(command.back()) == sum(payload);
  command.back() = static_cast<std::byte>(is_taken ? good : good + 1);
};
unsigned sum_of(Bytes payload) {
  unsigned sum = 0;
  for (const auto byte : payload) sum += std::to_integer<unsigned>(byte);
  return sum;
}
std::uint8_t plain(Bytes payload) { return static_cast<std::uint8_t>(~checksum(payload)); }
std::uint8_t unfolded(Bytes payload) { return static_cast<std::uint8_t>(~sum_of(payload)); }
std::uint8_t folded_once(Bytes payload) {
  const auto sum = sum_of(payload);
  return static_cast<std::uint8_t>(~((sum >> 8U) + (sum & 0xFFU)));
}
std::uint8_t of_head(Bytes payload) { return checksum(payload.first(payload.size() - 4)); }
constexpr Change kChecksNothing = [](Words& command, QuirkMemory&, const Node&) {
  if (!is(command, kProgram) || command.size() < 1 + kSmallestSetSize) return;
  const auto payload = Bytes{command}.subspan(1, command.size() - 2);
  command.back() = static_cast<std::byte>(checksum(payload));
};
constexpr Change kThreeAreMost = [](Words& command, QuirkMemory&, const Node&) {
  bool has_four = false;
  edit_set(command, [&](const ControllerSet& set) {
    has_four = set.d.count == 4 || set.c.count == 4 || set.f.count == 4;
  });
  if (has_four) become_refused(command);
};
constexpr Change kOneIsLeast = [](Words& command, QuirkMemory&, const Node&) {
  bool has_none = false;
  edit_set(command, [&](const ControllerSet& set) {
    has_none = set.d.count == 0 || set.c.count == 0 || set.f.count == 0;
  });
  if (has_none) become_refused(command);
};
/// A count of more than four is left without a word, in the filter number `filter`.
template <std::size_t filter>
constexpr Change kCountsUnchecked = [](Words& command, QuirkMemory&, const Node&) {
  if (!is(command, kProgram)) return;
  const auto decoded = decode_set(Bytes{command}.subspan(1));
  const auto* fault = std::get_if<SetFault>(&decoded);
  if (fault == nullptr || fault->kind != SetFault::Kind::kCountAboveFour) return;
  if (fault->offset == 3 + filter) command.clear();  // of messages without coefficients before it
};
/// Good and bad sets are installed, and bad ones reported.
constexpr Change kInstallsBad = [](Words& command, QuirkMemory& memory, const Node& node) {
  const auto before = command;
  kChecksNothing(command, memory, node);
  memory.count = is(command, kProgram) && command != before ? 1 : 0;
};
constexpr Change kSaysFailure = [](Words& answer, QuirkMemory& memory, const Node& node) {
  if (node.selected() == kReadProgrammingStatus && memory.count == 1) answer[0] = std::byte{3};
};

// What was written does not make a command.
bool is_programming(const Words& command) noexcept {
  return is(command, kProgram) || is(command, kTune);
}
constexpr Change kPadded = [](Words& command, QuirkMemory&, const Node&) {
  if (has_number(id_of(command))) command.resize(kFloatCommandSize);
};
constexpr Change kTunesEarly = [](Words& command, QuirkMemory&, const Node&) {
  if (is(command, kTune) && command.size() == kTuneCommandSize - 1) command.push_back({});
};
constexpr Change kCutFails = [](Words& command, QuirkMemory&, const Node&) {
  if (is_programming(command)) become_refused(command);
};
constexpr Change kCutSucceeds = [](Words& command, QuirkMemory&, const Node&) {
  if (!is(command, kProgram)) return;
  command.resize(1 + kSmallestSetSize);
  for (const std::size_t place : {4U, 5U, 6U}) command[place] = std::byte{0};
  command.back() = static_cast<std::byte>(checksum(Bytes{command}.subspan(1, 10)));
};
constexpr Change kJoined = [](Words& command, QuirkMemory& memory, const Node&) {
  memory.bytes.insert(memory.bytes.end(), command.begin(), command.end());
  command = memory.bytes;
};
constexpr Change kForgetsPieces = [](Words&, QuirkMemory& memory, const Node&) {
  memory.bytes.clear();
};
constexpr Change kModeAtId = [](Words& command, QuirkMemory& memory, const Node&) {
  if (!is_reference(id_of(command))) return;
  memory.bytes.resize(kFloatCommandSize);
  memory.bytes[0] = command[0];
  command = memory.bytes;
};
constexpr Change kRemembersFloat = [](Words& command, QuirkMemory& memory, const Node&) {
  if (has_number(id_of(command))) memory.bytes = command;
};
constexpr Change kCutForgets = [](Words& command, QuirkMemory& memory, const Node&) {
  if (is_programming(command)) memory.count = 1;
};
constexpr Change kWholeReminds = [](Words& command, QuirkMemory& memory, const Node&) {
  if (is_programming(command)) memory.count = 0;
};
constexpr Change kSaysNothingDone = [](Words& answer, QuirkMemory& memory, const Node& node) {
  if (node.selected() == kReadProgrammingStatus && memory.count == 1) answer[0] = std::byte{1};
};
constexpr Change kStatusReadOnce = [](Words& answer, QuirkMemory& memory, const Node& node) {
  if (node.selected() != kReadProgrammingStatus) return;
  if (memory.count++ > 0) answer[0] = std::byte{1};
};
constexpr Change kSurplusIsCommand = [](Words& command, QuirkMemory&, const Node&) {
  command.erase(command.begin(), command.end() - 1);
};
constexpr Change kSurplusFails = [](Words& command, QuirkMemory&, const Node&) {
  if (is_programming(command)) {
    become_refused(command);
  } else {
    command.clear();
  }
};
constexpr Change kSurplusDisables = [](Words& command, QuirkMemory&, const Node&) {
  become(command, kCalibrationUnknown);
};

// Defaults.
template <Eeprom (*stored)(std::uint8_t), ControllerSet Eeprom::* set>
constexpr Change kOnlyOneDefault = [](Words& command, QuirkMemory&, const Node&) {
  if (!is(command, kDefaultControllers)) return;
  const auto bytes = encode(Command{kProgram, stored(0).*set});
  command.assign(bytes.view().begin(), bytes.view().end());
};
constexpr Change kNotesDefaults = [](Words& command, QuirkMemory& memory, const Node&) {
  if (is(command, kDefaultControllers)) memory.count = 1;
  if (is_programming(command)) memory.count = 0;
};
template <std::uint8_t status>
constexpr Change kSaysOfDefaults = [](Words& answer, QuirkMemory& memory, const Node& node) {
  if (node.selected() == kReadProgrammingStatus && memory.count == 1) answer[0] = std::byte{status};
};

// Tuning.
template <class Edit>
void edit_tuning(Words& command, Edit edit) {
  if (!is(command, kTune)) return;
  auto inertia = float_at(command, kInertiaPlace);
  auto pole = float_at(command, kPolePlace);
  edit(command[1], inertia, pole);
  set_float(command, kInertiaPlace, inertia);
  set_float(command, kPolePlace, pole);
}
using EditTuning = void (*)(std::byte& kind, float& inertia, float& pole);
template <EditTuning edit>
constexpr Change kTunes =
    [](Words& command, QuirkMemory&, const Node&) { edit_tuning(command, edit); };
constexpr std::byte kNoKind{9};
constexpr EditTuning kAnyKind = [](std::byte& kind, float&, float&) {
  if (kind > std::byte{2}) kind = std::byte{0};
};
constexpr EditTuning kHeavy = [](std::byte&, float& inertia, float&) {
  inertia = std::min(inertia, kLargestInertia);
};
constexpr EditTuning kNegativeInertia = [](std::byte&, float& inertia, float&) {
  inertia = std::fabs(inertia);
};
constexpr EditTuning kPositivePole = [](std::byte&, float&, float& pole) {
  pole = -std::fabs(pole);
};
constexpr EditTuning kFastPole = [](std::byte&, float&, float& pole) {
  pole = std::max(pole, kFastestPole);
};
constexpr EditTuning kRefusesTen = [](std::byte& kind, float& inertia, float&) {
  if (inertia >= kLargestInertia) kind = kNoKind;
};
constexpr EditTuning kRefuses200 = [](std::byte& kind, float&, float& pole) {
  if (pole <= kFastestPole) kind = kNoKind;
};
constexpr EditTuning kRefusesZeroPole = [](std::byte& kind, float&, float& pole) {
  if (pole == 0.0F) kind = kNoKind;
};
constexpr EditTuning kPoleBounded = [](std::byte&, float&, float& pole) {
  pole = std::max(pole, -100.0F * 0.5F);
};
constexpr EditTuning kPdForPid = [](std::byte& kind, float&, float&) {
  if (kind == std::byte{1}) kind = std::byte{0};
};
constexpr EditTuning kDoubleInertia = [](std::byte&, float& inertia, float&) { inertia *= 2.0F; };
template <ControllerKind kind, std::uint16_t from, std::uint16_t to>
constexpr Change kRateSaid = [](Words& answer, QuirkMemory&, const Node& node) {
  if (!answers_set(node)) return;
  edit_answer(answer, [](ControllerSet& set) {
    if (set.kind == kind && set.rate_hz == from) set.rate_hz = to;
  });
};

constexpr auto kProgrammingQuirks = std::to_array<Quirk>({
    {.name = "d-order",
     .section = "Feedback",
     .hear = kHearSet<turn_round<&ControllerSet::d>>,
     .say = kSaySet<turn_round<&ControllerSet::d>>},
    {.name = "c-order",
     .section = "Feedback",
     .hear = kHearSet<turn_round<&ControllerSet::c>>,
     .say = kSaySet<turn_round<&ControllerSet::c>>},
    {.name = "f-order",
     .section = "Feedback",
     .hear = kHearSet<turn_round<&ControllerSet::f>>,
     .say = kSaySet<turn_round<&ControllerSet::f>>},
    {.name = "d-sign",
     .section = "Feedback",
     .hear = kHearSet<negate<&ControllerSet::d>>,
     .say = kSaySet<negate<&ControllerSet::d>>},
    {.name = "c-sign",
     .section = "Feedback",
     .hear = kHearSet<negate<&ControllerSet::c>>,
     .say = kSaySet<negate<&ControllerSet::c>>},
    {.name = "f-sign",
     .section = "Feedback",
     .hear = kHearSet<negate<&ControllerSet::f>>,
     .say = kSaySet<negate<&ControllerSet::f>>},
    {.name = "integral-sign",
     .section = "Feedback",
     .hear = kHearSet<negate_integral>,
     .say = kSaySet<negate_integral>},
    {.name = "filters-exchanged",
     .section = "Feedback",
     .hear = kHearSet<exchange_filters>,
     .say = kSaySet<exchange_filters>},
    {.name = "kinds-exchanged", .section = "Programming", .hear = kKindsExchanged},
    {.name = "checksum-ignored", .section = "Programming", .hear = kChecksNothing},
    {.name = "checksum-plain", .section = "Programming", .hear = kChecks<plain>},
    {.name = "checksum-unfolded", .section = "Programming", .hear = kChecks<unfolded>},
    {.name = "checksum-folded-once", .section = "Programming", .hear = kChecks<folded_once>},
    {.name = "checksum-of-head", .section = "Programming", .hear = kChecks<of_head>},
    {.name = "three-are-most", .section = "Programming", .hear = kThreeAreMost},
    {.name = "one-is-least", .section = "Programming", .hear = kOneIsLeast},
    {.name = "count-unchecked-d", .section = "Programming", .hear = kCountsUnchecked<0>},
    {.name = "count-unchecked-c", .section = "Programming", .hear = kCountsUnchecked<1>},
    {.name = "count-unchecked-f", .section = "Programming", .hear = kCountsUnchecked<2>},
    {.name = "installs-bad", .section = "Programming", .hear = kInstallsBad, .say = kSaysFailure},
    {.name = "padded-float", .section = "Writing", .finish = kPadded},
    {.name = "tunes-early", .section = "Tuning", .finish = kTunesEarly},
    {.name = "cut-fails", .section = "Programming", .finish = kCutFails},
    {.name = "cut-succeeds", .section = "Programming", .finish = kCutSucceeds},
    {.name = "cut-forgets",
     .section = "Programming",
     .hear = kWholeReminds,
     .finish = kCutForgets,
     .say = kSaysNothingDone},
    {.name = "pieces-joined", .section = "Writing", .hear = kForgetsPieces, .finish = kJoined},
    {.name = "mode-at-id", .section = "Writing", .hear = kRemembersFloat, .finish = kModeAtId},
    {.name = "status-read-once",
     .section = "Programming",
     .hear = kWholeReminds,
     .say = kStatusReadOnce},
    {.name = "surplus-is-command", .section = "Writing", .surplus = kSurplusIsCommand},
    {.name = "surplus-fails", .section = "Writing", .surplus = kSurplusFails},
    {.name = "surplus-forgets", .section = "Writing", .surplus = kSurplusDisables},
    {.name = "defaults-only-position",
     .section = "Programming",
     .hear = kOnlyOneDefault<dcx22l, &Eeprom::position>},
    {.name = "defaults-only-speed",
     .section = "Programming",
     .hear = kOnlyOneDefault<dcx22l, &Eeprom::speed>},
    {.name = "defaults-succeed",
     .section = "Programming",
     .hear = kNotesDefaults,
     .say = kSaysOfDefaults<2>},
    {.name = "defaults-fail",
     .section = "Programming",
     .hear = kNotesDefaults,
     .say = kSaysOfDefaults<3>},
    {.name = "tunes-any-kind", .section = "Tuning", .hear = kTunes<kAnyKind>},
    {.name = "tunes-heavy", .section = "Tuning", .hear = kTunes<kHeavy>},
    {.name = "tunes-negative-inertia", .section = "Tuning", .hear = kTunes<kNegativeInertia>},
    {.name = "tunes-positive-pole", .section = "Tuning", .hear = kTunes<kPositivePole>},
    {.name = "tunes-fast-pole", .section = "Tuning", .hear = kTunes<kFastPole>},
    {.name = "tunes-below-ten", .section = "Tuning", .hear = kTunes<kRefusesTen>},
    {.name = "tunes-below-200", .section = "Tuning", .hear = kTunes<kRefuses200>},
    {.name = "tunes-no-zero-pole", .section = "Tuning", .hear = kTunes<kRefusesZeroPole>},
    {.name = "tunes-to-fifty", .section = "Tuning", .hear = kTunes<kPoleBounded>},
    {.name = "tunes-pd-for-pid", .section = "Tuning", .hear = kTunes<kPdForPid>},
    {.name = "tunes-double-inertia", .section = "Tuning", .hear = kTunes<kDoubleInertia>},
    {.name = "position-never-625",
     .section = "Tuning",
     .say = kRateSaid<ControllerKind::kPosition, 625, 400>},
    {.name = "position-never-400",
     .section = "Tuning",
     .say = kRateSaid<ControllerKind::kPosition, 400, 625>},
    {.name = "speed-never-625",
     .section = "Tuning",
     .say = kRateSaid<ControllerKind::kSpeed, 625, 400>},
    {.name = "speed-never-400",
     .section = "Tuning",
     .say = kRateSaid<ControllerKind::kSpeed, 400, 320>},
    {.name = "speed-never-320",
     .section = "Tuning",
     .say = kRateSaid<ControllerKind::kSpeed, 320, 400>},
});

}  // namespace

std::span<const Quirk> programming_quirks() noexcept { return kProgrammingQuirks; }

}  // namespace armjig::morap::emulation
