// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "emulators/sessions/dice.hpp"
#include "emulators/sessions/sessions.hpp"
#include "harness/core/time.hpp"

/// Sessions drawn at random, as text in the format `golden-trace/1`: a header and everything that
/// is done to the device, and nothing that it does.
namespace armjig::sessions {

/// What is done again and again, and how often as against the others of a theme.
template <class Session>
struct Deed {
  std::uint16_t weight{};
  void (Session::*act)(){};
};

/// A kind of session.
template <class Session>
struct Theme {
  std::string_view name;
  std::uint16_t weight{};  ///< how often it is drawn
  std::int64_t shortest_us{};
  std::int64_t longest_us{};
  std::span<const Deed<Session>> deeds;
};

/// `fmt::format` whose arguments are drawn from left to right, which braces promise and parentheses
/// do not: `Words{"{} {}", dice.byte(), dice.byte()}`.
struct Words {
  template <class... Values>
  Words(fmt::format_string<Values...> format, Values&&... values)  // NOLINT(*-explicit-*)
      : text{fmt::format(format, std::forward<Values>(values)...)} {}

  std::string text;
};

/// The unit of a recording's times.
enum class TimeUnit : std::uint16_t { kMicrosecond = 1, kMillisecond = 1000 };

/// A session that grows: what all devices' have.
class Draft {
 public:
  struct Start {
    Dice& dice;
    std::string_view theme;
    std::uint64_t seed;
  };
  explicit Draft(const Start& start, TimeUnit unit = TimeUnit::kMicrosecond)
      : dice_{start.dice}, theme_{start.theme}, seed_{start.seed}, unit_{unit} {}

  [[nodiscard]] std::int64_t now_us() const noexcept {
    return now_ * static_cast<std::int64_t>(unit_);
  }

 protected:
  /// A line with what is done now.
  void add(const Words& what) {
    lines_ += fmt::format("{{\"t_{}\":{},{}}}\n", unit_ == TimeUnit::kMicrosecond ? "us" : "ms",
                          now_, what.text);
  }
  void wait(std::int64_t time) { now_ += time; }
  /// The recording; its header ends with `more`.
  [[nodiscard]] std::string text(std::string_view device, std::string_view more) const {
    return fmt::format(R"({{"format":"golden-trace/1","device":"{}","source":"drawn at random",)"
                       R"("title":"random {}",{}}})"
                       "\n{}",
                       device, theme_, more, lines_);
  }

  Dice& dice_;
  std::string_view theme_;
  std::uint64_t seed_;
  std::int64_t now_ = 0;  ///< in its unit

 private:
  TimeUnit unit_;
  std::string lines_;
};

/// The session that falls, of at most `longest` and little more. `Session` is a draft, and ends
/// with `finish`, which gives the text.
template <class Session>
[[nodiscard]] std::string play(const Roll& roll, std::span<const Theme<Session>> themes) {
  auto dice = roll.dice;
  const auto& theme = dice.weighted(themes, &Theme<Session>::weight);
  const auto length = dice.mostly_low(theme.shortest_us, theme.longest_us);
  const auto end = std::min(length, microseconds(at(roll.longest)));
  Session session{Draft::Start{dice, theme.name, roll.seed}};
  while (session.now_us() < end && !dice.is_over()) {
    std::invoke(dice.weighted(theme.deeds, &Deed<Session>::weight).act, session);
  }
  return session.finish();
}

}  // namespace armjig::sessions
