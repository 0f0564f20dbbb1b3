// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/shrink.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

class Shrinking {
 public:
  Shrinking(Script script, MakeDissector make_dissector, const Shows& shows,
            const std::function<bool()>& may_go_on)
      : script_{std::move(script)},
        make_dissector_{make_dissector},
        shows_{shows},
        may_go_on_{may_go_on} {}

  [[nodiscard]] Script take() { return std::move(script_); }

  /// If the last one that showed it was given up again.
  void look_again() {
    if (!is_seen_last_) (void)shows_(script_);
  }

  /// Without what does not matter: large pieces first. False: nothing could be left out.
  bool leave_out() {
    const auto before = script_.size();
    for (auto piece = std::max<std::size_t>(script_.size() / 2, 1);; piece /= 2) {
      leave_out(piece);
      if (piece <= 1 || !may_go_on_()) return script_.size() < before;
    }
  }

  /// Without its end: by halves, which may leave more than it has to.
  void cut_end() {
    std::size_t shows_not = 0;
    for (auto size = script_.size() / 2; size > shows_not && may_go_on_();
         size = (shows_not + script_.size()) / 2) {
      auto other = script_;
      other.resize(size);
      if (!try_instead(std::move(other))) shows_not = size;
    }
  }

  /// Half by half without its beginning, nor the time that takes: of many cases in a row the last
  /// one may be enough, and each try takes as long as all of them.
  void cut_beginning() {
    while (script_.size() > 1 && try_instead(beginning_at(script_.size() / 2))) {
    }
  }

  /// What counts messages may count harmless ones, too: as few of them as do, in place of all but
  /// the last few records.
  void count(const Script& plain) {
    constexpr std::array<std::size_t, 3> kTails{1, 4, 12};
    for (const auto tail : kTails) {
      if (script_.size() < kMany) return;
      const auto full = script_;
      const auto most = (full.size() - tail) / std::max<std::size_t>(plain.size(), 1);
      const auto counted = [&](std::size_t times) {
        Script other;
        for (std::size_t i = 0; i < times; ++i) other = appended(std::move(other), plain);
        return appended(std::move(other),
                        Script(full.end() - static_cast<std::ptrdiff_t>(tail), full.end()));
      };
      if (!try_instead(counted(most))) continue;
      is_counted_ = true;
      std::size_t shows_not = 0;
      for (auto shows = most; shows - shows_not > 1 && may_go_on_();) {
        const auto times = (shows + shows_not) / 2;
        (try_instead(counted(times)) ? shows : shows_not) = times;
      }
    }
  }

  /// What counts bytes does not ask how many records they came in: as much as there is room for
  /// in each.
  void merge() {
    constexpr std::array<std::size_t, 3> kRooms{4096, 1024, 256};
    for (const auto most : kRooms) {
      if (is_counted_ || script_.size() < kMany) return;
      if (try_instead(with_merged(most, Pace::kKept)) ||
          try_instead(with_merged(most, Pace::kAtOnce))) {
        while (leave_out()) {
        }
      }
    }
  }

  /// What shows at a moment that has to be met is met by whoever looks often enough: some record or
  /// all up to it, then a question time and again. True: it is shorter for it.
  bool look_often(const Script& plain, std::size_t most_places) {
    constexpr std::size_t kFew = 3;
    if (script_.size() <= kFew) return false;
    const auto full = script_;
    const bool is_one = !plain.empty() && plain.front().kind == LinkKind::kStream;
    const auto brief = is_one ? Script{plain.front()} : plain;
    for (auto place = full.size(); place > 0 && most_places > 0; --place) {
      if (!is_sent(full[place - 1])) continue;
      --most_places;
      const auto exchange = exchange_at(full, place - 1);
      const auto end = full.begin() + static_cast<std::ptrdiff_t>(place);
      for (const auto& lead : {exchange, Script(full.begin(), end)}) {
        for (const auto& question : {exchange, brief}) {
          for (const auto pause : {1ms, 7ms}) {
            if (!may_go_on_()) return false;
            if (look_often(lead, question, pause, full.size())) return true;
            give_back(full);
          }
        }
      }
    }
    return false;
  }

