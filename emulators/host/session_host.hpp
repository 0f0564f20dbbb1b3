// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "emulators/host/host.hpp"
#include "emulators/host/hosted_server.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// Where and how a server is hosted.
struct SessionHostOptions {
  TcpOptions tcp;
  double speed = 1;  ///< virtual over wall time, `PacedClock::kSlowest` to `kFastest`
  HostOptions::OnSignal on_signal = HostOptions::OnSignal::kNothing;
  std::function<void(std::string_view line)> log = [](std::string_view /*line*/) {};
};

/// Lets an emulated server live on the wall clock and serve real TCP connections, each with its
/// segments, half-close and reset. While the server does not listen, connections are refused. What
/// a server does not read stays in the kernel but for 16 KiB; a client that does not read loses
/// whole messages behind 64 KiB.
///
/// One thread: everything but `stop` and `set_input` belongs to the one that calls `run`.
class SessionHost {
 public:
  /// Problems: `kBadValue` (speed, address), `kBusy`, `kNoPermission`, `kNotFound`, `kSystem`.
  [[nodiscard]] static Outcome<SessionHost> open(std::unique_ptr<HostedServer> server,
                                                 const SessionHostOptions& options);
  SessionHost(SessionHost&& other) noexcept;
  SessionHost& operator=(SessionHost&& other) noexcept;
  SessionHost(const SessionHost&) = delete;
  SessionHost& operator=(const SessionHost&) = delete;
  ~SessionHost();

  /// As `--target` takes it.
  [[nodiscard]] std::string target() const;
  void run();
  /// Ends `run`, now or as soon as it begins. May be called from any thread.
  void stop();
  /// Sets an input of the server while `run` runs, and tells there whether there is one of that
  /// name which takes the value. May be called from any thread.
  void set_input(std::string name, std::int64_t value, std::function<void(bool is_taken)> tell);
  [[nodiscard]] HostStatistics statistics() const;

 private:
  class Loop;
  explicit SessionHost(std::unique_ptr<Loop> loop) noexcept;

  std::unique_ptr<Loop> loop_;
};

}  // namespace armjig
