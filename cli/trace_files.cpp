// SPDX-License-Identifier: Apache-2.0
#include "cli/trace_files.hpp"

#include <fmt/core.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/outputs.hpp"
#include "harness/capture/capture.hpp"
#include "harness/files/user_file.hpp"
#include "harness/report/wording.hpp"
#include "harness/summary/session_summary.hpp"

namespace armjig::cli {
namespace {

using Json = nlohmann::ordered_json;
using OpenedCapture = std::unique_ptr<CaptureReader>;

constexpr auto kInfoHelp =
    "What is in recordings: format, device, links, length.\n"
    "\n"
    "  armjig trace info session.pcapng";
constexpr auto kShowHelp =
    "A session on one screen: who talked, how long, commands, what moved, states, findings,\n"
    "rates, gaps, and how long answers took.\n"
    "\n"
    "  armjig trace show session.pcapng\n"
    "  armjig trace show session.jsonl --json           for scripts\n"
    "\n"
    "Exit codes: 0 nothing was wrong on the wire, 1 bytes that are no message, 4 no record.";
constexpr auto kConvertHelp =
    "Writes a recording in the other format, which the ending of the name chooses.\n"
    "\n"
    "  armjig trace convert session.jsonl session.pcapng    for Wireshark\n"
    "  armjig trace convert session.pcapng session.jsonl    a golden-trace/1 text\n"
    "  armjig trace convert --redact a.pcapng b.pcapng      without user, host and target";
constexpr auto kCutHelp =
    "Writes a part of a recording.\n"
    "\n"
    "  armjig trace cut session.pcapng part.pcapng --from 1.5 --to 2\n"
    "  armjig trace cut session.jsonl client.jsonl --connection 0\n"
    "\n"
    "Times stay what they are. Events are kept within the times.";
constexpr auto kMergeHelp =
    "Puts recordings into one, in order of time: since 1970 if all of them know it, otherwise\n"
    "since the start of each.\n"
    "\n"
    "  armjig trace merge --out both.pcapng arm.pcapng gripper.jsonl";

/// Prints a problem of an input; answers what wrong input is answered with.
Exit refuse(const Problem& problem) {
  (void)report(problem);
  return Exit::kUsage;
}

void warn(const CaptureReader& reader) {
  const auto warning = reader.warning();
  std::size_t begin = 0;
  while (begin < warning.size()) {
    const auto end = std::min(warning.find('\n', begin), warning.size());
    fmt::print(stderr, "armjig: {}\n", wording::line(warning.substr(begin, end - begin)));
    begin = end + 1;
  }
}

Outcome<OpenedCapture> open_capture(const std::string& path) {
  auto file = path == "-" ? UserFile::standard_input() : UserFile::open(path);
  if (!file) return tl::unexpected{std::move(file.error())};
  return CaptureReader::open(*std::move(file), path == "-" ? "standard input" : path);
}

/// A recording that is being written, piece by piece.
class CaptureOutput {
 public:
  /// Problems: those of `open_output`, and `kBadValue` for a name whose ending nobody knows or a
  /// file that is read.
  static Outcome<CaptureOutput> open(std::string_view option, const std::string& path,
                                     const std::vector<std::string>& inputs) {
    const auto format = capture_format_of(path);
    if (!format) return tl::unexpected{format.error()};
    for (const auto& input : inputs) {
      struct stat in{};
      struct stat out{};
      const bool are_there =
          ::stat(input.c_str(), &in) == 0 && ::stat(path.c_str(), &out) == 0 && S_ISREG(in.st_mode);
      if (are_there && in.st_dev == out.st_dev && in.st_ino == out.st_ino) {
        return problem(ErrorCode::kBadValue, path, "it is read; write to another file");
      }
    }
    auto file = open_output(option, path, OutputFile::Kind::kGrowing);
    if (!file) return tl::unexpected{std::move(file.error())};
    return CaptureOutput{*std::move(file), make_capture_writer(*format)};
  }

  Outcome<void> begin(const CaptureHeader& header) { return writer_->begin(header, pending_); }

  Outcome<void> add(const CaptureRecord& record) {
    constexpr std::size_t kMostPending = std::size_t{64} << 10U;
    return writer_->add(record, {}, pending_).and_then([this]() -> Outcome<void> {
      return pending_.size() < kMostPending ? Outcome<void>{} : flush();
    });
  }