  /// Of a long one without all that are alike, or all of them but the last, where there are many of
  /// them: each try may take as long as the script.
  void leave_out_alike() {
    constexpr std::size_t kMostKinds = 50;
    if (script_.size() < kMany) return;
    for (std::size_t i = 0; i < script_.size() && may_go_on_(); ++i) {
      const auto begin = script_.begin() + static_cast<std::ptrdiff_t>(i);
      const auto& one = *begin;
      const auto is_alike = [&one](const KeptRecord& other) {
        return other.kind == one.kind && other.direction == one.direction && other.id == one.id &&
               other.bytes == one.bytes && other.details == one.details;
      };
      if (std::find_if(script_.begin(), begin, is_alike) != begin) continue;  // has been looked at
      const auto count = std::count_if(begin, script_.end(), is_alike);
      if (static_cast<std::size_t>(count) * kMostKinds < script_.size()) continue;
      auto none = script_;
      std::erase_if(none, is_alike);
      if (try_instead(std::move(none))) {
        --i;
        continue;
      }
      auto last = script_;
      const auto kept = std::find_if(last.rbegin(), last.rend(), is_alike).base() - 1;
      last.erase(std::remove_if(last.begin(), kept, is_alike), kept);
      (void)try_instead(std::move(last));
    }
  }

  /// Whether nearly each of many records matters, as where something is counted.
  [[nodiscard]] bool is_dense() {
    return !is_counted_ && script_.size() >= kMany && !is_worth_it(1);
  }

  /// Messages in one piece that came in several: all of them, or of a short script those that may.
  void join() {
    auto joined = script_;
    for (std::size_t i = 0; i < joined.size(); ++i) {
      if (const auto count = pieces_at(joined, i); count > 1) join(joined, i, count);
    }
    if (joined == script_ || try_instead(std::move(joined)) || script_.size() >= kMany) return;
    for (std::size_t i = 0; i < script_.size() && may_go_on_(); ++i) {
      const auto count = pieces_at(script_, i);
      if (count <= 1) continue;
      auto other = script_;
      join(other, i, count);
      (void)try_instead(std::move(other));
    }
  }

  /// All pauses at most so long.
  void hurry() {
    constexpr std::array<Duration, 3> kLongest{1ms, 10ms, 100ms};
    for (const auto longest : kLongest) {
      if (try_instead(with_pauses(longest))) return;
    }
  }

  void simplify(const Script& plain) {
    constexpr std::size_t kMostLookedAt = 40;  // of more, people look at the first
    for (std::size_t i = 0; i < std::min(script_.size(), kMostLookedAt) && may_go_on_(); ++i) {
      if (!is_sent(script_[i]) || script_[i].bytes.empty()) continue;
      if (replace(i, plain)) continue;
      clear_fields(i);
      shorten(i);
    }
  }

 private:
  static constexpr std::size_t kMany = 100;  ///< more than anybody reads

  /// That record is the first one then.
  [[nodiscard]] Script beginning_at(std::size_t place) const {
    Script rest(script_.begin() + static_cast<std::ptrdiff_t>(place), script_.end());
    shift_from(rest, 0, -length_of(script_));
    return rest;
  }

  bool look_often(const Script& lead, const Script& question, Duration pause, std::size_t least) {
    constexpr int kTimes = 1'200;
    auto other = lead;
    for (int left = question.empty() ? 0 : kTimes; left > 0; --left) {
      other = appended(std::move(other), question, pause);
    }
    if (!try_instead(std::move(other))) return false;
    cut_end();
    leave_out_alike();
    while (leave_out()) {
    }
    return script_.size() < least;
  }

  /// What is sent there and, of a bus, what is read next.
  [[nodiscard]] static Script exchange_at(const Script& script, std::size_t place) {
    auto end = place + 1;
    while (end < script.size() && script[end].kind == LinkKind::kBus && !is_sent(script[end]))
      ++end;
    return {script.begin() + static_cast<std::ptrdiff_t>(place),
            script.begin() + static_cast<std::ptrdiff_t>(std::min(end, place + 2))};
  }

