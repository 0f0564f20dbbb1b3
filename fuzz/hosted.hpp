// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "fuzz/answers.hpp"
#include "fuzz/input.hpp"
#include "fuzz/require.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/dissector.hpp"

/// A device as `armjig emulate` hosts it: its clients, somebody beside it, and time.
namespace armjig::fuzz {

/// One thing that happens to it.
struct Step {
  enum class Kind : std::uint8_t { kSay, kHand, kConnect, kHalfClose, kClose, kReset, kCopy };

  Instant time{};
  Kind kind{};
  ConnectionId who{};            ///< of a server
  std::vector<std::byte> piece;  ///< of `kSay`
  std::string_view input;        ///< of `kHand`
  std::int64_t value{};
};

/// What clients and people of one kind of device can do.
struct Surroundings {
  std::span<const std::string_view> inputs;
  std::vector<std::byte> (*piece)(Input&);  ///< what a client says next
  MakeDissector make_dissector;
};

inline std::int64_t odd_value(Input& input) {
  constexpr auto kValues = std::to_array<std::int64_t>(
      {-1, 0, 1, 2, 3, 127, 128, 255, 256, -1000, 1000, 32'767, -32'768, INT32_MAX, INT32_MIN});
  const auto choice = input.u8();
  return choice < kValues.size() ? kValues[choice] : input.i16();
}

inline Step next_step(Input& input, Instant now, const Surroundings& around) {
  using namespace std::chrono_literals;
  constexpr std::array<Duration, 8> kPauses{0ms, 1ms, 5ms, 10ms, 30ms, 100ms, 300ms, 1s};
  using enum Step::Kind;
  constexpr std::array kKinds{kSay, kSay, kSay, kHand, kConnect, kHalfClose, kClose, kReset, kCopy};
  const auto choice = input.u8();
  Step step{.time = now + kPauses[choice & 7], .kind = kKinds[(choice >> 3) % kKinds.size()]};
  switch (step.kind) {
    case kSay:
      step.who = input.u8() & 3;
      step.piece = around.piece(input);
      break;
    case kHand:
      step.input = around.inputs[input.u8() % around.inputs.size()];
      step.value = odd_value(input);
      break;
    case kCopy:
      break;
    default:
      step.who = input.u8() & 3;
      break;
  }
  return step;
}

template <EmulatedStream Device>
void apply(Device& device, const Step& step) {
  if (step.kind == Step::Kind::kSay) device.receive(step.time, step.piece);
}

template <EmulatedMultiServer Device>
void apply(Device& device, const Step& step) {
  switch (step.kind) {
    case Step::Kind::kSay:
      device.receive(step.time, step.who, step.piece);
      break;
    case Step::Kind::kConnect:
      if (device.is_listening()) (void)device.connect(step.time);
      break;
    case Step::Kind::kHalfClose:
      device.half_close(step.time, step.who);
      break;
    case Step::Kind::kClose:
      device.close(step.time, step.who);
      break;
    case Step::Kind::kReset:
      device.reset(step.time, step.who);
      break;
    default:
      break;
  }
}

inline ConnectionId connection_of(const SentBytes& /*sent*/) { return 0; }
inline ConnectionId connection_of(const ServerEvent& sent) { return sent.connection; }

/// A device that everything has happened to.
template <class Device>
struct Hosted {
  Device device;
  std::size_t pieces{};  ///< that its clients said
};

/// Lets happen to `fresh`, whose time is `begin`, what the input says, for at most `longest`; from
/// its first copy on, to the copy, too.
template <class Device>
Hosted<Device> check_hosted(const Device& fresh, Instant begin, Input input, Duration longest,
                            const Surroundings& around) {
  auto device = fresh;
  std::size_t pieces = 0;
  std::optional<Device> copy;
  const auto happen = [](Device& to, const Step& step) {
    if (step.kind == Step::Kind::kHand) {
      (void)to.set_input(step.time, step.input, step.value);
    } else {
      apply(to, step);
    }
    to.advance_to(step.time);
  };
  auto now = begin;
  while (!input.is_empty() && now < begin + longest) {
    const auto step = next_step(input, now, around);
    now = step.time;
    if (step.kind == Step::Kind::kSay) ++pieces;
    happen(device, step);
    if (copy) happen(*copy, step);
    if (step.kind == Step::Kind::kCopy && !copy) copy = device;
  }
  Answers answers{around.make_dissector};
  for (const auto& sent : device.sent()) {
    answers.hear(sent.time, connection_of(sent), sent.bytes);
  }
  const auto is_same = [](const auto& one, const auto& other) {
    return one.time == other.time && one.bytes == other.bytes &&
           connection_of(one) == connection_of(other);
  };
  require(!copy || std::ranges::equal(device.sent(), copy->sent(), is_same),
          "a copy goes on to the same bytes");
  return {std::move(device), pieces};
}

}  // namespace armjig::fuzz
