// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/wire_log.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/capture/message_json.hpp"
#include "harness/core/hex.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

Outcome<std::shared_ptr<WireLog>> WireLog::create(std::shared_ptr<OutputFile> file,
                                                  std::string_view device,
                                                  MakeDissector make_dissector) {
  const auto begun =
      file->put(line_of({{"format", "golden-trace/1"}, {"device", device}, {"title", "wire log"}}));
  if (!begun) return tl::unexpected{begun.error()};
  return std::shared_ptr<WireLog>{new WireLog{std::move(file), make_dissector}};
}

WireLog::WireLog(std::shared_ptr<OutputFile> file, MakeDissector make_dissector)
    : file_{std::move(file)}, make_dissector_{make_dissector} {}

void WireLog::add(Instant time, const Keys& keys, std::span<const Message> messages) {
  last_ = std::max(last_, time);
  Json line{{"t_us", microseconds(last_)}};
  for (const auto& [name, value] : keys) {
    std::visit([&, key = std::string{name}](const auto& one) { line[key] = one; }, value);
  }
  for (const auto& message : messages) line["messages"].push_back(message_object<Json>(message));
  (void)file_->put(line_of(line));  // whoever opened it asks for its failure
}

void WireLog::add_input(Instant time, std::string_view kind, std::string_view name,
                        std::int64_t value) {
  add(time, {{kind, "input"}, {"name", std::string{name}}, {"value", value}});
}

WireLog::Talk::Talk(std::shared_ptr<WireLog> log)
    : log_{std::move(log)}, dissector_{log_->make_dissector_()} {}

void WireLog::Talk::add(Instant time, const Keys& keys, Direction direction, Bytes bytes) {
  std::vector<Message> messages;
  if (!bytes.empty()) dissector_->feed(direction, time, bytes, messages);
  log_->add(time, keys, messages);
}

void WireLog::Talk::add_bytes(Instant time, const Keys& keys, Direction direction, Bytes bytes) {
  Keys all{{"dir", std::string{to_string(direction)}}};
  all.insert(all.end(), keys.begin(), keys.end());
  all.push_back({"hex", to_hex(bytes)});
  add(time, all, direction, bytes);
}

}  // namespace armjig
