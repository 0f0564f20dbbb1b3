// SPDX-License-Identifier: Apache-2.0
#include "cli/device_inputs.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <utility>

#include "harness/core/number.hpp"

namespace armjig::cli {
namespace {

constexpr int kGlanceMs = 100;  ///< at whether it is time to end
constexpr std::size_t kLongestInput = 4096;

/// Reading a terminal from the background would stop the whole program.
bool is_ours() noexcept {
  return ::isatty(STDIN_FILENO) == 0 || ::tcgetpgrp(STDIN_FILENO) == ::getpgrp();
}

/// The next word, and what stands behind it.
std::string_view next_word(std::string_view& line) noexcept {
  constexpr std::string_view kBlanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const auto word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

void tell_line(std::string_view text) { fmt::print(stderr, "armjig: {}\n", text); }

}  // namespace

bool has_standard_input() noexcept { return ::fcntl(STDIN_FILENO, F_GETFD) != -1; }

DeviceInputs::DeviceInputs(std::span<const DeviceInput> inputs, Set set)
    : inputs_{inputs},
      set_{std::move(set)},
      thread_{[this](const std::stop_token& stop) { read(stop); }} {}

void DeviceInputs::read(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    pollfd ready{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    const bool is_mine = is_ours();
    const auto found = ::poll(is_mine ? &ready : nullptr, is_mine ? 1 : 0, kGlanceMs);
    if (found == 0 || (found < 0 && errno == EINTR) || !is_ours()) continue;
    std::array<char, 4096> buffer;
    const auto size = found < 0 ? -1 : ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (size <= 0) return;
    text_.append(buffer.data(), static_cast<std::size_t>(size));
    for (auto end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
      obey(std::string_view{text_}.substr(0, end));
      text_.erase(0, end + 1);
    }
    if (text_.size() > kLongestInput)
      return tell_line("standard input has no lines; it is left alone");
  }
}

void DeviceInputs::obey(std::string_view line) {
  const auto name = next_word(line);
  const auto said = next_word(line);
  if (name.empty() || name.starts_with('#')) return;
  if (name == "help") {
    for (const auto& input : inputs_) tell_line(fmt::format("{:<21} {}", input.name, input.values));
    return;
  }
  const auto value = whole_text_as<std::int64_t>(said);
  if (!value || !next_word(line).empty()) {
    return tell_line(fmt::format("'{}': write NAME NUMBER; 'help' lists the names", name));
  }
  set_(std::string{name}, *value, [name = std::string{name}, value](bool is_taken) {
    tell_line(is_taken ? fmt::format("{} is {}", name, *value)
                       : fmt::format("there is no input '{}' here that takes {}; 'help' lists them",
                                     name, *value));
  });
}

}  // namespace armjig::cli
