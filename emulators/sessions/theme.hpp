// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "emulators/sessions/dice.hpp"

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

/// A recording without answers, line by line.
class Script {
 public:
  void set_header(std::string line) { header_ = std::move(line); }
  void add(std::string_view line) {
    lines_ += line;
    lines_ += '\n';
  }
  [[nodiscard]] std::string text() const { return header_ + '\n' + lines_; }

 private:
  std::string header_;
  std::string lines_;
};

/// The session of that seed. `Session` is made of dice, the theme's name, the seed and how long it
/// lasts, knows its time (`now_us`) and ends with `finish`, which gives the text.
template <class Session>
[[nodiscard]] std::string play(std::uint64_t seed, std::span<const Theme<Session>> themes) {
  Dice dice{seed};
  const auto& theme = dice.weighted(themes, &Theme<Session>::weight);
  const auto end = dice.mostly_low(theme.shortest_us, theme.longest_us);
  Session session{dice, theme.name, seed};
  while (session.now_us() < end) {
    std::invoke(dice.weighted(theme.deeds, &Deed<Session>::weight).act, session);
  }
  return session.finish();
}

}  // namespace armjig::sessions
