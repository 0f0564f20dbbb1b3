// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/checks.hpp"
#include "cli/choice.hpp"
#include "cli/device.hpp"
#include "cli/foreign_options.hpp"
#include "cli/signals.hpp"
#include "harness/capture/capture.hpp"
#include "harness/capture/message_json.hpp"
#include "harness/capture/trace.hpp"
#include "harness/core/hex.hpp"
#include "harness/files/user_file.hpp"
#include "harness/foreign/foreign.hpp"
#include "harness/wire/append_text.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig::cli {
namespace {

constexpr auto kDecodeHelp =
    "Shows what bytes mean, a line for each message.\n"
    "\n"
    "  armjig decode DEVICE 'FF FF FF 34 00 ... 01 02'     hexadecimal digits\n"
    "  armjig decode DEVICE --file session.bin             raw bytes\n"
    "  armjig decode DEVICE --file session.jsonl           a recording\n"
    "  armjig decode DEVICE -v --file session.jsonl        field by field\n"
    "  some-program | armjig decode DEVICE --file - --json one JSON object for each message\n"
    "  armjig decode DEVICE --file session.pcapng --csv    a table, for spreadsheets and "
    "PlotJuggler\n"
    "  armjig decode DEVICE --file session.pcapng --field NAME=VALUE --from 1.5 --to 2\n"
    "  armjig decode DEVICE --interface lo                 what passes there from now on, until "
    "Ctrl-C\n"
    "\n"
    "What passed on a bus begins with the address, shifted left, as in 24 01 00 00 80 3F.\n"
    "\n"
    "A file may hold raw bytes, hexadecimal digits or a recording, of other programs, too; which "
    "of them is\n"
    "seen from its content unless --format says it. Bytes that are no message are shown as noise\n"
    "with the reason.";

/// `NAME=VALUE`
struct Wanted {
  std::string name;
  std::string value;
};

struct DecodeOptions {
  std::string device;
  std::vector<std::string> hex;
  std::string file;
  std::string format = "auto";
  std::string direction = "auto";
  bool json = false;
  bool csv = false;
  bool is_verbose = false;
  bool is_quiet = false;  ///< nothing is said beside the messages
  std::vector<std::string> fields;
  double from = 0;
  double to = std::numeric_limits<double>::max();
  std::optional<std::uint32_t> connection;
  std::optional<std::uint32_t> address;
  std::string interface;
  ForeignOptions foreign;
};

/// A message, and where it passed.
struct Decoded {
  const Message& message;
  bool has_time;
};
using Use = std::function<void(const Decoded& decoded)>;

/// Of raw bytes and digits; a recording is read by lines and may be larger.
constexpr std::size_t kMostPipedBytes = std::size_t{64} << 20U;

Outcome<std::vector<std::byte>> parse_hex(const std::string& where, const std::string& text) {
  auto bytes = from_hex(text);
  if (bytes) return *std::move(bytes);
  return problem(bytes.error().code,
                 fmt::format("{}, character {}", where, bytes.error().detail + 1),
                 "write two digits for each byte");
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

Direction direction_of(const DecodeOptions& options, MakeDissector make_dissector, Bytes bytes) {
  if (options.direction == "to-device") return Direction::kToDevice;
  if (options.direction == "from-device") return Direction::kFromDevice;
  return guess_direction(make_dissector, bytes);
}

bool is_wanted(const CaptureRecord& record, const DecodeOptions& options) {
  const auto kind = record.link->kind;
  const bool is_session = kind == LinkKind::kSession;
  const bool is_bus = kind == LinkKind::kBus;
  if (!is_session && !is_bus && kind != LinkKind::kStream) return false;
  if (options.connection && (!is_session || record.id != options.connection)) return false;
  return !options.address || (is_bus && record.id == options.address);
}

/// Message by message, in memory that does not grow with the file.
Outcome<void> decode_recording(Outcome<std::unique_ptr<CaptureReader>> reader,
                               const DecodeOptions& options, Devices devices, const Device& device,
                               const Use& use) {
  if (!reader) return tl::unexpected{reader.error()};
  std::map<std::pair<const CaptureLink*, std::uint32_t>, std::unique_ptr<Dissector>> talks;
  std::vector<Message> messages;
  const auto tell = [&] {
    for (const auto& message : messages) use({message, true});
    messages.clear();
  };
  int unanswered = 0;
  auto read = for_each_record(**reader, [&](const CaptureRecord& record) {
    if (!is_wanted(record, options)) return;
    const auto* const other = find_recorded_device(devices, record.link->device);
    if (other != nullptr && other != &device) return;
    const bool is_bus = record.link->kind == LinkKind::kBus;
    std::vector<std::byte> bus_message;
    if (is_bus) bus_message = bus_message_of(record);
    if (is_bus && bus_message.empty()) {
      ++unanswered;
      return;
    }
    auto& dissector = talks[{record.link, is_bus ? 0 : record.id}];
    if (dissector && lost_before(record) > 0) dissector->finish(messages);
    if (!dissector || lost_before(record) > 0) dissector = device.make_dissector();
    dissector->feed(record.direction, record.time, is_bus ? Bytes{bus_message} : record.bytes,
                    messages);
    tell();
  });
  for (const auto& [where, dissector] : talks) dissector->finish(messages);
  tell();
  if (unanswered > 0 && !options.is_quiet) {
    fmt::print(stderr, "armjig decode: {} transactions without an answer are left out\n",
               unanswered);
  }
  if (!options.is_quiet) print_warning_of(**reader);
  return read;
}

/// Bytes of which nobody knows when they passed.
void decode_bytes(const std::vector<std::byte>& bytes, const DecodeOptions& options,
                  const Device& device, const Use& use) {
  std::vector<Message> messages;
  const auto dissector = device.make_dissector();
  dissector->feed(direction_of(options, device.make_dissector, bytes), {}, bytes, messages);
  dissector->finish(messages);
  for (const auto& message : messages) use({message, false});
}

Outcome<void> decode_all(const DecodeOptions& options, Devices devices, const Device& device,
                         const Use& use) {
  const auto decode = [&](const std::vector<std::byte>& bytes) {
    decode_bytes(bytes, options, device, use);
  };
  const auto how = foreign_how(devices, options.foreign, device.name);
  if (!how) return tl::unexpected{how.error()};
  if (!options.interface.empty()) {
    const Signals signals;
    auto reader = open_interface(options.interface, *how, [&] { return signals.has_come(); });
    return decode_recording(std::move(reader), options, devices, device, use);
  }
  if (options.file.empty()) {
    std::string text;
    for (const auto& word : options.hex) text += word + ' ';
    return parse_hex("argument", text).map(decode);
  }
  auto file = options.file == "-" ? UserFile::standard_input() : UserFile::open(options.file);
  if (!file) return tl::unexpected{file.error()};
  if (options.format == "trace" || (options.format == "auto" && is_capture(*file))) {
    auto reader = open_foreign(*std::move(file), options.file, *how);
    return decode_recording(std::move(reader), options, devices, device, use);
  }
  const auto content = file->rest(kMostPipedBytes);
  if (!content) return tl::unexpected{content.error()};
  const auto format = options.format == "auto" ? guess_format(*content) : options.format;
  if (format == "hex") return parse_hex(options.file, *content).map(decode);
  const auto raw = std::as_bytes(std::span{*content});
  decode({raw.begin(), raw.end()});
  return {};
}

/// One number of a message: a field, or a flag of one.
struct Value {
  std::string name;
  std::string number;
  std::string_view word;  ///< what the number is called; empty: nothing
};

template <class Take>
void each_value(const Message& message, Take take) {
  for (const auto& field : message.fields) {
    const auto value = field_value(field, message.raw);
    if (field.encoding == Encoding::kLiteral) continue;
    if (field.encoding == Encoding::kFloatLittle) {
      const auto real = std::bit_cast<float>(static_cast<std::uint32_t>(value));
      take(Value{std::string{field.name}, fmt::format("{}", real), {}});
      continue;
    }
    const auto named = std::ranges::find(field.values, value, &NamedValue::value);
    take(Value{std::string{field.name}, std::to_string(value),
               named == field.values.end() ? std::string_view{} : named->name});
    for (std::size_t i = 0; i < field.bits.size(); ++i) {
      if (field.bits[i].empty()) continue;
      const auto bit = value >> (field.bits.size() - 1 - i) & 1;
      take(Value{fmt::format("{}.{}", field.name, field.bits[i]), std::to_string(bit), {}});
    }
  }
}

bool has_value(const Message& message, const Wanted& wanted) {
  if (wanted.name == "message") return message.name == wanted.value;
  bool is_there = false;
  each_value(message, [&](const Value& value) {
    is_there = is_there ||
               (value.name == wanted.name && (value.number == wanted.value ||
                                              (!value.word.empty() && value.word == wanted.value)));
  });
  return is_there;
}

bool is_wanted(const Decoded& decoded, const DecodeOptions& options,
               const std::vector<Wanted>& wanted) {
  const auto& message = decoded.message;
  const auto time = seconds(message.time);
  if (decoded.has_time && (time < options.from || time > options.to)) return false;
  const auto says = [&message](Direction direction) { return message.direction == direction; };
  if (options.direction == "to-device" && !says(Direction::kToDevice)) return false;
  if (options.direction == "from-device" && !says(Direction::kFromDevice)) return false;
  return std::ranges::all_of(wanted,
                             [&message](const Wanted& one) { return has_value(message, one); });
}

Outcome<std::vector<Wanted>> parse_wanted(const std::vector<std::string>& fields) {
  std::vector<Wanted> all;
  for (const auto& field : fields) {
    const auto equals = field.find('=');
    if (equals == 0 || equals == std::string::npos) {
      return problem(ErrorCode::kBadValue, "--field " + field, "write NAME=VALUE");
    }
    all.push_back({field.substr(0, equals), field.substr(equals + 1)});
  }
  return all;
}

/// One row per message. Columns are the values that any of them has, in the order in which they
/// first come, so they are known before the first row is printed.
class Table {
 public:
  void learn(const Message& message) {
    each_value(message, [this](const Value& value) {
      if (places_.try_emplace(value.name, names_.size()).second) names_.push_back(value.name);
    });
  }

  void print_head() const {
    std::string line{"time_s,direction,message,fault"};
    for (const auto& name : names_) line += ',' + cell(name);
    fmt::print("{}\n", line);
  }

  void print(const Decoded& decoded) {
    const auto& message = decoded.message;
    cells_.assign(names_.size(), {});
    each_value(message, [this](const Value& value) {
      const auto place = places_.find(value.name);
      if (place != places_.end()) cells_[place->second] = value.number;
    });
    auto line = fmt::format("{},{},{},{}",
                            decoded.has_time ? fmt::format("{:.9f}", seconds(message.time)) : "",
                            to_string(message.direction), cell(message.name), cell(message.fault));
    for (const auto& number : cells_) line += ',' + number;
    fmt::print("{}\n", line);
  }

 private:
  static std::string cell(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string{text};
    std::string quoted{'"'};
    for (const char one : text) quoted.append(one == '"' ? 2 : 1, one);
    return quoted + '"';
  }

  std::vector<std::string> names_;
  std::map<std::string, std::size_t, std::less<>> places_;
  std::vector<std::string> cells_;
};

/// Messages as lines. They are collected: a file may have millions of them.
class Lines {
 public:
  explicit Lines(const DecodeOptions& options) : options_{options} {}
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;
  ~Lines() { flush(); }

  void print(const Decoded& decoded) {
    const auto& message = decoded.message;
    if (options_.json) {
      append_json(text_, message);
    } else {
      if (decoded.has_time) {
        fmt::format_to(std::back_inserter(text_), "{:>12.3f} ms ",
                       milliseconds(message.time.time_since_epoch()));
      }
      options_.is_verbose ? void(text_ += to_text(message)) : append_line(text_, message);
    }
    text_ += '\n';
    if (text_.size() >= enough_) flush();
  }

 private:
  static constexpr std::size_t kMuch = std::size_t{64} << 10U;

  void flush() {
    std::fwrite(text_.data(), 1, text_.size(), stdout);
    text_.clear();
  }

  [[nodiscard]] bool is_watched() const {
    return !options_.interface.empty() || ::isatty(STDOUT_FILENO) != 0;
  }

  const DecodeOptions& options_;
  std::size_t enough_ = is_watched() ? 1 : kMuch;
  std::string text_;
};

Exit decode(Devices devices, const DecodeOptions& options) {
  const auto inputs = (options.hex.empty() ? 0 : 1) + (options.file.empty() ? 0 : 1) +
                      (options.interface.empty() ? 0 : 1);
  if (inputs != 1) {
    fmt::print(stderr,
               "armjig decode: give hexadecimal digits, --file or --interface, one of them\n");
    return Exit::kUsage;
  }
  const auto device = find_device(devices, options.device);
  if (!device) return report(device.error());
  const auto wanted = parse_wanted(options.fields);
  if (!wanted) return report(wanted.error());
  if (options.to < options.from) {
    return report({ErrorCode::kBadValue, "--to", "it is before --from"});
  }
  if (options.csv && (options.file == "-" || !options.interface.empty())) {
    return report({ErrorCode::kBadValue, "--csv",
                   "the columns are known when all is read, so it is read twice: name a file"});
  }
  const auto decode_wanted = [&](const DecodeOptions& how, const Use& use) {
    return decode_all(how, devices, **device, [&](const Decoded& decoded) {
      if (is_wanted(decoded, options, *wanted)) use(decoded);
    });
  };
  Table table;
  if (options.csv) {
    auto how = options;
    how.is_quiet = true;  // what is wrong is said when it is read again
    (void)decode_wanted(how, [&table](const Decoded& decoded) { table.learn(decoded.message); });
    table.print_head();
  }
  bool is_empty = true;
  bool all_are_messages = true;
  Lines lines{options};
  const auto decoded = decode_wanted(options, [&](const Decoded& one) {
    is_empty = false;
    all_are_messages = all_are_messages && one.message.fault.empty();
    options.csv ? table.print(one) : lines.print(one);
    if (!options.interface.empty()) (void)std::fflush(stdout);
  });
  if (!decoded) {
    const auto exit = report(decoded.error());
    return options.interface.empty() ? Exit::kUsage : exit;
  }
  if (is_empty) {
    fmt::print(stderr, "armjig decode: there are no bytes to decode{}\n",
               options.fields.empty() ? "" : ", or no message is like that");
    return Exit::kNothing;
  }
  return all_are_messages ? Exit::kPassed : Exit::kFindings;
}

}  // namespace

void add_decode(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("decode", with_example(kDecodeHelp, devices));
  const auto options = std::make_shared<DecodeOptions>();
  add_device_argument(*command, options->device, devices);
  command->add_option("HEX", options->hex, "hexadecimal digits, in any number of words");
  command->add_option("--file", options->file, "read this file, '-' for standard input");
  command
      ->add_option("--interface", options->interface,
                   "what passes on a network interface or usbmonN of this machine, until Ctrl-C")
      ->type_name("NAME");
  add_foreign_options(*command, options->foreign);
  command->add_option("--format", options->format, "what the file holds")
      ->check(one_of({"auto", "raw", "hex", "trace"}))
      ->capture_default_str();
  command
      ->add_option("--direction", options->direction,
                   "who sent the bytes; of a recording: only that one's")
      ->check(one_of({"auto", "to-device", "from-device"}))
      ->capture_default_str();
  command->add_flag("-v,--verbose", options->is_verbose, "all bytes, and a line for each field");
  auto* json =
      command->add_flag("--json", options->json, "one JSON object a message (docs/schemas)");
  command->add_flag("--csv", options->csv, "a table: a row for each message, its fields as columns")
      ->excludes(json);
  command
      ->add_option("--field", options->fields,
                   "only messages with that value, as in command=idle; may be repeated")
      ->type_name("NAME=VALUE");
  constexpr double kMostSeconds = 1e9;
  command->add_option("--from", options->from, "of a recording: seconds since its start")
      ->type_name("S")
      ->check(number(0, kMostSeconds));
  command->add_option("--to", options->to, "of a recording: seconds since its start")
      ->type_name("S")
      ->check(number(0, kMostSeconds));
  constexpr std::uint64_t kMostId = std::numeric_limits<std::uint32_t>::max();
  command->add_option("--connection", options->connection, "of a recording: only this one, from 0")
      ->type_name("N")
      ->transform(whole(0, kMostId));
  command->add_option("--address", options->address, "of a recording of a bus: only this one")
      ->type_name("N")
      ->transform(whole(0, kMostId));
  when_chosen(*command, action, [options, devices] { return decode(devices, *options); });
}

}  // namespace armjig::cli
