// SPDX-License-Identifier: Apache-2.0
// Exercises with lines: what of a line may be longer than it has to be, and what is no line.
#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/campaign/exercises.hpp"
#include "harness/core/bytes.hpp"

namespace armjig::campaign {
namespace {

bool is_control(std::byte byte) { return std::to_integer<unsigned>(byte) < ' '; }

bool is_digit(std::byte byte) { return std::isdigit(std::to_integer<int>(byte)) != 0; }

std::byte in_case(std::byte byte, bool is_upper) {
  const auto letter = std::to_integer<int>(byte);
  return static_cast<std::byte>(is_upper ? std::toupper(letter) : std::tolower(letter));
}

/// How many bytes end it.
std::size_t size_of_end(const std::vector<std::byte>& line) {
  const auto last = std::find_if_not(line.rbegin(), line.rend(), is_control);
  return static_cast<std::size_t>(last - line.rbegin());
}

std::vector<std::byte> with_inserted(std::vector<std::byte> line, std::size_t place,
                                     const std::vector<std::byte>& bytes) {
  line.insert(line.begin() + static_cast<std::ptrdiff_t>(place), bytes.begin(), bytes.end());
  return line;
}

}  // namespace

Script Exercises::padded(const Setting& setting) const {
  constexpr std::size_t kMost = 132;
  Script body;
  if (material_.kind != LinkKind::kSession) return body;
  const auto& line = setting.exchange.front().bytes;
  const auto end = line.size() - size_of_end(line);
  const auto add_of_size = [&](std::size_t size) {
    if (size <= line.size()) return;
    const std::vector blanks(size - line.size(), std::byte{' '});
    add(body, sending(setting.exchange, with_inserted(line, end, blanks)));
  };
  for (std::size_t size = 1; size <= kMost; ++size) add_of_size(size);
  // With its end, and without. Whoever says too much may not be heard any more.
  auto client = setting.exchange.front().id;
  for (const auto edge : {256UL, 512UL, 1024UL, 2048UL}) {
    for (auto size = edge - 2; size <= edge + 3; ++size) {
      add_of_size(size);
      body.back().id = client;
      if (edge < 1024) continue;
      add(body, border("disconnect", client, "client-close"));
      add(body, border("connect", ++client, "ok"));
      add(body, to(client, setting.exchange));
    }
  }
  return body;
}

Script Exercises::misspelt(const Setting& setting) const {
  constexpr std::byte kOther{'X'};
  constexpr std::byte kCase{0x20};
  Script body;
  if (material_.kind != LinkKind::kSession) return body;
  std::set<std::string> tried;
  for (const auto& kind : repertoire_.kinds()) {
    const auto exchange = to(setting.exchange.front().id, kind.front().exchange);
    const auto& line = exchange.front().bytes;
    const auto end = line.size() - size_of_end(line);
    const auto try_it = [&](std::vector<std::byte> other) {
      if (tried.emplace(as_text(other)).second) add(body, sending(exchange, std::move(other)));
    };
    for (std::size_t i = 0; i < end && !is_digit(line[i]); ++i) {
      for (const auto odd : {kOther, line[i] ^ kCase}) {
        auto other = line;
        other[i] = odd;
        try_it(std::move(other));
      }
      auto shorter = line;
      shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(i));
      try_it(std::move(shorter));
    }
  }
  return body;
}

Script Exercises::in_one_segment(const Setting& setting) const {
  Script body;
  if (material_.kind != LinkKind::kSession) return body;
  const auto& line = setting.exchange.front().bytes;
  const auto end = line.size() - size_of_end(line);
  const std::vector<std::byte> text(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(end));
  std::vector<std::vector<std::byte>> forms{line};
  for (const std::string_view odd :
       {"\n", "\r", "\r\r\n", "\n\r", " \r\n", ":\r\n", "", "\0\r\n"}) {
    auto& form = forms.emplace_back(text);
    for (const auto letter : odd) form.push_back(static_cast<std::byte>(letter));
  }
  for (const bool is_upper : {false, true}) {
    auto& form = forms.emplace_back(line);
    for (auto& byte : form) byte = in_case(byte, is_upper);
  }
  forms.push_back(with_inserted(line, 0, {std::byte{' '}}));
  forms.emplace_back(line.begin() + static_cast<std::ptrdiff_t>(end), line.end());
  for (const auto& first : forms) {
    for (const auto& second : forms) {
      auto piece = first;
      for (const auto* const next : {&second, &line, &line}) {
        piece.insert(piece.end(), next->begin(), next->end());
      }
      add(body, sending(setting.exchange, std::move(piece)));
    }
  }
  return body;
}

