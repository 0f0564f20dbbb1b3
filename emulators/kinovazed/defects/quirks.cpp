// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/defects/quirks.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace armjig::kinovazed::emulation {
namespace {

using namespace std::chrono_literals;

bool is_beat(const Saying& saying) { return saying.text.starts_with(kHeartbeatName); }

// In a template the check does not see that they are moved.
// NOLINTBEGIN(performance-unnecessary-value-param)
/// A wrong voice: `change` gets every message.
template <class Change>
Quirk voice(std::string name, std::string section, Change change) {
  return {.name = std::move(name), .section = std::move(section), .say = change};
}

/// Wrong ears: `change` gets every segment.
template <class Change>
Quirk ears(std::string name, std::string section, Change change) {
  return {.name = std::move(name),
          .section = std::move(section),
          .hear = [change](std::string& segment, QuirkMemory&, State) { change(segment); }};
}
// NOLINTEND(performance-unnecessary-value-param)

void replace_all(std::string& text, std::string_view what, std::string_view with) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
}

/// Wrong ears that take `what` for `with` wherever it stands.
Quirk mistake(std::string name, std::string section, std::string what, std::string with) {
  return ears(std::move(name), std::move(section),
              [what = std::move(what), with = std::move(with)](std::string& segment) {
                replace_all(segment, what, with);
              });
}

/// Calls `change` with each line that is whole, without its LF.
template <class Change>
void each_line(std::string& segment, Change change) {
  std::string changed;
  std::size_t begin = 0;
  for (auto end = segment.find('\n'); end != std::string::npos; end = segment.find('\n', begin)) {
    auto line = segment.substr(begin, end - begin);
    change(line);
    changed += line + "\n";
    begin = end + 1;
  }
  segment = changed + segment.substr(begin);
}

void add_voices(std::vector<Quirk>& all) {
  all.push_back(voice("beats-stuck", "Heartbeats", [](Saying& saying, QuirkMemory& memory, State) {
    if (!is_beat(saying)) return;
    if (memory.text.empty()) memory.text = saying.text;
    saying.text = memory.text;
  }));
  all.push_back(voice("beats-stale", "Heartbeats", [](Saying& saying, QuirkMemory& memory, State) {
    if (!is_beat(saying)) return;
    if (memory.text.empty()) memory.text = saying.text;
    std::swap(saying.text, memory.text);
  }));
  all.push_back(voice("beats-padded", "Heartbeats", [](Saying& saying, QuirkMemory&, State) {
    if (is_beat(saying)) saying.text.insert(kHeartbeatName.size() + 1, "0");
  }));
  all.push_back(voice("beats-signed", "Heartbeats", [](Saying& saying, QuirkMemory&, State) {
    if (is_beat(saying)) saying.text.insert(kHeartbeatName.size() + 1, "+");
  }));
  all.push_back(voice("beats-twice", "Heartbeats", [](Saying& saying, QuirkMemory&, State) {
    if (is_beat(saying)) saying.text += std::string{saying.text};
  }));
  all.push_back(voice("beats-one-in-three-missing", "Heartbeats",
                      [](Saying& saying, QuirkMemory& memory, State) {
                        if (is_beat(saying) && ++memory.number % 3 == 0) saying.text.clear();
                      }));
  all.push_back(voice("no-beats", "Heartbeats", [](Saying& saying, QuirkMemory&, State) {
    if (is_beat(saying)) saying.text.clear();
  }));
  all.push_back(
      voice("beats-stop-in-motion", "Heartbeats", [](Saying& saying, QuirkMemory&, State state) {
        if (is_beat(saying) && state == State::kRunningSequence) saying.text.clear();
      }));
  all.push_back(voice("no-cr", "Lines", [](Saying& saying, QuirkMemory&, State) {
    replace_all(saying.text, "\r", "");
  }));
  all.push_back(voice("blank-lines", "Lines",
                      [](Saying& saying, QuirkMemory&, State) { saying.text += "\r\n"; }));
  all.push_back(voice("explains", "Replies and events", [](Saying& saying, QuirkMemory&, State) {
    if (saying.text == "Rejected\r\n") saying.text += "Error:1\r\n";
  }));
  all.push_back(voice("agrees", "Replies and events", [](Saying& saying, QuirkMemory&, State) {
    if (saying.text == "Rejected\r\n") saying.text = "Accepted\r\n";
  }));
  all.push_back(voice("freezed-first", "Replies and events",
                      [](Saying& saying, QuirkMemory& memory, State state) {
                        if (state == State::kFrozen && saying.text == "Accepted\r\n") {
                          memory.text.swap(saying.text);
                        } else if (saying.text == "Freezed\r\n") {
                          saying.text += memory.text;
                          memory.text.clear();
                        }
                      }));
  all.push_back(
      voice("beat-before-freezed", "Replies and events", [](Saying& saying, QuirkMemory&, State) {
        if (saying.text == "Freezed\r\n") saying.text.insert(0, "Heartbeat:13\r\n");
      }));
  all.push_back(
      voice("beat-before-unfreezed", "Replies and events", [](Saying& saying, QuirkMemory&, State) {
        if (saying.text == "Unfreezed\r\n") {
          saying.text.insert(0, "Heartbeat:21\r\n");
        }
      }));
  all.push_back(voice(
      "tells-of-stops", "Replies and events", [](Saying& saying, QuirkMemory& memory, State state) {
        const bool is_new =
            std::exchange(memory.number,
                          is_beat(saying) && state == State::kEmergencyStopped ? 1 : 0) == 0;
        if (is_new && memory.number == 1) saying.text += "Retracted\r\n";
      }));
  all.push_back(voice("tires", "Robustness", [](Saying& saying, QuirkMemory& memory, State) {
    if (!is_beat(saying) && ++memory.number > 120) saying.text.clear();
  }));
  all.push_back(voice("slow", "Times", [](Saying& saying, QuirkMemory&, State) {
    if (!is_beat(saying)) saying.delay += 600ms;
  }));
}

