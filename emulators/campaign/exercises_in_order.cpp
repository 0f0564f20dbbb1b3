// SPDX-License-Identifier: Apache-2.0
// Exercises with several messages: in each order, and in one piece.
#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "emulators/campaign/exercises.hpp"

namespace armjig::campaign {
namespace {

constexpr std::size_t kLength = 3;

/// All sequences of three symbols in one as short as can be: after de Bruijn, out of Lyndon words.
std::vector<std::size_t> all_sequences(std::size_t symbols) {
  std::vector<std::size_t> all;
  std::vector<std::size_t> word(symbols * kLength + 1);
  const std::function<void(std::size_t, std::size_t)> extend = [&](std::size_t at,
                                                                   std::size_t period) {
    if (at > kLength) {
      if (kLength % period != 0) return;
      all.insert(all.end(), word.begin() + 1, word.begin() + 1 + static_cast<long>(period));
      return;
    }
    word[at] = word[at - period];
    extend(at + 1, period);
    for (auto next = word[at - period] + 1; next < symbols; ++next) {
      word[at] = next;
      extend(at + 1, at);
    }
  };
  extend(1, 1);
  return all;
}

/// Whether its code, if it has one, is known.
bool is_named(const Message& message) {
  return code_in(message) == nullptr || name_of_code(message) != nullptr;
}

}  // namespace

/// What sequences are made of: what is sent often and does not only ask, and some of it with all
/// bits set.
std::vector<Script> Exercises::symbols(const Setting& setting) const {
  constexpr std::size_t kMostKinds = 8;
  constexpr std::size_t kMostFilled = 4;
  std::vector<Script> plain;
  std::vector<Script> filled;
  for (const auto& kind : repertoire_.kinds()) {
    const auto exchange = to(setting.exchange.front().id, kind.front().exchange);
    if (exchange.size() > 1 || strays(exchange) || !is_permitted(material_, exchange)) continue;
    if (plain.size() < kMostKinds) plain.push_back(exchange);
    if (material_.kind != LinkKind::kStream || filled.size() == kMostFilled) continue;
    const auto fields = free_fields(kind.front());
    if (fields.empty()) continue;
    auto other =
        with_all(kind.front(), fields, [](const Field& /*field*/) { return std::int64_t{-1}; });
    if (!other.empty()) filled.push_back(to(setting.exchange.front().id, std::move(other)));
  }
  plain.insert(plain.end(), filled.begin(), filled.end());
  return plain;
}

Script Exercises::sequences(const Setting& setting) const {
  Script body;
  const auto all = symbols(setting);
  if (all.empty()) return body;
  std::size_t number = 0;
  for (const auto symbol : all_sequences(all.size())) {
    add_apart(body, all[symbol]);
    look(body, number++);
  }
  return body;
}

std::vector<Script> Exercises::told_sequences() const {
  std::vector<Script> all;
  const auto& mover = repertoire_.mover();
  if (material_.kind != LinkKind::kStream || !mover) return all;
  std::vector<const Script*> symbols;
  for (const auto& kind : repertoire_.kinds()) {
    const auto& exchange = kind.front().exchange;
    if (is_named(kind.front().message) && !strays(exchange) && is_permitted(material_, exchange)) {
      symbols.push_back(&exchange);
    }
  }
  for (std::size_t most = 0; most < symbols.size(); ++most) {
    for (std::size_t number = 0; number < (most + 1) * (most + 1) * (most + 1); ++number) {
      const std::array three{number / (most + 1) / (most + 1), number / (most + 1) % (most + 1),
                             number % (most + 1)};
      if (std::ranges::max(three) != most) continue;
      auto& one = all.emplace_back();
      for (const auto symbol : three) add_apart(one, *symbols[symbol]);
      add_watched(one, mover->exchange);
    }
  }
  for (const auto* const first : symbols) {
    for (const auto* const second : symbols) {
      if (first == second) continue;
      auto& one = all.emplace_back(mover->before);
      for (int i = 0; i < 2; ++i) {
        add_apart(one, {in_one_piece(first->front(), second->front())});
      }
      add_watched(one, mover->exchange);
    }
  }
  return all;
}

Script Exercises::bursts(const Setting& setting) const {
  constexpr std::size_t kTogether = 5;
  Script body;
  const auto all = symbols(setting);
  if (material_.kind == LinkKind::kBus || all.empty()) return body;
  std::vector<std::byte> piece;
  std::size_t count = 0;
  for (const auto symbol : all_sequences(all.size())) {
    const auto& bytes = all[symbol].front().bytes;
    piece.insert(piece.end(), bytes.begin(), bytes.end());
    if (++count % kTogether == 0) {
      add_apart(body, {sending(all[symbol].front(), std::exchange(piece, {}))});
    }
  }
  return body;
}

}  // namespace armjig::campaign
