// SPDX-License-Identifier: Apache-2.0
#include "harness/console/device_console.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace armjig {
namespace {

using namespace std::chrono_literals;

/// The pieces between any of `separators`, empty ones left out.
std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const auto end = text.find_first_of(separators);
    if (end != 0) words.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return words;
}

bool may_take(std::string_view arguments, std::size_t count) {
  if (arguments.find(" | ") != std::string_view::npos) return true;
  const auto all = split(arguments, " ");
  const bool is_open = !all.empty() && all.back() == "...";
  const auto optional =
      std::ranges::count_if(all, [](auto word) { return word == "..." || word.starts_with('['); });
  return count >= all.size() - static_cast<std::size_t>(optional) &&
         (is_open || count <= all.size());
}

std::string call_of(const DeviceConsole::Row& row) {
  return row.arguments.empty() ? std::string{row.name}
                               : fmt::format("{} {}", row.name, row.arguments);
}

/// `jog jN SPEED      run a joint`.
std::string help_line(const DeviceConsole::Row& row) {
  constexpr std::size_t kColumn = 26;
  const auto call = call_of(row);
  if (call.size() < kColumn) return fmt::format("{:<{}}{}", call, kColumn, row.help);
  return fmt::format("{}\n{:>{}}{}", call, "", kColumn, row.help);
}

}  // namespace

DeviceConsole::DeviceConsole(std::span<const Row> own, std::string target, Say say, Silence silence)
    : target_{std::move(target)}, say_{std::move(say)}, silence_{silence} {
  using Self = DeviceConsole;
  rows_ = {{"help", "[COMMAND]", "what there is", kAlways, run<&Self::help>, ""},
           {"status", "", "what the device says of itself", kAlways, run<&Self::status>, ""}};
  rows_.insert(rows_.end(), own.begin(), own.end());
  rows_.insert(
      rows_.end(),
      {{"stop", "", "make the device stand, whatever it does", kAlways, run<&Self::stop>, ""},
       {"wait", "SECONDS", "do nothing for a time", kAlone, run<&Self::wait>, ""},
       {"quit", "", "make it stand and leave; so does exit", kAlways, run<&Self::quit>, ""}});
}

Outcome<bool> DeviceConsole::find_device() {
  const auto deadline = now() + silence_.patience;
  while (!hears_the_device() && now() < deadline) {
    if (const auto cycled = cycle(); !cycled) return tl::unexpected{cycled.error()};
  }
  return hears_the_device();
}

Outcome<void> DeviceConsole::cycle() {
  auto exchanged = exchange();
  if (waits_until_ && now() >= *waits_until_) end();
  return exchanged;
}

void DeviceConsole::begin(std::string_view line) {
  const auto words = split(line.substr(0, line.find('#')), " \t\r");
  if (words.empty()) return;
  const auto* const row = find(words.front());
  if (row == nullptr) {
    return say(Tone::kUnreadable,
               fmt::format("there is no command '{}'; 'help' lists them", words.front()));
  }
  if (row->when == When::kAlone && is_busy()) {
    return say(Tone::kFailed, fmt::format("{} is still going on; 'stop' ends it", going_on_));
  }
  const auto arguments = Words{words}.subspan(1);
  const auto read =
      may_take(row->arguments, arguments.size()) ? row->run(*this, arguments) : Read{wrong("")};
  if (read) return;
  const auto reason = read.error().empty() ? "" : read.error() + "; ";
  say(Tone::kUnreadable, fmt::format("{}usage: {}", reason, call_of(*row)));
}

void DeviceConsole::stop() {
  end_early();
  stand();
}

Outcome<void> DeviceConsole::leave() {
  stop();
  const auto deadline = now() + 2s;
  while (is_busy() && now() < deadline) {
    if (auto cycled = cycle(); !cycled) return cycled;
  }
  return {};
}

std::vector<std::string> DeviceConsole::candidates(std::string_view line) const {
  const bool is_new_word = line.empty() || line.ends_with(' ');
  const auto words = split(line, " \t");
  const auto place = words.size() - (is_new_word ? 0 : 1);
  std::vector<std::string> found;
  if (place == 0 || (place == 1 && words.front() == "help")) {
    for (const auto& row : rows_) found.emplace_back(row.name);
    return found;
  }
  const auto* const row = find(words.front());
  if (row == nullptr) return found;
  const auto places = split(row->completions, "|");
  if (place > places.size()) return found;
  for (const auto word : split(places[place - 1], " ")) found.emplace_back(word);
  return found;
}

void DeviceConsole::go_on(std::string_view name) {
  const std::string next{name};  // it may be that of what ends here
  end_early();
  going_on_ = next;
  began_ = now();
}

void DeviceConsole::end() noexcept {
  going_on_.clear();
  waits_until_.reset();
}

/// Another command takes its place.
void DeviceConsole::end_early() {
  if (is_busy()) say(Tone::kEvent, going_on_ + " is ended");
  end();
}

std::string DeviceConsole::going_on() {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(now() - began_).count();
  return is_busy() && seconds > 0 ? fmt::format("{} {} s", going_on_, seconds) : going_on_;
}

void DeviceConsole::wait_for(Duration time) {
  go_on("wait");
  waits_until_ = now() + time;
}

// The commands that all devices have.

DeviceConsole::Read DeviceConsole::help(Words words) {
  std::string text;
  for (const auto& row : rows_) {
    if (!words.empty() && row.name != words.front()) continue;
    text += (text.empty() ? "" : "\n") + help_line(row);
  }
  if (text.empty()) return wrong(fmt::format("there is no command '{}'", words.front()));
  say(Tone::kAnswer, text);
  return {};
}

void DeviceConsole::status() {
  const auto told = state();
  say(told ? Tone::kAnswer : Tone::kFailed, told ? *told : told.error());
}

DeviceConsole::Read DeviceConsole::wait(Words words) {
  return parse_seconds(words[0]).map([this](Duration time) { wait_for(time); });
}

const DeviceConsole::Row* DeviceConsole::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(rows_, name == "exit" ? "quit" : name, &Row::name);
  return found == rows_.end() ? nullptr : &*found;
}

}  // namespace armjig
