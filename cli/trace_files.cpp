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
#include "cli/foreign_options.hpp"
#include "cli/outputs.hpp"
#include "harness/capture/capture.hpp"
#include "harness/files/user_file.hpp"
#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"
#include "harness/summary/session_summary.hpp"
#include "harness/summary/session_timeline.hpp"

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
    "  armjig trace show session.pcapng --html a.html   a page with a time line\n"
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

/// How recordings are read that other programs wrote.
struct Reading {
  Devices devices;
  std::shared_ptr<ForeignOptions> options = std::make_shared<ForeignOptions>();

  Reading(CLI::App& command, Devices all) : devices{all} { add_foreign_options(command, *options); }

  [[nodiscard]] Outcome<OpenedCapture> open(const std::string& path) const {
    const auto how = foreign_how(devices, *options, {});
    if (!how) return tl::unexpected{how.error()};
    return open_recording(path, *how);
  }
};

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
Exit copy(const Reading& reading, const std::string& from, const std::string& to, bool is_redacted,
          Want want) {
  auto output = CaptureOutput::open("OUT", to, {from});
  if (!output) return report(output.error());
  const auto reader = reading.open(from);
  if (!reader) return refuse(reader.error());
  const auto& header = (*reader)->header();
  auto written = output->begin(is_redacted ? header.redacted() : header);
  std::uint64_t records = 0;
  bool has_any = false;
  CaptureRecord record;
  std::optional<Problem> unreadable;
  while (written) {
    const auto has_record = (*reader)->next(record);
    if (!has_record) unreadable = has_record.error();
    if (!has_record || !*has_record) break;
    has_any = true;
    if (!want(record)) continue;
    written = output->add(record);
    ++records;
  }
  if (written) written = output->flush();
  print_warning_of(**reader);
  if (unreadable) return refuse(*unreadable);  // what came before it is written
  if (!written && written.error().code == ErrorCode::kUnsupported) return refuse(written.error());
  if (!written) return Exit::kRig;  // which `Outputs` tells
  if (records > 0) return Exit::kPassed;
  fmt::print(stderr, "armjig trace: nothing of '{}' is in '{}': it has no record{}\n", from, to,
             has_any ? " that was asked for" : "");
  return Exit::kNothing;
}

