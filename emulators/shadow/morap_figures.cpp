// SPDX-License-Identifier: Apache-2.0
#include "emulators/shadow/morap_figures.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>

#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::shadow {
namespace {

/// Whose addresses were acknowledged.
Outcome<FigureAnswer> nodes(const FitTalk& talk, const DeviceOptions& /*so_far*/) {
  std::set<unsigned> found;
  for (const auto& [address, message] : talk.said) {
    const auto one = static_cast<std::uint8_t>(address);
    if (is_node_address(one) && one != pen::kAddress) found.insert(node_of(one));
  }
  return FigureAnswer{.value = fmt::format("{}", fmt::join(found, ",")),
                      .estimates = {},
                      .basis = fmt::format("{} nodes answered", found.size())};
}

Outcome<FigureAnswer> has_pen(const FitTalk& talk, const DeviceOptions& /*so_far*/) {
  const bool is_there = std::ranges::any_of(
      talk.said, [](const FitTalk::Said& one) { return one.id == pen::kAddress; });
  return FigureAnswer{
      .value = is_there ? "yes" : "no", .estimates = {}, .basis = "whether its address answered"};
}

Outcome<FigureAnswer> motor(const FitTalk& talk, const DeviceOptions& so_far) {
  static constexpr std::array<std::string_view, 2> kMotors{"dcx22l", "dcx26l"};
  return choose_word(talk, so_far, "motor", kMotors, {});
}

/// How far shafts are from where they were, root of the mean of squares, in rad.
double astray(const TalkReplay& replay) {
  double squares = 0;
  double count = 0;
  for_each_pair(replay, [&](const RecordedMessage& one, const RecordedMessage& other) {
    const auto* const field = find_field(one.message.fields, "angle");
    if (field == nullptr || other.message.fields.data() != one.message.fields.data()) return;
    const auto angle_of = [field](const RecordedMessage& said) {
      return number_of(*field, field_value(*field, said.message.raw));
    };
    const auto off = angle_of(one) - angle_of(other);
    squares += off * off;
    ++count;
  });
  return count == 0 ? 0 : std::sqrt(squares / count);
}

/// Under a voltage or a loop the shaft gains speed by its inertia.
Outcome<FigureAnswer> inertia(const FitTalk& talk, const DeviceOptions& so_far) {
  constexpr double kSmallest = 1e-9;  ///< in rad: below what a count is
  const ValleySearch search{.least = 1e-3, .most = 10, .resolution = 1e-4, .is_geometric = true};
  const auto valley = search.find([&](double value) {
    return talk.play(with(so_far, "inertia", fmt::format("{:.4f}", value))).map(astray);
  });
  if (!valley) return tl::unexpected{valley.error()};
  const auto middle = (valley->least + valley->most) / 2;
  FigureAnswer answer{
      .estimates = {{"", middle, valley->least, valley->most}},
      .basis = fmt::format("angles are {:.2g} rad off, up to {:.2g} rad with others", valley->score,
                           valley->worst_score)};
  if (valley->worst_score > valley->score * 1.5 + kSmallest &&
      valley->most <= valley->least * 1.04) {
    answer.value = roundest(middle - 1e-5, middle + 1e-5);
  } else {
    answer.basis += ": too little depends on it";
  }
  return answer;
}

constexpr std::string_view kLikeInertia =
    "in one motion friction and load look alike; measure them, or give them as options";

constexpr std::array kFigures{
    FitFigure{"clock", "%", nullptr, "nothing that a node says counts its time"},
    FitFigure{"nodes", "", nodes},
    FitFigure{"pen", "", has_pen},
    FitFigure{"motor", "", motor},
    FitFigure{"inertia", "kg m^2", inertia},
    FitFigure{"viscous", "N m s/rad", nullptr, kLikeInertia},
    FitFigure{"dry", "N m", nullptr, kLikeInertia},
    FitFigure{"load", "N m", nullptr, kLikeInertia},
};

}  // namespace

std::span<const FitFigure> figures() noexcept { return kFigures; }

}  // namespace armjig::morap::shadow
