// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "emulators/host/session_host.hpp"

namespace armjig::cli {

/// Whether there is anything that could be read. Ask before anything is opened: who starts a
/// program without standard input leaves its number to the first file.
[[nodiscard]] bool has_standard_input() noexcept;

/// Lets people and scripts set the inputs of a hosted server by lines on standard input, `NAME
/// VALUE` or `help`, in a thread of its own; answers go to standard error. A terminal that belongs
/// to another job is left alone, and the end of input ends nothing else.
class ServerInputs {
 public:
  /// `host` must outlive it.
  ServerInputs(SessionHost& host, std::span<const HostedServer::Input> inputs);

 private:
  void read(const std::stop_token& stop);
  void obey(std::string_view line);

  SessionHost& host_;
  std::vector<HostedServer::Input> inputs_;
  std::string text_;  ///< without an end of line yet
  std::jthread thread_;
};

}  // namespace armjig::cli
