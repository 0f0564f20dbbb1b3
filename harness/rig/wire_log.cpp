// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/wire_log.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "harness/capture/message_json.hpp"
#include "harness/core/hex.hpp"

namespace armjig {

Outcome<std::shared_ptr<WireLog>> WireLog::create(std::shared_ptr<OutputFile> file,
                                                  std::string_view device,
                                                  MakeDissector make_dissector) {
  const auto begun = file->put(fmt::format(
      "{{\"format\":\"golden-trace/1\",\"device\":\"{}\",\"title\":\"wire log\"}}\n", device));
  if (!begun) return tl::unexpected{begun.error()};
  return std::shared_ptr<WireLog>{new WireLog{std::move(file), make_dissector}};
}

WireLog::WireLog(std::shared_ptr<OutputFile> file, MakeDissector make_dissector)
    : file_{std::move(file)}, make_dissector_{make_dissector} {}

void WireLog::add(Instant time, std::string_view keys, std::span<const Message> messages) {
  last_ = std::max(last_, time);
  auto line = fmt::format(R"({{"t_us":{},{})", microseconds(last_), keys);
  const char* separator = ",\"messages\":[";
  for (const auto& message : messages) {
    line += separator;
    line += to_json(message);
    separator = ",";
  }
  line += messages.empty() ? "}\n" : "]}\n";
  (void)file_->put(line);  // whoever opened it asks for its failure
}

void WireLog::add_input(Instant time, std::string_view kind, std::string_view name,
                        std::int64_t value) {
  add(time, fmt::format(R"("{}":"input","name":"{}","value":{})", kind, name, value));
}

WireLog::Talk::Talk(std::shared_ptr<WireLog> log)
    : log_{std::move(log)}, dissector_{log_->make_dissector_()} {}

void WireLog::Talk::add(Instant time, std::string_view keys, Direction direction, Bytes bytes) {
  std::vector<Message> messages;
  if (!bytes.empty()) dissector_->feed(direction, time, bytes, messages);
  log_->add(time, keys, messages);
}

void WireLog::Talk::add_bytes(Instant time, std::string_view keys, Direction direction,
                              Bytes bytes) {
  const auto line =
      fmt::format(R"("dir":"{}",{}"hex":"{}")", to_string(direction), keys, to_hex(bytes));
  add(time, line, direction, bytes);
}

}  // namespace armjig