void add_ears(std::vector<Quirk>& all) {
  all.push_back(ears("loses-splits", "Lines", [](std::string& segment) {
    if (!segment.ends_with('\n')) segment.clear();
  }));
  all.push_back(ears("one-line-a-segment", "Lines", [](std::string& segment) {
    segment.resize(std::min(segment.find('\n'), segment.size() - 1) + 1);
  }));
  all.push_back(ears("small-segments", "Robustness", [](std::string& segment) {
    segment.resize(std::min<std::size_t>(segment.size(), 512));
  }));
  all.push_back(ears("needs-cr", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (!line.ends_with('\r')) line += "?";
    });
  }));
  all.push_back(ears("needs-no-cr", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (line.ends_with('\r')) line += "?";
    });
  }));
  all.push_back(ears("hates-two-cr", "Lines",
                     [](std::string& segment) { replace_all(segment, "\r\r", "?"); }));
  all.push_back(mistake("cr-ends-lines", "Lines", "\r", "\n"));
  all.push_back(mistake("semicolon-ends-lines", "Lines", ";", "\n"));
  all.push_back(ears("any-case", "Lines", [](std::string& segment) {
    for (const auto* word : {"estop", "ESTOP", "eStop", "Estop"}) {
      replace_all(segment, word, "EStop");
    }
    replace_all(segment, "xyz", "XYZ");
    replace_all(segment, ":home", ":Home");
  }));
  all.push_back(mistake("trims-arguments", "Lines", ": ", ":"));
  all.push_back(ears("hates-blanks", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (line.find_first_of(" \t") != std::string::npos) line = "?";
    });
  }));
  all.push_back(ears("hates-blanks-in-front", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (line.starts_with(' ') || line.starts_with('\t')) line = "?";
    });
  }));
  all.push_back(mistake("drops-double-colons", "Lines", "::", ":"));
  all.push_back(ears("drops-colons-in-front", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) { line.erase(0, line.find_first_not_of(':')); });
  }));
  all.push_back(ears("hates-colons-at-end", "Lines",
                     [](std::string& segment) { replace_all(segment, ":\r\n", "::\r\n"); }));
  all.push_back(ears("ignores-surplus-arguments", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      for (const auto* word : {"EStop:", "QuitEStop:"}) {
        if (line.starts_with(word)) line = std::string{word, std::string_view{word}.size() - 1};
      }
    });
  }));
  all.push_back(ears("makes-up-arguments", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (line == "MoveJoystick:1:2\r") line = "MoveJoystick:1:2:0\r";
      if (line == "SetJoystickMode\r") line = "SetJoystickMode:XYZ\r";
    });
  }));
  all.push_back(
      ears("drops-nul", "Lines", [](std::string& segment) { std::erase(segment, '\0'); }));
  all.push_back(ears("drops-controls", "Lines", [](std::string& segment) {
    std::erase_if(segment, [](char c) { return c == '\b' || c == '\x7F' || c == '\x01'; });
  }));
  all.push_back(ears("drops-non-ascii", "Lines", [](std::string& segment) {
    std::erase_if(segment, [](char c) { return static_cast<unsigned char>(c) > 0x7F; });
  }));
  all.push_back(ears("knows-its-own-words", "Lines", [](std::string& segment) {
    for (const auto* word : {"Accepted", "Heartbeat:3"}) replace_all(segment, word, "EStop");
  }));
  all.push_back(ears("reads-beginnings", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (line.starts_with("EStop")) line = "EStop\r";
    });
  }));
  all.push_back(
      mistake("knows-numbers-of-modes", "Lines", "SetJoystickMode:1\r", "SetJoystickMode:XYZ\r"));
  all.push_back(
      mistake("knows-numbers-of-objectives", "Lines", "RunObjective:1\r", "RunObjective:Home\r"));
  all.push_back(mistake("hates-plus", "Lines", ":+", ":?"));
  all.push_back(mistake("hates-padding", "Lines", ":00", ":?"));
  all.push_back(mistake("hates-minus", "Lines", ":-", ":?"));
  all.push_back(mistake("hates-blanks-at-numbers", "Lines", ": ", ":?"));
  all.push_back(ears("hates-tails", "Lines", [](std::string& segment) {
    for (const auto* tail : {"1.9", "1e3", "0x10", "1x"}) replace_all(segment, tail, "?");
  }));
  all.push_back(mistake("hates-largest", "Lines", "2147483647", "?"));
  all.push_back(mistake("hates-smallest", "Lines", "-2147483648", "?"));
  all.push_back(mistake("takes-too-large", "Lines", ":2147483648", ":1"));
  all.push_back(mistake("takes-too-small", "Lines", "-2147483649", "1"));
  all.push_back(mistake("takes-empty-for-zero", "Lines", "MoveJoystick::", "MoveJoystick:0:"));
  all.push_back(mistake("takes-letters-for-zero", "Lines", ":a:b:c", ":0:0:0"));
  all.push_back(mistake("takes-signs-for-zero", "Lines", ":-:", ":0:"));
  all.push_back(ears("short-lines", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (line.size() > 256) line = "?";
    });
  }));
  all.push_back(ears("lines-of-1023", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (line.size() > 1023) line = "?";
    });
  }));
  all.push_back(ears("endless-lines", "Lines", [](std::string& segment) {
    if (segment.size() > 900 && segment.find('\n') == std::string::npos) segment.clear();
  }));
  all.push_back(ears("spares-long-lines", "Lines", [](std::string& segment) {
    each_line(segment, [](std::string& line) {
      if (line.size() > 1151) line = "?";
    });
  }));
  all.push_back(ears("lf-harmless", "Lines", [](std::string& segment) {
    while (segment.starts_with('\n')) segment.erase(0, 1);
    replace_all(segment, "\n\n", "\n");
  }));
  all.push_back(ears("lf-takes-next-always", "Lines", [](std::string& segment) {
    if (segment.starts_with("\r\n") && segment.size() > 3) segment.erase(0, 3);
  }));
  all.push_back(ears("answers-empty-lines", "Lines", [](std::string& segment) {
    if (segment == "\r\n") segment = "MoveJoystick:0:0:0\r\n";
  }));
  Quirk hungry{.name = "lf-takes-next-segment", .section = "Lines"};
  hungry.hear = [](std::string& segment, QuirkMemory& memory, State) {
    if (std::exchange(memory.number, segment == "\n" ? 1 : 0) == 1) segment.erase(0, 1);
  };
  all.push_back(std::move(hungry));
  all.push_back(ears("console-commands-act", "Commands", [](std::string& segment) {
    replace_all(segment, "GetAbsolutePosition\r\n", "MoveJoystick:0:0:0\r\n");
  }));
  all.push_back(ears("console-commands-stop", "Commands", [](std::string& segment) {
    replace_all(segment, "GetObjectivePosition\r\n", "EStop\r\n");
  }));
  all.push_back(
      mistake("console-commands-run", "Commands", "SetActiveObjective:", "RunObjective:"));
  all.push_back(mistake("every-mode-is-no-mode", "Joystick", ":Axis4to6", ":NoMode"));
  all.push_back(mistake("no-mode-is-xyz", "Joystick", ":NoMode", ":XYZ"));
  all.push_back(mistake("every-objective-is-current", "Objectives", "RunObjective:Suck",
                        "RunObjective:Current\r\n"));
}