  Outcome<void> flush() {
    auto put = file_->put(pending_);
    pending_.clear();
    return put;
  }

 private:
  CaptureOutput(Output file, std::unique_ptr<CaptureWriter> writer)
      : file_{std::move(file)}, writer_{std::move(writer)} {}

  Output file_;
  std::unique_ptr<CaptureWriter> writer_;
  std::string pending_;
};

/// Writes those of the records that are wanted.
template <class Want>
Exit copy(const std::string& from, const std::string& to, bool is_redacted, Want want) {
  auto output = CaptureOutput::open("OUT", to, {from});
  if (!output) return report(output.error());
  const auto reader = open_capture(from);
  if (!reader) return refuse(reader.error());
  const auto& header = (*reader)->header();
  auto written = output->begin(is_redacted ? header.redacted() : header);
  std::uint64_t records = 0;
  CaptureRecord record;
  std::optional<Problem> unreadable;
  while (written) {
    const auto has_record = (*reader)->next(record);
    if (!has_record) unreadable = has_record.error();
    if (!has_record || !*has_record) break;
    if (!want(record)) continue;
    written = output->add(record);
    ++records;
  }
  if (written) written = output->flush();
  warn(**reader);
  if (unreadable) return refuse(*unreadable);  // what came before it is written
  if (!written && written.error().code == ErrorCode::kUnsupported) return refuse(written.error());
  if (!written) return Exit::kRig;  // which `Outputs` tells
  return records > 0 ? Exit::kPassed : Exit::kNothing;
}

/// Records of several recordings in one order.
class Merge {
 public:
  static Outcome<Merge> open(const std::vector<std::string>& paths) {
    Merge merge;
    for (const auto& path : paths) {
      auto reader = open_capture(path);
      if (!reader) return tl::unexpected{std::move(reader.error())};
      merge.inputs_.push_back({.reader = *std::move(reader), .record = {}, .links = {}});
    }
    merge.align();
    for (auto& input : merge.inputs_) {
      if (auto begun = merge.advance(input); !begun) return tl::unexpected{begun.error()};
    }
    return merge;
  }

  [[nodiscard]] CaptureHeader header() const {
    const auto& first = inputs_.front().reader->header();
    Json json{{"format", "golden-trace/1"}, {"device", first.device}, {"title", "merged"}};
    if (epoch_ns_ > 0) json["epoch_ns"] = epoch_ns_;
    for (const auto& input : inputs_) {
      json["merged"].push_back(Json::parse(input.reader->header().json));
    }
    return {json.dump(), first.device, epoch_ns_};
  }

  /// The earliest record that is left; false at the end.
  Outcome<bool> next(CaptureRecord& record) {
    // What was told last stays valid until now.
    if (auto* const told = std::exchange(last_, nullptr)) {
      if (auto advanced = advance(*told); !advanced) return advanced;
    }
    Input* earliest = nullptr;
    for (auto& input : inputs_) {
      if (!input.has_record) continue;
      if (earliest == nullptr || input.record.time < earliest->record.time) earliest = &input;
    }
    if (earliest == nullptr) return false;
    record = earliest->record;
    record.link = &link_of(*earliest, record.link);
    last_ = earliest;
    return true;
  }

  void warn_all() const {
    for (const auto& input : inputs_) warn(*input.reader);
  }

 private:
  struct Input {
    OpenedCapture reader;
    CaptureRecord record;
    std::map<const CaptureLink*, CaptureLink> links;
    Duration shift{};
    bool has_record = false;
  };

  void align() {
    const auto epoch_of = [](const Input& input) { return input.reader->header().epoch_ns; };
    const auto first = std::ranges::min_element(inputs_, {}, epoch_of);
    epoch_ns_ = epoch_of(*first);
    if (epoch_ns_ == 0) return;
    for (auto& input : inputs_) input.shift = Duration{epoch_of(input) - epoch_ns_};
  }

  Outcome<bool> advance(Input& input) {
    auto has_record = input.reader->next(input.record);
    input.has_record = has_record && *has_record;
    if (!input.has_record || input.shift == Duration::zero()) return has_record;
    const auto since = input.record.time.time_since_epoch();
    input.record.time = at(std::min(since, Duration::max() - input.shift) + input.shift);
    auto& details = input.record.details;
    if (details.starts_with(R"("t_ms":)")) {  // which is not its time any more
      const auto comma = details.find(',');
      details = comma == std::string_view::npos ? "" : details.substr(comma + 1);
    }
    return has_record;
  }