  enum class Pace : std::uint8_t { kKept, kAtOnce };

  /// Neighbours that go the same way in records of at most so many bytes.
  [[nodiscard]] Script with_merged(std::size_t most, Pace pace) const {
    Script merged;
    for (const auto& record : script_) {
      const bool goes_on = !merged.empty() && is_sent(record) && is_sent(merged.back()) &&
                           record.kind != LinkKind::kBus && record.kind == merged.back().kind &&
                           record.id == merged.back().id;
      if (goes_on && record.bytes.size() + merged.back().bytes.size() <= most) {
        auto& bytes = merged.back().bytes;
        bytes.insert(bytes.end(), record.bytes.begin(), record.bytes.end());
        continue;
      }
      const auto before = merged.empty() ? record.time : merged.back().time;
      merged.push_back(record);
      if (goes_on && pace == Pace::kAtOnce) merged.back().time = before;
    }
    return merged;
  }

  bool try_instead(Script other) {
    if (other == script_ || !may_go_on_() || !shows_(other)) return false;
    script_ = std::move(other);
    is_seen_last_ = true;
    return true;
  }

  /// In place of what shows it as well.
  void give_back(const Script& before) {
    is_seen_last_ = is_seen_last_ && script_ == before;
    script_ = before;
  }

  /// Of many records a few pieces are tried first: where each of them matters, as where something
  /// is counted, all of them would take long.
  [[nodiscard]] bool is_worth_it(std::size_t piece) {
    constexpr std::size_t kSamples = 12;
    if (script_.size() / piece < kMany) return true;
    const auto before = script_.size();
    for (std::size_t i = 0; i < kSamples && may_go_on_(); ++i) {
      const auto begin = script_.size() / kSamples * i;
      (void)try_without(begin, begin + piece);
      if (script_.size() < before) return true;
    }
    return false;
  }

  bool try_without(std::size_t begin, std::size_t end) {
    auto other = script_;
    other.erase(other.begin() + static_cast<std::ptrdiff_t>(begin),
                other.begin() + static_cast<std::ptrdiff_t>(end));
    return try_instead(std::move(other));
  }

  void leave_out(std::size_t piece) {
    if (!is_worth_it(piece)) return;
    // From the end, where what matters is, so that what leads there is tried as a whole. Of pairs
    // all, since what belongs together, as the end of a connection and the next one, may lie so.
    const auto step = piece == 2 ? 1 : piece;
    auto end = script_.size();
    while (end > 0 && may_go_on_()) {
      const auto begin = end > piece ? end - piece : 0;
      end -= std::min(end, try_without(begin, end) ? piece : step);
    }
  }

  /// `more` in its own pace, a little later.
  static Script appended(Script script, const Script& more, Duration pause = 1ms) {
    if (more.empty()) return script;
    const auto shift =
        (script.empty() ? Instant{} : script.back().time + pause) - more.front().time;
    for (auto record : more) {
      record.time += shift;
      script.push_back(std::move(record));
    }
    return script;
  }

  /// How many records from there on are one message together; 0: none are.
  [[nodiscard]] std::size_t pieces_at(const Script& script, std::size_t place) const {
    constexpr std::size_t kMostPieces = 128;
    const auto& first = script[place];
    if (first.kind == LinkKind::kBus) return 0;
    const auto dissector = make_dissector_();
    std::vector<Message> messages;
    std::size_t size = 0;
    for (auto i = place; i < std::min(script.size(), place + kMostPieces); ++i) {
      const auto& piece = script[i];
      if (!is_sent(piece) || piece.kind != first.kind || piece.id != first.id) return 0;
      size += piece.bytes.size();
      dissector->feed(Direction::kToDevice, piece.time, piece.bytes, messages);
      if (messages.empty()) continue;
      const bool is_one = messages.size() == 1 && messages.front().fault.empty() &&
                          messages.front().raw.size() == size;
      return is_one ? i - place + 1 : 0;
    }
    return 0;
  }

