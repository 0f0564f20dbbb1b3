// SPDX-License-Identifier: Apache-2.0
// All that reads the PAROL6 byte stream: cutting the stream differently changes nothing, and the
// shipped board's receiver is the one that its state table describes.
//
// Input: one byte of choices, then the stream.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "emulators/parol6/firmware_receiver.hpp"
#include "fuzz/require.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/splitter.hpp"

namespace armjig::fuzz {
namespace {

using parol6::CheckPolicy;
using parol6::Splitter;
using parol6::emulation::FirmwareReceiver;

/// Feeds `in` in pieces of at most `piece` bytes.
template <class Feed>
void in_pieces(Bytes in, std::size_t piece, Feed feed) {
  while (!in.empty()) {
    const auto size = std::min(piece, in.size());
    feed(in.first(size));
    in = in.subspan(size);
  }
}

struct Found {
  std::size_t size{};  ///< of a frame; 0 for a fault
  Splitter::FaultKind kind{};
  std::uint8_t value{};

  friend bool operator==(const Found&, const Found&) = default;
};

/// All frames are in one piece of memory, as most of the time went into allocating one for each.
struct SplitResult {
  std::vector<Found> found;
  std::vector<std::byte> frames;
  std::size_t held{};

  friend bool operator==(const SplitResult& one, const SplitResult& other) {
    return one.found == other.found && one.held == other.held &&
           are_equal(one.frames, other.frames);
  }
};

SplitResult split(Splitter splitter, Bytes stream, std::size_t piece) {
  SplitResult result;
  in_pieces(stream, piece, [&](Bytes rest) {
    while (!rest.empty()) {
      const auto step = splitter.step(rest);
      require(step.used > 0 && step.used <= rest.size(), "a splitter gets on, inside its input");
      rest = rest.subspan(step.used);
      if (const auto* frame = std::get_if<Splitter::Frame>(&step.found)) {
        result.found.push_back({.size = frame->bytes.size()});
        result.frames.insert(result.frames.end(), frame->bytes.begin(), frame->bytes.end());
      } else if (const auto* fault = std::get_if<Splitter::Fault>(&step.found)) {
        result.found.push_back({.kind = fault->kind, .value = fault->value});
      }
    }
  });
  result.held = splitter.held();
  return result;
}

/// Where frames ended and what the board unpacks there, one body after the other.
struct Accepted {
  std::vector<std::size_t> ends;
  std::vector<std::byte> bodies;

  void add(std::size_t end, Bytes body) {
    ends.push_back(end);
    bodies.insert(bodies.end(), body.begin(), body.end());
  }
  friend bool operator==(const Accepted& one, const Accepted& other) {
    return one.ends == other.ends && are_equal(one.bodies, other.bodies);
  }
};

Accepted accept(Bytes stream, std::size_t piece) {
  FirmwareReceiver receiver;
  Accepted accepted;
  std::size_t place = 0;
  in_pieces(stream, piece, [&](Bytes rest) {
    while (!rest.empty()) {
      const auto step = receiver.step(rest);
      require(step.used > 0 && step.used <= rest.size(), "a receiver gets on, inside its input");
      place += step.used;
      rest = rest.subspan(step.used);
      if (step.accepted) accepted.add(place, receiver.body());
    }
  });
  return accepted;
}

/// The state table of docs/spec/parol6.md, one byte at a time. The store and what lies around it in
/// the board's memory are one array: fill counter, store, length.
Accepted accept_by_the_table(Bytes stream) {
  std::array<std::uint8_t, 257> memory{};
  auto& fill = memory.front();
  auto& length = memory.back();
  const auto store = std::span{memory}.subspan<1>();
  int state = 0;  // start bytes seen; 4: in the payload
  Accepted accepted;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const auto byte = std::to_integer<std::uint8_t>(stream[i]);
    if (state < 3) {
      state = byte == 0xFF ? state + 1 : 0;
    } else if (state == 3) {
      length = byte;
      fill = 0;
      state = 4;
    } else if (fill != int{length} - 1) {
      store[fill] = byte;  // at 255 this is the length
      ++fill;
    } else {
      store[fill] = byte;
      const bool ends_well = memory[length - 1U] == 1 && memory[length] == 2;
      if (ends_well) {
        accepted.add(i + 1, std::as_bytes(store).first<parol6::kCommandBodySize>());
      }
      state = 0;
      length = fill = 0;
    }
  }
  return accepted;
}

void check_codecs(const SplitResult& result) {
  Bytes frames{result.frames};
  for (const auto& found : result.found) {
    const auto frame = frames.first(found.size);
    frames = frames.subspan(found.size);
    if (frame.size() == parol6::kCommandFrameSize) {
      const auto body = parol6::body_of(frame.first<parol6::kCommandFrameSize>());
      const auto again = encode(parol6::decode_command(body));
      require(are_equal(again, frame), "encode(decode(x)) == x for commands");
    } else if (frame.size() == parol6::kTelemetryFrameSize) {
      const auto body = parol6::body_of(frame.first<parol6::kTelemetryFrameSize>());
      const auto again = encode(parol6::decode_telemetry(body));
      require(are_equal(again, frame), "encode(decode(x)) == x for telemetry");
    }
  }
}

/// How many messages there are; they are the bytes of the stream in order.
std::size_t messages_in(Bytes stream, std::size_t piece) {
  std::vector<Message> out;
  const auto dissector = parol6::make_dissector();
  in_pieces(stream, piece,
            [&](Bytes part) { dissector->feed(Direction::kToDevice, {}, part, out); });
  dissector->finish(out);
  for (const auto& message : out) {
    require(!message.raw.empty(), "a message has bytes");
    const auto size = std::min(message.raw.size(), stream.size());
    require(are_equal(message.raw, stream.first(size)), "the dissector loses no byte");
    stream = stream.subspan(size);
  }
  require(stream.empty(), "the dissector loses no byte");
  return out.size();
}

void check_stream(Bytes stream, std::uint8_t choices) {
  constexpr std::array kPolicies{CheckPolicy::kIgnore, CheckPolicy::kBoardOnly,
                                 CheckPolicy::kBoardOrHost, CheckPolicy::kIgnore};
  const auto size =
      (choices & 4) != 0 ? parol6::kTelemetryPayloadSize : parol6::kCommandPayloadSize;
  const Splitter splitter{size, kPolicies[choices & 3]};
  const std::size_t piece = 2U + (choices >> 3);
  const auto whole = split(splitter, stream, stream.size());
  require(whole == split(splitter, stream, 1), "the splitter finds the same byte by byte");
  require(whole == split(splitter, stream, piece), "the splitter finds the same in pieces");
  check_codecs(whole);

  const auto accepted = accept(stream, stream.size());
  require(accepted == accept(stream, 1), "the receiver accepts the same byte by byte");
  require(accepted == accept(stream, piece), "the receiver accepts the same in pieces");
  require(accepted == accept_by_the_table(stream), "the receiver is the one of the state table");

  require(messages_in(stream, stream.size()) == messages_in(stream, 1),
          "the dissector finds the same byte by byte");
}

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  armjig::fuzz::check_stream(std::as_bytes(std::span{data + 1, size - 1}), data[0]);
  return 0;
}
