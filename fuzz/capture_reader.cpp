// SPDX-License-Identifier: Apache-2.0
// Whatever stands in a file, of any format, of other programs, too: its records are read or refused
// with a place and a reason, their times never decrease, and what was read can be written as pcapng
// and read again.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "fuzz/require.hpp"
#include "harness/capture/capture.hpp"
#include "harness/foreign/foreign.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/parol6/dissector.hpp"

namespace armjig::fuzz {
namespace {

/// A file of this process that has the content.
UserFile file_of(std::string_view content) {
  const auto path = "/tmp/armjig-fuzz-" + std::to_string(::getpid());
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{std::fopen(path.c_str(), "wb"), std::fclose};
  require(file != nullptr, "a file can be written");
  (void)std::fwrite(content.data(), 1, content.size(), file.get());
  file.reset();
  auto opened = UserFile::open(path);
  ::unlink(path.c_str());
  require(opened.has_value(), "the file can be read");
  return *std::move(opened);
}

struct Copied {
  std::string content;
  std::size_t records{};
};

Copied copy(std::string_view content, CaptureFormat format) {
  Copied copied;
  static const ForeignHow kHow{
      .devices = {{"kinovazed", LinkKind::kSession, kinovazed::make_dissector, false},
                  {"parol6", LinkKind::kStream, parol6::make_dissector, true},
                  {"morap", LinkKind::kBus, nullptr, false}},
      .ports = {{51717, 0}, {4000, 1}},
      .usb = {}};
  auto reader = open_foreign(file_of(content), "input", kHow);
  if (!reader) {
    require(!reader.error().hint.empty(), "a problem says what is wrong");
    return copied;
  }
  const auto writer = make_capture_writer(format);
  require(writer->begin((*reader)->header(), copied.content).has_value(), "a header fits");
  CaptureRecord record;
  Instant last{};
  while (true) {
    const auto has_record = (*reader)->next(record);
    if (!has_record) require(!has_record.error().hint.empty(), "a problem says what is wrong");
    if (!has_record || !*has_record) break;
    require(record.time >= last, "times never decrease");
    last = record.time;
    if (writer->add(record, {}, copied.content)) ++copied.records;
  }
  (void)(*reader)->warning();
  return copied;
}

void check_capture(std::string_view content) {
  const auto packets = copy(content, CaptureFormat::kPcapng);
  if (packets.content.empty()) return;
  const auto again = copy(packets.content, CaptureFormat::kPcapng);
  require(again.records >= packets.records, "what was written is read");
  require(!copy(packets.content, CaptureFormat::kLines).content.empty(), "it has lines, too");
}

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::check_capture({reinterpret_cast<const char*>(data), size});
  return 0;
}