void add_manners(std::vector<Quirk>& all) {
  const auto greets = [](std::string name, std::string text, std::size_t from) {
    return Quirk{.name = std::move(name),
                 .section = "Connections",
                 .come = [text = std::move(text), from](std::string& greeting, QuirkMemory&,
                                                        std::size_t clients) {
                   if (clients >= from) greeting = text;
                 }};
  };
  Quirk reserved{.name = "serves-three-clients", .section = "Connections"};
  reserved.come = [](std::string&, QuirkMemory& memory, std::size_t) { ++memory.number; };
  reserved.say = [](Saying& saying, QuirkMemory& memory, State) {
    if (memory.number > 3) saying.text.clear();
  };
  all.push_back(std::move(reserved));
  Quirk first_only{.name = "serves-the-first-client-only", .section = "Connections"};
  first_only.leave = [](std::string&, QuirkMemory& memory) { memory.number = 1; };
  first_only.say = [](Saying& saying, QuirkMemory& memory, State) {
    if (memory.number != 0) saying.text.clear();
  };
  all.push_back(std::move(first_only));
  all.push_back(greets("greets", "Accepted\r\n", 1));
  all.push_back(greets("beats-at-once", "Heartbeat:3\r\n", 1));
  all.push_back(greets("tells-that-it-is-busy", "Rejected\r\n", 2));
  const auto hears = [](std::string name, std::string text) {
    return Quirk{.name = std::move(name),
                 .section = "Connections",
                 .leave = [text = std::move(text)](std::string& last_words, QuirkMemory&) {
                   last_words = text;
                 }};
  };
  all.push_back(hears("stops-without-client", "\r\nEStop\r\n"));
  all.push_back(hears("serves-unfinished-lines", "\r\n"));
  Quirk keeps{.name = "keeps-unfinished-lines", .section = "Connections"};
  keeps.hear = [](std::string& segment, QuirkMemory& memory, State) {
    if (memory.number != 0) segment.insert(0, memory.text);
    memory.number = 0;
    memory.text = segment.substr(std::min(segment.size(), segment.rfind('\n') + 1));
  };
  keeps.leave = [](std::string&, QuirkMemory& memory) { memory.number = 1; };
  all.push_back(std::move(keeps));
}

std::vector<Quirk> make_quirks() {
  std::vector<Quirk> all;
  add_voices(all);
  add_ears(all);
  add_manners(all);
  return all;
}

}  // namespace

std::span<const Quirk> quirks() {
  static const auto kAll = make_quirks();
  return kAll;
}

}  // namespace armjig::kinovazed::emulation
