// SPDX-License-Identifier: Apache-2.0
#include "machine.hpp"

#include <array>
#include <chrono>
#include <string>

#include "rtu.hpp"

namespace gripper {

using namespace armjig;
using namespace std::chrono_literals;
using campaign::AbstractLetter;
using campaign::Acts;
using mealy::Row;

namespace {

/// For a request, its answer, and the silence after it, at 19,200 baud.
constexpr Duration kExchange = 30ms;
/// Slow enough that the jaws are under way for many letters, and the time for the whole way.
constexpr unsigned kSlow = 50;
constexpr Duration kQuiet = 25s;
constexpr unsigned kObject = 400;

void write(Acts& acts, Register place, unsigned value) {
  acts.send(write_request(kUnit, place, value));
  acts.wait(kExchange);
}
void ask(Acts& acts) {
  acts.send(read_request(kUnit, kStatus, 1));
  acts.wait(kExchange);
}

void begin(Acts& acts) { write(acts, kSpeed, kSlow); }
void close(Acts& acts) {
  write(acts, kTarget, 0);
  write(acts, kControl, 1);
  ask(acts);
}
void stop(Acts& acts) {
  write(acts, kControl, 0);
  ask(acts);
}
template <unsigned width>
void put(Acts& acts) {
  acts.set("object", width);
  ask(acts);
}
void wait(Acts& acts) {
  acts.wait_until_quiet();
  ask(acts);
}

constexpr std::array kLetters{AbstractLetter{"close", close}, AbstractLetter{"stop", stop},
                              AbstractLetter{"put object", put<kObject>},
                              AbstractLetter{"take object", put<0>}, AbstractLetter{"quiet", wait}};

/// The status, out of the answer to a read of one register.
std::string said(std::span<const Message> messages) {
  constexpr std::size_t kAnswer = 7;
  constexpr std::size_t kLowByte = 4;
  constexpr std::array kNames{"stopped", "moving", "arrived", "holding"};
  std::string text;
  for (const auto& message : messages) {
    if (message.raw.size() != kAnswer) continue;
    const auto status = std::to_integer<std::size_t>(message.raw[kLowByte]);
    text = status < kNames.size() ? kNames[status] : "unknown";
  }
  return text;
}

/// What is between the jaws counts when they begin to close.
constexpr std::array kRows{
    Row{"open", "close", "moving", "closing"},
    Row{"open", "put object", "stopped", "open, object"},
    Row{"open", "", "stopped", ""},
    Row{"open, object", "close", "moving", "gripping"},
    Row{"open, object", "take object", "stopped", "open"},
    Row{"open, object", "", "stopped", ""},
    Row{"closing", "stop", "stopped", "open"},
    Row{"closing", "put object", "moving", "closing, object"},
    Row{"closing", "quiet", "arrived", "closed"},
    Row{"closing", "", "moving", ""},
    Row{"closing, object", "close", "moving", "gripping"},
    Row{"closing, object", "stop", "stopped", "open, object"},
    Row{"closing, object", "take object", "moving", "closing"},
    Row{"closing, object", "quiet", "arrived", "closed"},
    Row{"closing, object", "", "moving", ""},
    Row{"gripping", "stop", "stopped", "open, object"},
    Row{"gripping", "take object", "moving", "gripping nothing"},
    Row{"gripping", "quiet", "holding", "holding"},
    Row{"gripping", "", "moving", ""},
    Row{"gripping nothing", "close", "moving", "closing"},
    Row{"gripping nothing", "stop", "stopped", "open"},
    Row{"gripping nothing", "put object", "moving", "gripping"},
    Row{"gripping nothing", "quiet", "holding", "holding nothing"},
    Row{"gripping nothing", "", "moving", ""},
    Row{"holding", "stop", "stopped", "stopped at object"},
    Row{"holding", "take object", "holding", "holding nothing"},
    Row{"holding", "", "holding", ""},
    Row{"holding nothing", "close", "moving", "closing"},
    Row{"holding nothing", "stop", "stopped", "open"},
    Row{"holding nothing", "put object", "holding", "holding"},
    Row{"holding nothing", "", "holding", ""},
    Row{"stopped at object", "close", "holding", "holding"},
    Row{"stopped at object", "take object", "stopped", "open"},
    Row{"stopped at object", "", "stopped", ""},
    Row{"closed", "stop", "stopped", "stopped closed"},
    Row{"closed", "", "arrived", ""},
    Row{"stopped closed", "close", "arrived", "closed"},
    Row{"stopped closed", "", "stopped", ""},
};
constexpr std::array kTables{mealy::Table{"open", kRows}};

}  // namespace

std::span<const campaign::Learnable> machines() {
  static const std::array kMachines{campaign::Learnable{.name = "jaws",
                                                        .letters = kLetters,
                                                        .said = said,
                                                        .quiet = kQuiet,
                                                        .documented = kTables,
                                                        .source = "machine.cpp",
                                                        .begin = begin}};
  return kMachines;
}

}  // namespace gripper
