// SPDX-License-Identifier: Apache-2.0
// Defects that no suite asks for, each in a corner that somebody has to come to by chance.
#include <algorithm>
#include <utility>
#include <vector>

#include "emulators/kinovazed/defects/quirks.hpp"
#include "harness/wire/kinovazed/line.hpp"

namespace armjig::kinovazed::emulation {
namespace {

using namespace std::chrono_literals;

void take_for(std::string& segment, std::string_view what, std::string_view with) {
  const auto place = segment.find(what);
  if (place != std::string::npos) segment.replace(place, what.size(), with);
}

Quirk mishears(std::string name, std::string what, std::string with) {
  return {
      .name = std::move(name),
      .section = "Lines",
      .hear = [what = std::move(what), with = std::move(with)](
                  std::string& segment, QuirkMemory&, State) { take_for(segment, what, with); }};
}

std::vector<Quirk> make_rare() {
  std::vector<Quirk> all;
  all.push_back({.name = "hangs-after-60-rejections",
                 .section = "Robustness",
                 .say = [](Saying& saying, QuirkMemory& memory, State) {
                   if (memory.number >= 60) saying.text.clear();
                   memory.number = saying.text == "Accepted\r\n"   ? 0
                                   : saying.text == "Rejected\r\n" ? memory.number + 1
                                                                   : memory.number;
                 }});
  all.push_back({.name = "beats-wrong-after-rejections",
                 .section = "Heartbeats",
                 .say = [](Saying& saying, QuirkMemory& memory, State) {
                   if (saying.text == "Rejected\r\n") ++memory.number;
                   if (!saying.text.starts_with(kHeartbeatName)) return;
                   if (memory.number >= 70) saying.text.insert(kHeartbeatName.size() + 1, "0");
                   memory.number = 0;
                 }});
  all.push_back({.name = "loses-byte-64",
                 .section = "Lines",
                 .hear = [](std::string& segment, QuirkMemory&, State) {
                   if (segment.size() == 64) segment.pop_back();
                 }});
  all.push_back({.name = "forgets-third-client",
                 .section = "Connections",
                 .say =
                     [](Saying& saying, QuirkMemory& memory, State) {
                       if (memory.number != 3 || saying.text != "Accepted\r\n") return;
                       saying.text.clear();
                       memory.number = 0;
                     },
                 .leave = [](std::string&, QuirkMemory& memory) { ++memory.number; }});
  all.push_back(mishears("turns-128", "MoveJoystick:128:", "MoveJoystick:-129:"));
  all.push_back(mishears("swallows-unfreezing", "Freeze\r\nUnfreeze\r\n", "Freeze\r\n"));
  all.push_back(mishears("swallows-second-stop", "EStop\r\nEStop\r\n", "EStop\r\n"));
  all.push_back(
      {.name = "drops-vertical-tabs",
       .section = "Lines",
       .hear = [](std::string& segment, QuirkMemory&, State) { std::erase(segment, '\v'); }});
  all.push_back(mishears("swallows-quitting", "EStop\r\nQuitEStop\r\n", "EStop\r\n"));
  all.push_back({.name = "slows-with-bytes",
                 .section = "Robustness",
                 .hear = [](std::string& segment, QuirkMemory& memory,
                            State) { memory.number += std::ssize(segment); },
                 .say =
                     [](Saying& saying, QuirkMemory& memory, State) {
                       if (memory.number > 100'000) saying.delay += 5ms;
                     }});
  return all;
}

}  // namespace

std::span<const Quirk> rare_quirks() {
  static const auto kAll = make_rare();
  return kAll;
}

}  // namespace armjig::kinovazed::emulation
