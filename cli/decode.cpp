// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/choice.hpp"
#include "cli/device.hpp"
#include "conformance/wording.hpp"
#include "harness/capture/message_json.hpp"
#include "harness/capture/pcapng.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/hex.hpp"
#include "harness/files/user_file.hpp"
#include "harness/wire/brief.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig::cli {
namespace {

constexpr auto kHelp =
    "Shows what bytes mean, a line for each message.\n"
    "\n"
    "  armjig decode DEVICE 'FF FF FF 34 00 ... 01 02'     hexadecimal digits\n"
    "  armjig decode DEVICE --file session.bin             raw bytes\n"
    "  armjig decode DEVICE --file session.jsonl           a recording\n"
    "  armjig decode DEVICE -v --file session.jsonl        field by field\n"
    "  some-program | armjig decode DEVICE --file - --json one JSON object for each message\n"
    "\n"
    "What passed on a bus begins with the address, shifted left, as in 24 01 00 00 80 3F.\n"
    "\n"
    "A file may hold raw bytes, hexadecimal digits or a golden-trace/1 recording; which of them "
    "is\n"
    "seen from its content unless --format says it. Bytes that are no message are shown as noise\n"
    "with the reason.";

struct Options {
  std::string device;
  std::vector<std::string> hex;
  std::string file;
  std::string format = "auto";
  std::string direction = "auto";
  bool json = false;
  bool is_verbose = false;
};

/// One piece of traffic to decode.
struct Chunk {
  Direction direction{};
  std::optional<Instant> time;  ///< none: nobody wrote it down
  std::vector<std::byte> bytes;
  std::uint32_t stream{};  ///< the connection; pieces of several do not belong together
};

/// Of raw bytes and digits; a recording is read by lines and may be larger.
constexpr std::size_t kMostBytes = std::size_t{64} << 20U;

Outcome<std::vector<std::byte>> parse_hex(const std::string& where, const std::string& text) {
  auto bytes = from_hex(text);
  if (bytes) return *std::move(bytes);
  return problem(bytes.error().code,
                 fmt::format("{}, character {}", where, bytes.error().detail + 1),
                 "write two digits for each byte");
}

Outcome<std::vector<Chunk>> chunks_of_trace(UserFile file, const std::string& path) {
  const auto trace = read_trace(std::move(file), path);
  if (!trace) return tl::unexpected{trace.error()};
  std::vector<Chunk> chunks;
  int unanswered = 0;
  for (const auto& event : trace->events) {
    if (event.dir == "to_device") {
      chunks.push_back({Direction::kToDevice, event.time, event.bytes, event.id});
    } else if (event.dir == "from_device") {
      chunks.push_back({Direction::kFromDevice, event.time, event.bytes, event.id});
    } else if (event.dir == "write" || event.dir == "read") {
      auto message = bus_message_of(event);
      if (message.empty()) ++unanswered;
      const auto direction = event.dir == "read" ? Direction::kFromDevice : Direction::kToDevice;
      if (!message.empty()) chunks.push_back({direction, event.time, std::move(message)});
    }
  }
  if (unanswered > 0) {
    fmt::print(stderr, "armjig decode: {} transactions without an answer are left out\n",
               unanswered);
  }
  return chunks;
}

std::string guess_format(const std::string& content) { return from_hex(content) ? "hex" : "raw"; }

/// Without a direction the bytes go through both dissectors, and the one that finds more messages
/// in them wins.
Direction guess_direction(MakeDissector make_dissector, Bytes bytes) {
  const auto messages_in = [&](Direction direction) {
    std::vector<Message> messages;
    make_dissector()->feed(direction, {}, bytes, messages);
    return std::ranges::count_if(messages, [](const Message& m) { return m.fault.empty(); });
  };
  return messages_in(Direction::kToDevice) > messages_in(Direction::kFromDevice)
             ? Direction::kToDevice
             : Direction::kFromDevice;
}

Direction direction_of(const Options& options, MakeDissector make_dissector, Bytes bytes) {
  if (options.direction == "to-device") return Direction::kToDevice;
  if (options.direction == "from-device") return Direction::kFromDevice;
  return guess_direction(make_dissector, bytes);
}

Outcome<std::vector<Chunk>> read_chunks(const Options& options, MakeDissector make_dissector) {
  const auto one_chunk = [&](std::vector<std::byte> bytes) {
    const auto direction = direction_of(options, make_dissector, bytes);
    return std::vector{Chunk{direction, std::nullopt, std::move(bytes)}};
  };
  if (options.file.empty()) {
    std::string text;
    for (const auto& word : options.hex) text += word + ' ';
    return parse_hex("argument", text).map(one_chunk);
  }
  auto file = options.file == "-" ? UserFile::standard_input() : UserFile::open(options.file);
  if (!file) return tl::unexpected{file.error()};
  const bool is_trace =
      options.format == "auto" && (file->peek() == '{' || file->starts_with(pcapng::kMagic));
  if (is_trace || options.format == "trace") return chunks_of_trace(*std::move(file), options.file);
  const auto content = file->rest(kMostBytes);
  if (!content) return tl::unexpected{content.error()};
  const auto format = options.format == "auto" ? guess_format(*content) : options.format;
  if (format == "hex") return parse_hex(options.file, *content).map(one_chunk);
  const auto raw = std::as_bytes(std::span{*content});
  return one_chunk({raw.begin(), raw.end()});
}

void print(const Message& message, bool has_time, const Options& options) {
  if (options.json) return fmt::print("{}\n", to_json(message));
  if (has_time) fmt::print("{:>12.3f} ms ", milliseconds(message.time.time_since_epoch()));
  fmt::print("{}\n", options.is_verbose ? to_text(message) : to_line(message));
}

Exit decode(Devices devices, const Options& options) {
  if (options.hex.empty() == options.file.empty()) {
    fmt::print(stderr, "armjig decode: give hexadecimal digits or --file, one of them\n");
    return Exit::kUsage;
  }
  const auto device = find_device(devices, options.device);
  if (!device) return report(device.error());
  const auto make_dissector = (*device)->make_dissector;
  const auto chunks = read_chunks(options, make_dissector);
  if (!chunks) {
    (void)report(chunks.error());
    return Exit::kUsage;
  }
  std::map<std::uint32_t, std::unique_ptr<Dissector>> streams;
  std::vector<Message> messages;
  for (const auto& chunk : *chunks) {
    auto& dissector = streams[chunk.stream];
    if (!dissector) dissector = make_dissector();
    dissector->feed(chunk.direction, chunk.time.value_or(Instant{}), chunk.bytes, messages);
  }
  for (const auto& [stream, dissector] : streams) dissector->finish(messages);
  const bool has_times = !chunks->empty() && chunks->front().time;
  bool all_are_messages = true;
  for (const auto& message : messages) {
    all_are_messages = all_are_messages && message.fault.empty();
    print(message, has_times, options);
  }
  if (messages.empty()) {
    fmt::print(stderr, "armjig decode: there are no bytes to decode\n");
    return Exit::kNothing;
  }
  return all_are_messages ? Exit::kPassed : Exit::kFindings;
}

}  // namespace

void add_decode(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("decode", with_example(kHelp, devices));
  const auto options = std::make_shared<Options>();
  add_device_argument(*command, options->device, devices);
  command->add_option("HEX", options->hex, "hexadecimal digits, in any number of words");
  command->add_option("--file", options->file, "read this file, '-' for standard input");
  command->add_option("--format", options->format, "what the file holds")
      ->check(one_of({"auto", "raw", "hex", "trace"}))
      ->capture_default_str();
  command->add_option("--direction", options->direction, "who sent the bytes")
      ->check(one_of({"auto", "to-device", "from-device"}))
      ->capture_default_str();
  command->add_flag("-v,--verbose", options->is_verbose, "all bytes, and a line for each field");
  command->add_flag("--json", options->json, "one JSON object a message (docs/schemas)");
  command->callback([options, devices, &action] {
    action = [options, devices] { return decode(devices, *options); };
  });
}

}  // namespace armjig::cli