Script Exercises::blanks(const Setting& setting) const {
  constexpr std::array kBlanks{std::byte{' '}, std::byte{'\t'}, std::byte{'\v'}, std::byte{'\f'}};
  constexpr std::byte kBetween{':'};
  Script body;
  if (material_.kind != LinkKind::kSession) return body;
  for (const auto& kind : repertoire_.kinds()) {
    const auto& line = kind.front().exchange.front().bytes;
    const auto end = line.size() - size_of_end(line);
    for (std::size_t place = 0; place <= end; ++place) {
      const bool is_border =
          place == 0 || place == end || line[place] == kBetween || line[place - 1] == kBetween;
      if (!is_border) continue;
      for (const auto blank : kBlanks) {
        add(body, sending(setting.exchange.front(), with_inserted(line, place, {blank})));
      }
    }
  }
  return body;
}

Script Exercises::cut_across(const Setting& setting) const {
  Script body;
  if (material_.kind != LinkKind::kSession) return body;
  const auto& line = setting.exchange.front().bytes;
  const auto twice = with_inserted(line, line.size(), line);
  for (std::size_t size = 1; size < twice.size(); ++size) {
    const auto border = twice.begin() + static_cast<std::ptrdiff_t>(size);
    add(body, sending(setting.exchange.front(), {twice.begin(), border}));
    add(body, sending(setting.exchange.front(), {border, twice.end()}));
  }
  constexpr std::ptrdiff_t kLongestPiece = 5;
  for (std::ptrdiff_t size = 1; size <= kLongestPiece; ++size) {
    for (auto begin = twice.begin(); begin != twice.end();) {
      const auto end = begin + std::min(size, twice.end() - begin);
      add(body, sending(setting.exchange.front(), {begin, end}));
      begin = end;
    }
  }
  return body;
}

Script Exercises::half_lines(const Setting& setting) const {
  Script body;
  const auto& one = setting.exchange.front();
  if (material_.kind != LinkKind::kSession || one.bytes.size() < 4) return body;
  auto client = one.id;
  const auto say = [&](std::vector<std::byte> bytes) {
    auto record = sending(one, std::move(bytes));
    record.id = client;
    add(body, std::move(record));
  };
  for (const auto size : {std::size_t{2}, one.bytes.size() / 2, one.bytes.size() - 2}) {
    for (const auto first : {size, size / 2}) {
      say(cut(one.bytes, first));
      if (first < size) {
        const auto begin = one.bytes.begin();
        say({begin + static_cast<std::ptrdiff_t>(first),
             begin + static_cast<std::ptrdiff_t>(size)});
      }
      add(body, border("disconnect", client, "client-close"));
      add(body, border("connect", ++client, "ok"));
      say(one.bytes);
      say(one.bytes);
    }
  }
  return body;
}

Script Exercises::odd_ends(const Setting& setting) const {
  Script body;
  if (material_.kind != LinkKind::kSession) return body;
  const auto& line = setting.exchange.front().bytes;
  const auto end = line.size() - size_of_end(line);
  for (const auto one : kOddBytes) {
    for (const auto two : kOddBytes) {
      const std::vector odd{static_cast<std::byte>(one), static_cast<std::byte>(two)};
      add(body, sending(setting.exchange, with_inserted(line, end, odd)));
    }
  }
  return body;
}

Script Exercises::after_runs(const Setting& setting) const {
  constexpr std::size_t kTimes = 20;
  Script body;
  if (material_.kind != LinkKind::kSession) return body;
  const auto& line = setting.exchange.front().bytes;
  const std::vector end(line.end() - static_cast<std::ptrdiff_t>(size_of_end(line)), line.end());
  std::vector<std::byte> ends;
  for (std::size_t i = 0; i < kTimes; ++i) {
    ends.insert(ends.end(), end.begin(), end.end());
    add(body, sending(setting.exchange, ends));
    add(body, setting.exchange);
    add(body, sending(setting.exchange, with_inserted(line, 0, ends)));
  }
  for (const auto odd : kOddBytes) {
    const std::vector run(kTimes, static_cast<std::byte>(odd));
    add(body, sending(setting.exchange, with_inserted(line, 0, run)));
    add(body, setting.exchange);
  }
  return body;
}

}  // namespace armjig::campaign
