// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/documented.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

namespace armjig::mealy {
namespace {

using Names = std::vector<std::string_view>;  ///< of a state in each table

const Row* row_of(const Table& table, std::string_view state, std::string_view letter) {
  const auto row = std::ranges::find_if(table.rows, [&](const Row& one) {
    return (one.from.empty() || one.from == state) && (one.letter.empty() || one.letter == letter);
  });
  return row == table.rows.end() ? nullptr : &*row;
}

Outcome<void> check_letters(std::span<const Table> tables, const std::vector<std::string>& letters,
                            const std::string& where) {
  for (const auto& table : tables) {
    for (const auto& row : table.rows) {
      if (!row.letter.empty() && std::ranges::find(letters, row.letter) == letters.end()) {
        return problem(
            ErrorCode::kBadValue, where,
            fmt::format("a row has the letter {}, which is not in the alphabet", row.letter));
      }
    }
  }
  return {};
}

class Building {
 public:
  Building(std::span<const Table> tables, const std::vector<std::string>& letters)
      : tables_{tables}, machine_{letters, {}} {
    Names first;
    for (const auto& table : tables) first.push_back(table.first);
    (void)place_of(first, {});
  }

  Outcome<Machine> build(const std::string& where) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      for (std::size_t j = 0; j < machine_.letters.size(); ++j) {
        auto step = step_of(i, static_cast<Letter>(j), where);
        if (!step) return tl::unexpected{step.error()};
        machine_.states[i].steps.push_back(*std::move(step));
      }
    }
    return std::move(machine_);
  }

 private:
  Outcome<Step> step_of(std::size_t from, Letter letter, const std::string& where) {
    auto names = names_[from];
    Names said;
    for (std::size_t i = 0; i < tables_.size(); ++i) {
      const auto* const row = row_of(tables_[i], names[i], machine_.letters[letter]);
      if (row == nullptr) {
        return problem(
            ErrorCode::kBadValue, where,
            fmt::format("no row says what {} does in {}", machine_.letters[letter], names[i]));
      }
      if (!row->said.empty()) said.push_back(row->said);
      if (!row->to.empty()) names[i] = row->to;
    }
    auto access = joined(machine_.states[from].access, {letter});
    return Step{place_of(names, std::move(access)), fmt::format("{}", fmt::join(said, ", "))};
  }

  /// Of one that is met for the first time, a new one.
  std::size_t place_of(const Names& names, Word access) {
    const auto [found, is_new] = places_.try_emplace(names, names_.size());
    if (is_new) {
      names_.push_back(names);
      machine_.states.push_back(
          {fmt::format("{}", fmt::join(names, " + ")), std::move(access), {}});
    }
    return found->second;
  }

  std::span<const Table> tables_;
  Machine machine_;
  std::vector<Names> names_;
  std::map<Names, std::size_t> places_;
};

}  // namespace

Outcome<Machine> documented(std::span<const Table> tables, const std::vector<std::string>& letters,
                            const std::string& where) {
  return check_letters(tables, letters, where).and_then([&] {
    return Building{tables, letters}.build(where);
  });
}

}  // namespace armjig::mealy
