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
#include <utility>
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
  std::vector<std::byte> frame;  ///< empty for a fault
  Splitter::FaultKind kind{};
  std::uint8_t value{};

  friend bool operator==(const Found&, const Found&) = default;
};

struct SplitResult {
  std::vector<Found> found;
  std::size_t held{};

  friend bool operator==(const SplitResult&, const SplitResult&) = default;
};

SplitResult split(Splitter splitter, Bytes stream, std::size_t piece) {
  SplitResult result;
  in_pieces(stream, piece, [&](Bytes rest) {
    while (!rest.empty()) {
      const auto step = splitter.step(rest);
      require(step.used > 0 && step.used <= rest.size(), "a splitter gets on, inside its input");
      rest = rest.subspan(step.used);
      if (const auto* frame = std::get_if<Splitter::Frame>(&step.found)) {
        result.found.push_back({{frame->bytes.begin(), frame->bytes.end()}, {}, {}});
      } else if (const auto* fault = std::get_if<Splitter::Fault>(&step.found)) {
        result.found.push_back({{}, fault->kind, fault->value});
      }
    }
  });
  result.held = splitter.held();
  return result;
}

using Accepted = std::vector<std::pair<std::size_t, std::vector<std::byte>>>;

/// Where frames ended and what the board unpacks there.
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
      const auto body = receiver.body();
      if (step.accepted) accepted.push_back({place, {body.begin(), body.end()}});
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
        const auto body = std::as_bytes(store).first<parol6::kCommandBodySize>();
        accepted.push_back({i + 1, {body.begin(), body.end()}});
      }
      state = 0;
      length = fill = 0;
    }
  }
  return accepted;
}

void check_codecs(const SplitResult& result) {
  for (const auto& found : result.found) {
    const auto frame = Bytes{found.frame};
    if (frame.size() == parol6::kCommandFrameSize) {
      const auto body = parol6::body_of(frame.first<parol6::kCommandFrameSize>());
      const auto again = encode(parol6::decode_command(body));
      require(std::ranges::equal(again, frame), "encode(decode(x)) == x for commands");
    } else if (frame.size() == parol6::kTelemetryFrameSize) {
      const auto body = parol6::body_of(frame.first<parol6::kTelemetryFrameSize>());
      const auto again = encode(parol6::decode_telemetry(body));
      require(std::ranges::equal(again, frame), "encode(decode(x)) == x for telemetry");
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
    require(std::ranges::equal(message.raw, stream.first(size)), "the dissector loses no byte");
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
