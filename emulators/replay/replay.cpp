// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/replay.hpp"

#include <fmt/core.h>

#include <map>

#include "harness/core/hex.hpp"

namespace armjig {

Outcome<std::optional<TraceDifference>> verify(const Trace& trace, const Replay& replay) {
  return replay.run(trace).map([&replay](const Replayed& replayed) {
    return replay.compare(replayed.recorded, replayed.actual);
  });
}

std::string write_event(std::string_view /*line*/, const TraceEvent& actual) {
  const auto id = actual.dir.starts_with("can_") ? fmt::format(R"("id":{},)", actual.id) : "";
  return fmt::format(R"({{"t_us":{},"dir":"{}",{}"hex":"{}"}})", microseconds(actual.time),
                     actual.dir, id, to_hex(actual.bytes));
}

Trace stimulus_of(Trace trace) {
  std::erase_if(trace.events, [](const TraceEvent& event) {
    if (event.dir == "from_device" || event.dir == "can_from_device") return true;
    // What ended by itself, as a server ends a connection.
    return event.dir == "disconnect" && event.json.find(R"("device-)") != std::string::npos;
  });
  return trace;
}

Outcome<std::string> record(const Trace& stimulus, const Replay& replay) {
  return replay.run(stimulus).map([&](const Replayed& replayed) {
    std::map<std::size_t, const TraceEvent*> answers;
    std::vector<const TraceEvent*> others;
    for (const auto& event : replayed.actual) {
      if (event.line == 0) {
        others.push_back(&event);
      } else {
        answers[event.line] = &event;
      }
    }
    const auto answered = [&](std::size_t number, const std::string& line) {
      const auto answer = answers.find(number);
      return (answer == answers.end() ? line : replay.write(line, *answer->second)) + '\n';
    };
    auto text = answered(1, stimulus.header);
    auto other = others.begin();
    const auto add_others_before = [&](Instant time) {
      // With a time since the last stimulus, it came before the one of the same moment.
      const auto came_before = [time](const TraceEvent& event) {
        return event.time < time || (event.time == time && event.value > 0);
      };
      for (; other != others.end() && came_before(**other); ++other) {
        text += replay.write("", **other) + '\n';
      }
    };
    for (const auto& event : stimulus.events) {
      add_others_before(event.time);
      text += answered(event.line, event.json);
    }
    add_others_before(Instant::max());
    return text;
  });
}

}  // namespace armjig
