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

  /// Without what does not matter: large pieces first. False: nothing could be left out.
  bool leave_out() {
    const auto before = script_.size();
    for (auto piece = std::max<std::size_t>(script_.size() / 2, 1);; piece /= 2) {
      leave_out(piece);
      if (piece <= 1 || !may_go_on_()) return script_.size() < before;
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
  bool try_instead(Script other) {
    if (other == script_ || !may_go_on_() || !shows_(other)) return false;
    script_ = std::move(other);
    return true;
  }

  void leave_out(std::size_t piece) {
    // From the end, where what matters is, so that what leads there is tried as a whole.
    auto end = script_.size();
    while (end > 0 && may_go_on_()) {
      const auto begin = end > piece ? end - piece : 0;
      auto other = script_;
      other.erase(other.begin() + static_cast<std::ptrdiff_t>(begin),
                  other.begin() + static_cast<std::ptrdiff_t>(end));
      (void)try_instead(std::move(other));
      end = begin;
    }
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
  MakeDissector make_dissector_;
  const Shows& shows_;
  const std::function<bool()>& may_go_on_;
};

}  // namespace

Script shrink(Script script, const Script& plain, MakeDissector make_dissector, const Shows& shows,
              const std::function<bool()>& may_go_on) {
  Shrinking shrinking{std::move(script), make_dissector, shows, may_go_on};
  shrinking.hurry();
  while (shrinking.leave_out()) {
  }
  shrinking.hurry();
  shrinking.simplify(plain);
  (void)shrinking.leave_out();
  return shrinking.take();
}

}  // namespace armjig::campaign
