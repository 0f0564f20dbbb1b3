// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/log_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "harness/capture/message_json.hpp"

namespace armjig {

Outcome<LogFile> LogFile::create(const std::string& path, std::string_view device) {
  std::ofstream file{path, std::ios::trunc};
  file << fmt::format(R"({{"format":"golden-trace/1","device":"{}","title":"wire log"}})", device)
       << '\n'
       << std::flush;
  if (!file) {
    return problem(ErrorCode::kCannotWrite, path, "check that the folder exists and is writable");
  }
  return LogFile{std::move(file)};
}

LogFile::LogFile(std::ofstream file) : file_{std::move(file)} {}

void LogFile::add(Instant time, std::string_view keys, std::span<const Message> messages) {
  last_ = std::max(last_, time);
  file_ << fmt::format(R"({{"t_us":{},{})", microseconds(last_), keys);
  const char* separator = ",\"messages\":[";
  for (const auto& message : messages) {
    file_ << separator << to_json(message);
    separator = ",";
  }
  file_ << (messages.empty() ? "}" : "]}") << '\n' << std::flush;
}

}  // namespace armjig