/// Records of several recordings in one order.
class Merge {
 public:
  static Outcome<Merge> open(const Reading& reading, const std::vector<std::string>& paths) {
    Merge merge;
    for (const auto& path : paths) {
      auto reader = reading.open(path);
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
    for (const auto& input : inputs_) print_warning_of(*input.reader);
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

Exit merge(const Reading& reading, const std::vector<std::string>& paths, const std::string& to) {
  auto output = CaptureOutput::open("--out", to, paths);
  if (!output) return report(output.error());
  auto merged = Merge::open(reading, paths);
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
  auto text = fmt::format("{}: {}, device {}\n", wording::line(path), reader.format(),
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

Exit info(const Reading& reading, const std::vector<std::string>& paths) {
  bool are_all_read = true;
  for (const auto& path : paths) {
    const auto reader = reading.open(path);
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
    Instant last{};
    const auto read = for_each_record(**reader, [&](const CaptureRecord& record) {
      auto& count = links[fmt::format("{} ({})", record.link->name, to_string(record.link->kind))];
      ++count.records;
      count.bytes += record.bytes.size();
      last = record.time;
    });
    fmt::print("{}", title_of(path, **reader));
    fmt::print("{:<12} {:.6f} s\n", "length", seconds(last));
    for (const auto& [name, count] : links) {
      fmt::print("{:<12} {}: {} records, {} bytes\n", "link", wording::line(name), count.records,
                 count.bytes);
    }
    print_warning_of(**reader);
    if (!read) (void)report(read.error());
    are_all_read = are_all_read && read;
  }
  return are_all_read ? Exit::kPassed : Exit::kUsage;
}

struct Showing {
  std::string path;
  bool wants_json = false;
  std::string html;
};

/// Lines that begin with a word, or with blanks if they go on with that of the line before.
Table table_of(std::string_view text) {
  constexpr std::size_t kWordWidth = 13;
  Table table{{"what", "seen"}, {}};
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    const auto line = text.substr(begin, end - begin);
    begin = end + 1;
    const auto word = line.substr(0, kWordWidth);
    const auto first = word.find_first_not_of(' ');
    const auto last = word.find_last_not_of(' ');
    table.rows.push_back(
        {std::string{first == std::string_view::npos ? "" : word.substr(first, last - first + 1)},
         std::string{line.substr(std::min(line.size(), kWordWidth))}});
  }
  return table;
}

Report page_of(const std::string& path, const std::string& title, const SessionSummary& summary,
               const SessionTimeline& session) {
  Report page;
  page.title = wording::line(path);
  const auto first_end = title.find('\n');
  page.facts.emplace_back("recording",
                          title.substr(page.title.size() + 2, first_end - page.title.size() - 2));
  for (auto& cells : table_of(title.substr(first_end + 1)).rows) {
    page.facts.emplace_back(cells[0], cells[1]);
  }
  auto& line = page.sections.emplace_back();
  line.title = "Time line";
  line.timelines.push_back(session.timeline("The session over time", summary.end()));
  auto& words = page.sections.emplace_back();
  words.title = "At a glance";
  words.table = table_of(summary.to_text());
  return page;
}

Exit show(const Reading& reading, const Showing& options) {
  const auto files = open_outputs({{"--html", options.html}});
  if (!files) return report(files.error());
  const auto& [html] = *files;
  const auto reader = reading.open(options.path);
  if (!reader) return refuse(reader.error());
  SessionTimeline session;
  HearMessage hear;
  if (html) {
    hear = [&session](const auto& link, auto id, const auto& message) {
      session.add(link, id, message);
    };
  }
  SessionSummary summary{[devices = reading.devices](std::string_view name) -> MakeDissector {
                           const auto* const device = find_recorded_device(devices, name);
                           return device == nullptr ? nullptr : device->make_dissector;
                         },
                         std::move(hear)};
  bool is_empty = true;
  const auto read = for_each_record(**reader, [&](const CaptureRecord& record) {
    summary.add(record);
    if (html && record.link->kind == LinkKind::kEvents) session.add_event(record);
    is_empty = false;
  });
  summary.finish();
  const auto title = title_of(options.path, **reader);
  if (options.wants_json) {
    fmt::print("{}\n", summary.to_json());
  } else {
    fmt::print("{}{}", title, wording::lines(summary.to_text()));
  }
  if (html) html->put(to_html(page_of(options.path, title, summary, session)));
  print_warning_of(**reader);
  if (!read) return refuse(read.error());
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
    const auto time = seconds(record.time);
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
  const Reading info_reading{*info_command, devices};
  when_chosen(*info_command, action, [paths, info_reading] { return info(info_reading, *paths); });

  auto* show_command = trace.add_subcommand("show", kShowHelp);
  const auto shown = std::make_shared<Showing>();
  show_command->add_option("FILE", shown->path, "a recording; '-' for standard input")->required();
  show_command->add_flag("--json", shown->wants_json, "one JSON object (docs/schemas)");
  show_command->add_option("--html", shown->html, "also write a page with a time line to this file")
      ->type_name("FILE");
  const Reading show_reading{*show_command, devices};
  when_chosen(*show_command, action, [shown, show_reading] { return show(show_reading, *shown); });

  auto* convert_command = trace.add_subcommand("convert", kConvertHelp);
  const auto converted = add_copying(*convert_command);
  const Reading convert_reading{*convert_command, devices};
  when_chosen(*convert_command, action, [converted, convert_reading] {
    return copy(convert_reading, converted->in, converted->out, converted->is_redacted,
                [](const CaptureRecord&) { return true; });
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
  const Reading cut_reading{*cut_command, devices};
  when_chosen(*cut_command, action, [cut, cut_reading] {
    if (cut->to < cut->from) {
      return report({ErrorCode::kBadValue, "--to", "it is before --from"});
    }
    return copy(cut_reading, cut->in, cut->out, cut->is_redacted,
                [&cut](const CaptureRecord& record) { return cut->wants(record); });
  });

  auto* merge_command = trace.add_subcommand("merge", kMergeHelp);
  const auto merged = std::make_shared<std::pair<std::vector<std::string>, std::string>>();
  merge_command->add_option("FILE", merged->first, "recordings")->required();
  merge_command->add_option("--out", merged->second, "a file .pcapng or .jsonl")
      ->type_name("FILE")
      ->required();
  const Reading merge_reading{*merge_command, devices};
  when_chosen(*merge_command, action, [merged, merge_reading] {
    return merge(merge_reading, merged->first, merged->second);
  });
}

}  // namespace armjig::cli
