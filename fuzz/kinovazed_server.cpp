// SPDX-License-Identifier: Apache-2.0
// The KinovaZED server and all that reads its lines: no client can make the emulator end, grow or
// lose a byte; a documented server answers the same however the stream is cut.
//
// Input: one byte of choices, then what a client sends.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "emulators/kinovazed/server.hpp"
#include "fuzz/require.hpp"
#include "harness/wire/kinovazed/dissector.hpp"

namespace armjig::fuzz::kinova {
namespace {

using namespace kinovazed;
using namespace emulation;
using namespace std::chrono_literals;

std::string answers(const ServerOptions& options, Bytes stream, std::size_t piece) {
  Server server{ArmPort{BenchArm{{.start_mode = ArmMode::kReady}}}, options};
  auto now = at(60ms);
  const auto id = server.connect(now);
  require(id.has_value(), "a fresh server listens");
  while (!stream.empty()) {
    const auto size = std::min(piece, stream.size());
    server.receive(now, *id, stream.first(size));
    stream = stream.subspan(size);
    server.advance_to(now);
  }
  server.advance_to(now + 2s);
  std::string text;
  for (const auto& event : server.sent()) {
    for (const auto byte : event.bytes) text.push_back(static_cast<char>(byte));
    if (event.kind == SessionEvent::Kind::kEnd) text += "<end>";
  }
  return text;
}

void check_dissector(Bytes stream, Direction direction) {
  std::vector<Message> out;
  const auto dissector = make_dissector();
  dissector->feed(direction, {}, stream, out);
  dissector->finish(out);
  std::vector<std::byte> bytes;
  for (const auto& message : out) {
    (void)to_text(message);
    bytes.insert(bytes.end(), message.raw.begin(), message.raw.end());
  }
  require(std::ranges::equal(bytes, stream), "the dissector loses no byte");
}

void check_stream(Bytes stream, std::uint8_t choices) {
  ServerOptions options;
  options.call_time = 1ms;  // else the arm acts between two pieces that come at once
  (void)answers(options, stream, 1U + choices);
  options.behaviour = kDocumentedBehaviour;
  require(answers(options, stream, stream.size()) == answers(options, stream, 1U + choices % 8U),
          "a documented server does not care how the stream is cut");
  check_dissector(stream, Direction::kToDevice);
  check_dissector(stream, Direction::kFromDevice);
}

}  // namespace
}  // namespace armjig::fuzz::kinova

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2 || size > 4096) return 0;
  armjig::fuzz::kinova::check_stream(std::as_bytes(std::span{data + 1, size - 1}), data[0]);
  return 0;
}
