// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/host/client_link.hpp"
#include "emulators/host/hosted_stream.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// Where and how a device is hosted. At least one link is needed.
struct HostOptions {
  enum class OnSignal : std::uint8_t { kNothing, kStop };

  std::optional<PtyOptions> pty;
  std::optional<TcpOptions> tcp;
  double speed = 1;  ///< virtual over wall time, `PacedClock::kSlowest` to `kFastest`
  OnSignal on_signal = OnSignal::kNothing;  ///< `kStop`: SIGINT and SIGTERM end `run`
  std::function<void(std::string_view line)> log = [](std::string_view /*line*/) {};
};

struct HostStatistics {
  LinkStatistics links;  ///< of all together
  Duration lost{};       ///< virtual time by which the device fell behind for want of CPU
};

/// Lets an emulated device live on the wall clock and talk to clients on real links. Bytes reach it
/// at the virtual time of their arrival, and leave when virtual time has come; answers go to the
/// link that sent last.
///
/// One thread: everything but `stop` and `set_input` belongs to the one that calls `run`.
class Host {
 public:
  /// Listens from now on; clients are served once it runs. Problems: `kBadValue` (speed, no link),
  /// and those of `open_pty_link` and `open_tcp_link`.
  [[nodiscard]] static Outcome<Host> open(std::unique_ptr<HostedStream> device,
                                          const HostOptions& options);
  Host(Host&& other) noexcept;
  Host& operator=(Host&& other) noexcept;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  /// Stops listening and removes the stable link.
  ~Host();

  /// Where clients find the device, as `--target` takes it; stable links follow their terminals.
  [[nodiscard]] std::vector<std::string> targets() const;

  /// Serves clients until it is stopped.
  void run();

  /// Ends `run`, now or as soon as it begins. May be called from any thread.
  void stop();

  /// Does something beside the device while `run` runs, and tells there whether there is an input
  /// of that name which takes the value. May be called from any thread.
  void set_input(std::string name, std::int64_t value, std::function<void(bool is_taken)> tell);

  [[nodiscard]] HostStatistics statistics() const;

 private:
  class Loop;
  explicit Host(std::unique_ptr<Loop> loop) noexcept;

  std::unique_ptr<Loop> loop_;
};

}  // namespace armjig