  static void join(Script& script, std::size_t place, std::size_t count) {
    const auto first = script.begin() + static_cast<std::ptrdiff_t>(place);
    const auto end = first + static_cast<std::ptrdiff_t>(count);
    first->time = (end - 1)->time;
    for (auto piece = first + 1; piece != end; ++piece) {
      first->bytes.insert(first->bytes.end(), piece->bytes.begin(), piece->bytes.end());
    }
    script.erase(first + 1, end);
  }

  [[nodiscard]] Script with_pauses(Duration longest) const {
    auto other = script_;
    Duration saved{};
    Instant last{};
    for (auto& record : other) {
      saved += std::max(Duration{}, record.time - last - longest);
      last = record.time;
      record.time -= saved;
    }
    return other;
  }

  [[nodiscard]] Script with_bytes(std::size_t place, std::vector<std::byte> bytes) const {
    auto other = script_;
    other[place].bytes = std::move(bytes);
    return other;
  }

  bool replace(std::size_t place, const Script& plain) {
    return std::ranges::any_of(plain, [&](const KeptRecord& one) {
      return is_sent(one) && one.kind == script_[place].kind && !one.bytes.empty() &&
             try_instead(with_bytes(place, one.bytes));
    });
  }

  void clear_fields(std::size_t place) {
    const auto dissector = make_dissector_();
    const auto messages = messages_in(script_[place], *dissector);
    if (messages.size() != 1) return;
    const auto head = messages.front().raw.size() - script_[place].bytes.size();
    if (head > 1) return;  // not one whole message
    for (const auto& field : messages.front().fields) {
      if (field.place != Place::kBytes || field.encoding == Encoding::kLiteral) continue;
      if (field.offset < head || !may_go_on_()) continue;
      auto bytes = script_[place].bytes;
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(field.offset - head);
      if (std::cmp_greater(field.offset - head + field.width, bytes.size())) continue;
      std::fill(begin, begin + field.width, std::byte{});
      (void)try_instead(with_bytes(place, std::move(bytes)));
    }
  }

  void shorten(std::size_t place) {
    constexpr std::size_t kMostSingly = 64;  // of longer ones halves only
    for (auto piece = script_[place].bytes.size() / 2; piece > 0 && may_go_on_(); piece /= 2) {
      if (piece < script_[place].bytes.size() / kMostSingly) return;
      for (auto end = script_[place].bytes.size(); end > 0 && may_go_on_();) {
        auto bytes = script_[place].bytes;
        end = std::min(end, bytes.size());
        const auto begin = end > piece ? end - piece : 0;
        if (begin == 0 && end == bytes.size()) break;  // leave_out has tried that
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                    bytes.begin() + static_cast<std::ptrdiff_t>(end));
        (void)try_instead(with_bytes(place, std::move(bytes)));
        end = begin;
      }
    }
  }

  Script script_;
  bool is_seen_last_ = true;  ///< of all that was looked at and showed it
  bool is_counted_ = false;   ///< it is mostly harmless exchanges, as many as it takes
  MakeDissector make_dissector_;
  const Shows& shows_;
  const std::function<bool()>& may_go_on_;
};

}  // namespace

Script shrink(Script script, const Script& plain, MakeDissector make_dissector, const Shows& shows,
              const std::function<bool()>& may_go_on) {
  Shrinking shrinking{std::move(script), make_dissector, shows, may_go_on};
  shrinking.cut_end();
  shrinking.cut_beginning();
  shrinking.hurry();
  shrinking.join();
  shrinking.count(plain);
  shrinking.leave_out_alike();
  if (shrinking.is_dense()) {
    constexpr std::size_t kMostPlacesIfLong = 3;
    shrinking.merge();
    (void)shrinking.look_often(plain, kMostPlacesIfLong);
  }
  while (shrinking.leave_out()) {
  }
  shrinking.leave_out_alike();
  shrinking.merge();
  shrinking.join();
  constexpr std::size_t kMostPlaces = 24;
  while (shrinking.look_often(plain, kMostPlaces)) {
  }
  shrinking.hurry();
  shrinking.simplify(plain);
  (void)shrinking.leave_out();
  shrinking.look_again();
  return shrinking.take();
}

}  // namespace armjig::campaign
