// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/what_if.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <utility>

namespace armjig {
namespace {

using Kind = Perturbation::Kind;
using Perturbations = std::vector<Perturbation>;

constexpr std::array kKinds{Kind::kLost, Kind::kTwice, Kind::kLate, Kind::kSwapped};

/// Tries sets of perturbations in an order, until one breaks something.
class Search {
 public:
  Search(const Trial& trial, const WhatIfHow& how, WhatIfAnswer& answer)
      : trial_{trial}, how_{how}, answer_{answer} {
    for (const auto& one : answer.undisturbed.broken) known_.insert(one.rule);
  }

  /// Losses of all pieces first, then what is rarer on links.
  Outcome<void> run() {
    const auto pieces = answer_.undisturbed.passed.size();
    const auto singles = pieces * kKinds.size();
    auto tried = try_all(singles, [this, pieces](std::size_t number) {
      return Perturbations{perturbation(number % pieces, number / pieces)};
    });
    if (!tried || answer_.found || how_.most < 2) return tried;
    const auto seconds = how_.reach * kKinds.size();
    return try_all(singles * seconds, [this, pieces, seconds](std::size_t number) {
      const auto first = number / seconds;
      const auto second = number % seconds;
      const auto other = first % pieces + 1 + second % how_.reach;
      if (other >= pieces) return Perturbations{};
      return Perturbations{perturbation(first % pieces, first / pieces),
                           perturbation(other, second / how_.reach)};
    });
  }

 private:
  [[nodiscard]] Perturbation perturbation(std::size_t piece, std::size_t number) const {
    const auto kind = kKinds.at(number);
    return {kind, answer_.undisturbed.passed[piece].name,
            kind == Kind::kLate ? how_.delay : Duration{}};
  }

  template <class MakeSet>
  Outcome<void> try_all(std::size_t count, MakeSet make_set) {
    std::atomic<std::size_t> best = count;
    std::atomic<std::size_t> tried = 0;
    std::atomic<bool> was_stopped = false;
    std::mutex guard;
    std::optional<Problem> failure;
    how_.for_each(count, [&](std::size_t number) {
      if (number > best) return;
      const auto wanted = make_set(number);
      if (wanted.empty()) return;
      if (how_.must_stop()) {
        was_stopped = true;
        return;
      }
      ++tried;
      auto found = look_for(wanted);
      const std::lock_guard lock{guard};
      if (!found) {
        failure = std::move(found.error());
        best = 0;
      } else if (*found && number <= best) {
        best = number;
        answer_.found = std::move(**found);
      }
    });
    answer_.tried += tried;
    if (was_stopped) answer_.is_complete = false;
    if (failure) return tl::unexpected{*std::move(failure)};
    return {};
  }

  Outcome<std::optional<WhatIfAnswer::Found>> look_for(const Perturbations& wanted) const {
    auto result = trial_(wanted);
    if (!result) return tl::unexpected{std::move(result.error())};
    const auto broken = first_new(*result);
    if (!broken) return std::nullopt;
    for (int i = 0; i < how_.confirmations; ++i) {
      const auto again = trial_(wanted);
      if (!again) return tl::unexpected{again.error()};
      const bool is_same = std::ranges::any_of(
          again->broken, [&](const Breakage& one) { return one.rule == broken->rule; });
      if (!is_same) return std::nullopt;
    }
    std::vector<Instant> times;
    for (const auto& one : wanted) times.push_back(time_of(one.piece));
    return WhatIfAnswer::Found{wanted, std::move(times), *broken, *std::move(result)};
  }

  [[nodiscard]] std::optional<Breakage> first_new(const TrialResult& result) const {
    const auto found = std::ranges::find_if(result.broken, [this](const Breakage& one) {
      return !known_.contains(one.rule) && !how_.ignored.contains(one.rule);
    });
    if (found == result.broken.end()) return std::nullopt;
    return *found;
  }

  [[nodiscard]] Instant time_of(const PieceName& name) const {
    const auto& passed = answer_.undisturbed.passed;
    const auto found = std::ranges::find(passed, name, &PassedPiece::name);
    return found == passed.end() ? Instant{} : found->time;
  }

  const Trial& trial_;
  const WhatIfHow& how_;
  WhatIfAnswer& answer_;
  std::set<std::string, std::less<>> known_;
};

std::string describe_one(const Perturbation& one, Instant time) {
  const bool is_host = one.piece.direction == Direction::kToDevice;
  const auto seconds = [](auto duration) {
    return std::chrono::duration<double>{duration}.count();
  };
  const auto delay =
      one.kind == Kind::kLate ? fmt::format(", by {:.3f} s", seconds(one.delay)) : std::string{};
  const bool is_swapped = one.kind == Kind::kSwapped;
  return fmt::format("one {}{}'{}' of the {} at {:.3f} s (number {}{}{})",
                     is_swapped ? "" : to_string(one.kind), is_swapped ? "" : " ", one.piece.name,
                     is_host ? "host" : "device", seconds(time.time_since_epoch()), one.piece.nth,
                     delay, is_swapped ? ", swapped with the next" : "");
}

/// The first message in there, whose fields can be compared.
std::optional<Message> message_of(const SaidPiece& piece, MakeDissector make_dissector) {
  std::vector<Message> messages;
  make_dissector()->feed(Direction::kFromDevice, piece.time, piece.bytes, messages);
  if (messages.empty()) return std::nullopt;
  return std::move(messages.front());
}

std::vector<std::string> fields_apart(const SaidPiece& without, const SaidPiece* with,
                                      MakeDissector make_dissector) {
  if (with == nullptr || make_dissector == nullptr) return {};
  const auto one = message_of(without, make_dissector);
  const auto other = message_of(*with, make_dissector);
  const bool is_alike = one && other && !one->fields.empty() && one->name == other->name &&
                        one->fields.data() == other->fields.data();
  return is_alike ? field_differences(one->fields, one->raw, other->raw)
                  : std::vector<std::string>{};
}

}  // namespace

std::optional<Apart> apart(const std::vector<SaidPiece>& without,
                           const std::vector<SaidPiece>& with, MakeDissector make_dissector) {
  std::optional<Apart> found;
  std::map<std::uint32_t, const SaidPiece*> said;
  auto next = with.begin();
  for (const auto& piece : without) {
    for (; next != with.end() && next->time <= piece.time; ++next) said[next->lane] = &*next;
    const auto last = said.find(piece.lane);
    const auto* const other = last == said.end() ? nullptr : last->second;
    const bool is_same = other != nullptr && other->bytes == piece.bytes;
    if (is_same) {
      if (found) found->is_to_the_end = false;
      continue;
    }
    if (!found) {
      found = Apart{piece.time, piece.time, true, fields_apart(piece, other, make_dissector)};
    }
    found->to = piece.time;
    found->is_to_the_end = true;
  }
  return found;
}

Outcome<WhatIfAnswer> what_if(const Trial& trial, const WhatIfHow& how) {
  auto undisturbed = trial({});
  if (!undisturbed) return tl::unexpected{std::move(undisturbed.error())};
  WhatIfAnswer answer{.undisturbed = *std::move(undisturbed), .found = {}};
  if (const auto run = Search{trial, how, answer}.run(); !run) return tl::unexpected{run.error()};
  return answer;
}

std::string describe(const WhatIfAnswer::Found& found) {
  std::string text;
  for (std::size_t i = 0; i < found.perturbations.size(); ++i) {
    text += i == 0 ? "" : " and ";
    text += describe_one(found.perturbations[i], found.times[i]);
  }
  return text;
}

}  // namespace armjig