  /// As it is called in the output: two recordings of devices of one name are two links.
  const CaptureLink& link_of(Input& input, const CaptureLink* link) {
    const auto [found, is_new] = input.links.try_emplace(link, *link);
    if (!is_new) return found->second;
    const auto number = static_cast<std::size_t>(&input - inputs_.data());
    for (std::size_t other = 0; other < number; ++other) {
      const auto& header = inputs_[other].reader->header();
      if (header.device == input.reader->header().device) {
        found->second.name = fmt::format("{}#{}", link->name, number + 1);
        break;
      }
    }
    return found->second;
  }

  std::vector<Input> inputs_;
  std::int64_t epoch_ns_{};
  Input* last_ = nullptr;
};

Exit merge(const std::vector<std::string>& paths, const std::string& to) {
  auto output = CaptureOutput::open("--out", to, paths);
  if (!output) return report(output.error());
  auto merged = Merge::open(paths);
  if (!merged) return refuse(merged.error());
  auto written = output->begin(merged->header());
  CaptureRecord record;
  std::optional<Problem> unreadable;
  while (written) {
    const auto has_record = merged->next(record);
    if (!has_record) unreadable = has_record.error();
    if (!has_record || !*has_record) break;
    written = output->add(record);
  }
  if (written) written = output->flush();
  merged->warn_all();
  if (unreadable) return refuse(*unreadable);
  if (!written && written.error().code == ErrorCode::kUnsupported) return refuse(written.error());
  return written ? Exit::kPassed : Exit::kRig;
}

/// The first lines of `info` and `show`.
std::string title_of(const std::string& path, const CaptureReader& reader) {
  const auto& header = reader.header();
  const auto json = Json::parse(header.json);
  auto text = fmt::format("{}: {}, device {}\n", wording::line(path),
                          reader.format() == CaptureFormat::kPcapng ? "pcapng" : "golden-trace/1",
                          wording::line(header.device));
  for (const char* const key : {"title", "target", "profile", "source"}) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_string() || found->get<std::string>().empty()) continue;
    text += fmt::format("{:<12} {}\n", key, wording::line(found->get<std::string>()));
  }
  if (header.epoch_ns > 0) {
    const std::chrono::sys_seconds start{std::chrono::seconds{header.epoch_ns / 1'000'000'000}};
    text += fmt::format("{:<12} {} UTC\n", "start", wording::iso_time(start));
  }
  return text;
}

Exit info(const std::vector<std::string>& paths) {
  bool are_all_read = true;
  for (const auto& path : paths) {
    const auto reader = open_capture(path);
    if (!reader) {
      (void)report(reader.error());
      are_all_read = false;
      continue;
    }
    struct Count {
      std::uint64_t records{};
      std::uint64_t bytes{};
    };
    std::map<std::string, Count> links;
    CaptureRecord record;
    Outcome<bool> has_record = true;
    while ((has_record = (*reader)->next(record)) && *has_record) {
      auto& count = links[fmt::format("{} ({})", record.link->name, to_string(record.link->kind))];
      ++count.records;
      count.bytes += record.bytes.size();
    }
    fmt::print("{}", title_of(path, **reader));
    fmt::print("{:<12} {:.6f} s\n", "length",
               std::chrono::duration<double>{record.time.time_since_epoch()}.count());
    for (const auto& [name, count] : links) {
      fmt::print("{:<12} {}: {} records, {} bytes\n", "link", wording::line(name), count.records,
                 count.bytes);
    }
    warn(**reader);
    if (!has_record) (void)report(has_record.error());
    are_all_read = are_all_read && has_record;
  }
  return are_all_read ? Exit::kPassed : Exit::kUsage;
}

Exit show(const std::string& path, bool wants_json, Devices devices) {
  const auto reader = open_capture(path);
  if (!reader) return refuse(reader.error());
  SessionSummary summary{[devices](std::string_view name) -> MakeDissector {
    const auto* const device = find_recorded_device(devices, name);
    return device == nullptr ? nullptr : device->make_dissector;
  }};
  CaptureRecord record;
  Outcome<bool> has_record = true;
  bool is_empty = true;
  while ((has_record = (*reader)->next(record)) && *has_record) {
    summary.add(record);
    is_empty = false;
  }
  summary.finish();
  if (wants_json) {
    fmt::print("{}\n", summary.to_json());
  } else {
    fmt::print("{}{}", title_of(path, **reader), wording::lines(summary.to_text()));
  }
  warn(**reader);
  if (!has_record) return refuse(has_record.error());
  if (is_empty) return Exit::kNothing;
  return summary.has_findings() ? Exit::kFindings : Exit::kPassed;
}

struct Copying {
  std::string in;
  std::string out;
  bool is_redacted = false;
  double from = 0;
  double to = std::numeric_limits<double>::max();
  std::optional<std::uint32_t> connection;
  std::string device;

  [[nodiscard]] bool wants(const CaptureRecord& record) const {
    const auto time = std::chrono::duration<double>{record.time.time_since_epoch()}.count();
    if (time < from || time > to) return false;
    const bool is_event = record.link->kind == LinkKind::kEvents;
    if (!device.empty() && record.link->device != device) return false;
    const bool is_other = record.link->kind != LinkKind::kSession || record.id != connection;
    return is_event || !connection || !is_other;
  }
};

std::shared_ptr<Copying> add_copying(CLI::App& command) {
  const auto options = std::make_shared<Copying>();
  command.add_option("IN", options->in, "a recording; '-' for standard input")->required();
  command
      .add_option("OUT", options->out,
                  "a file .pcapng or .jsonl; '-' for a text on standard output")
      ->required();
  command.add_flag("--redact", options->is_redacted,
                   "leave out who recorded it and where: user, host, serial number, target");
  return options;
}

}  // namespace

void add_trace_files(CLI::App& trace, Devices devices, Action& action) {
  auto* info_command = trace.add_subcommand("info", kInfoHelp);
  const auto paths = std::make_shared<std::vector<std::string>>();
  info_command->add_option("FILE", *paths, "recordings; '-' for standard input")->required();
  info_command->callback([paths, &action] { action = [paths] { return info(*paths); }; });

  auto* show_command = trace.add_subcommand("show", kShowHelp);
  const auto shown = std::make_shared<std::pair<std::string, bool>>();
  show_command->add_option("FILE", shown->first, "a recording; '-' for standard input")->required();
  show_command->add_flag("--json", shown->second, "one JSON object (docs/schemas)");
  show_command->callback([shown, devices, &action] {
    action = [shown, devices] { return show(shown->first, shown->second, devices); };
  });

  auto* convert_command = trace.add_subcommand("convert", kConvertHelp);
  const auto converted = add_copying(*convert_command);
  convert_command->callback([converted, &action] {
    action = [converted] {
      return copy(converted->in, converted->out, converted->is_redacted,
                  [](const CaptureRecord&) { return true; });
    };
  });

  auto* cut_command = trace.add_subcommand("cut", kCutHelp);
  const auto cut = add_copying(*cut_command);
  constexpr double kMostSeconds = 1e9;
  cut_command->add_option("--from", cut->from, "seconds since the start")
      ->type_name("S")
      ->check(number(0, kMostSeconds));
  cut_command->add_option("--to", cut->to, "seconds since the start")
      ->type_name("S")
      ->check(number(0, kMostSeconds));
  cut_command->add_option("--connection", cut->connection, "only this one, from 0")
      ->type_name("N")
      ->transform(whole(0, std::numeric_limits<std::uint32_t>::max()));
  cut_command->add_option("--device", cut->device, "only this one")->type_name("DEVICE");
  cut_command->callback([cut, &action] {
    action = [cut] {
      if (cut->to < cut->from) {
        return report({ErrorCode::kBadValue, "--to", "it is before --from"});
      }
      return copy(cut->in, cut->out, cut->is_redacted,
                  [&cut](const CaptureRecord& record) { return cut->wants(record); });
    };
  });

  auto* merge_command = trace.add_subcommand("merge", kMergeHelp);
  const auto merged = std::make_shared<std::pair<std::vector<std::string>, std::string>>();
  merge_command->add_option("FILE", merged->first, "recordings")->required();
  merge_command->add_option("--out", merged->second, "a file .pcapng or .jsonl")
      ->type_name("FILE")
      ->required();
  merge_command->callback(
      [merged, &action] { action = [merged] { return merge(merged->first, merged->second); }; });
}

}  // namespace armjig::cli
