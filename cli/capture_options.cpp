// SPDX-License-Identifier: Apache-2.0
#include "cli/capture_options.hpp"

#include <array>
#include <optional>
#include <string_view>

#include "cli/outputs.hpp"
#include "harness/core/number.hpp"

namespace armjig::cli {
namespace {

constexpr std::uint64_t kFewestBytes = 10'000;
constexpr std::uint64_t kMostBytes = 1'000'000'000'000;
constexpr int kMostFiles = 1000;

std::optional<std::uint64_t> parse_size(std::string_view text) {
  struct Unit {
    std::string_view name;
    std::uint64_t bytes;
  };
  constexpr std::array kUnits{Unit{"kB", 1'000}, Unit{"KB", 1'000}, Unit{"MB", 1'000'000},
                              Unit{"GB", 1'000'000'000}, Unit{"B", 1}};
  for (const auto& unit : kUnits) {
    if (!text.ends_with(unit.name)) continue;
    text.remove_suffix(unit.name.size());
    const auto count = whole_text_as<std::uint64_t>(text);
    if (!count || *count > kMostBytes / unit.bytes) return std::nullopt;
    return *count * unit.bytes;
  }
  return std::nullopt;
}

std::optional<CaptureFile::Rotation> parse_rotation(std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto size = parse_size(text.substr(0, comma));
  const auto files = whole_text_as<int>(text.substr(comma + 1));
  if (!size || *size < kFewestBytes || !files || *files < 1 || *files > kMostFiles) {
    return std::nullopt;
  }
  return CaptureFile::Rotation{*size, *files};
}

}  // namespace

CLI::Option* add_capture_options(CLI::App& app, CaptureOptions& options, const std::string& file) {
  auto* option = app.add_option(file, options.file,
                                "write every byte that passes to this file: .pcapng, or .jsonl and "
                                "'-' for a text")
                     ->type_name("FILE");
  app.add_option("--rotate", options.rotate,
                 "begin another file when one has so many bytes, and keep so many files, as in "
                 "100MB,10")
      ->type_name("SIZE,COUNT");
  app.add_flag("--redact", options.is_redacted,
               "leave out of the recording's header who made it and where: target, and so on");
  return option;
}

Outcome<CaptureFile> open_capture_file(std::string_view option, const CaptureOptions& options) {
  CaptureFile capture;
  if (options.file.empty()) {
    if (!options.rotate.empty()) {
      return problem(ErrorCode::kBadValue, "--rotate", "nothing is recorded: say --capture FILE");
    }
    if (options.is_redacted) {
      return problem(ErrorCode::kBadValue, "--redact", "nothing is recorded: say --capture FILE");
    }
    return capture;
  }
  const auto format =
      options.format ? Outcome<CaptureFormat>{*options.format} : capture_format_of(options.file);
  if (!format) return tl::unexpected{format.error()};
  capture.format = *format;
  capture.is_redacted = options.is_redacted;
  if (!options.rotate.empty()) {
    capture.rotation = parse_rotation(options.rotate);
    if (!capture.rotation) {
      return problem(ErrorCode::kBadValue, "--rotate " + options.rotate,
                     "write a size from 10kB to 1000GB and a count from 1 to 1000, as in 100MB,10");
    }
  }
  auto file = open_output(option, options.file, OutputFile::Kind::kGrowing);
  if (!file) return tl::unexpected{std::move(file.error())};
  if (capture.rotation && !(*file)->can_rotate()) {
    return problem(ErrorCode::kBadValue, "--rotate", options.file + " is no file of its own");
  }
  capture.file = *std::move(file);
  return capture;
}

Outcome<HostedCapture> HostedCapture::open(const CaptureFile& file, const Device& device,
                                           const std::string& target, std::int64_t epoch_ns) {
  HostedCapture capture;
  if (file.file == nullptr) return capture;
  auto log = WireLog::create(file, {.device = device.name,
                                    .make_dissector = device.make_dissector,
                                    .target = target,
                                    .epoch_ns = epoch_ns});
  if (!log) return tl::unexpected{std::move(log.error())};
  constexpr std::array kKinds{LinkKind::kStream, LinkKind::kSession, LinkKind::kBus};
  capture.log_ = write_overheard(*std::move(log), kKinds.at(device.port.index()));
  return capture;
}

}  // namespace armjig::cli
