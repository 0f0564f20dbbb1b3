// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/session_rig.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

#include "harness/link/descriptor.hpp"
#include "harness/link/impaired_session.hpp"
#include "harness/link/tcp_session.hpp"
#include "harness/rig/guard.hpp"
#include "harness/rig/session_log.hpp"

namespace armjig {
namespace {

/// Refuses what is not permitted. Unlike `GuardedSession` it says nothing of its own, neither when
/// a connection begins nor when it ends: what then happens is what its users look at.
class JudgedSession final : public SessionPort {
 public:
  JudgedSession(std::unique_ptr<SessionPort> port, std::unique_ptr<Judge> judge,
                Permissions permissions)
      : port_{std::move(port)}, judge_{std::move(judge)}, permissions_{permissions} {}

  Result<void> connect(Instant deadline) override { return port_->connect(deadline); }
  Result<void> send(Bytes segment) override {
    if (judge_->judge(segment, permissions_)) return fail(ErrorCode::kForbidden);
    return port_->send(segment);
  }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    const auto received = port_->receive(into, deadline);
    if (received) judge_->observe(into.first(received->size));
    return received;
  }
  void half_close() override { port_->half_close(); }
  void close() override { port_->close(); }
  void reset() override { port_->reset(); }
  [[nodiscard]] Instant now() const override { return port_->now(); }

 private:
  std::unique_ptr<SessionPort> port_;
  std::unique_ptr<Judge> judge_;
  Permissions permissions_;
};

class TcpSource final : public SessionSource {
 public:
  /// Requires an address that is known to be good.
  explicit TcpSource(std::string address) : address_{std::move(address)} {}

  std::unique_ptr<SessionPort> make_port() override { return *make_tcp_session(address_); }
  [[nodiscard]] Instant now() const override { return clock_.now(); }
  void pause(Duration duration) override { std::this_thread::sleep_for(duration); }
  bool touch(std::string_view /*input*/, std::int64_t /*value*/) override { return false; }

 private:
  std::string address_;
  Stopwatch clock_;
};

/// Something around every port to a server.
class SourceAround : public SessionSource {
 public:
  explicit SourceAround(std::unique_ptr<SessionSource> inner) : inner_{std::move(inner)} {}

  [[nodiscard]] Instant now() const override { return inner_->now(); }
  void pause(Duration duration) override { inner_->pause(duration); }
  bool touch(std::string_view input, std::int64_t value) override {
    return inner_->touch(input, value);
  }

 protected:
  [[nodiscard]] SessionSource& inner() noexcept { return *inner_; }

 private:
  std::unique_ptr<SessionSource> inner_;
};

class LoggedSource final : public SourceAround {
 public:
  LoggedSource(std::unique_ptr<SessionSource> inner, std::shared_ptr<SessionLog> log)
      : SourceAround{std::move(inner)}, log_{std::move(log)} {}

  std::unique_ptr<SessionPort> make_port() override {
    auto port = inner().make_port();
    const auto offset = now() - port->now();
    return std::make_unique<LoggedSession>(std::move(port), log_, offset);
  }
  bool touch(std::string_view input, std::int64_t value) override {
    if (!inner().touch(input, value)) return false;
    log_->file.add(now(), fmt::format(R"("dir":"input","name":"{}","value":{})", input, value));
    return true;
  }

 private:
  std::shared_ptr<SessionLog> log_;
};

class JudgedSource final : public SourceAround {
 public:
  JudgedSource(std::unique_ptr<SessionSource> inner, const JudgeEntry& judge,
               Permissions permissions)
      : SourceAround{std::move(inner)}, judge_{judge}, permissions_{permissions} {}

  std::unique_ptr<SessionPort> make_port() override {
    return std::make_unique<JudgedSession>(inner().make_port(), judge_.make(), permissions_);
  }

 private:
  const JudgeEntry& judge_;
  Permissions permissions_;
};

/// Every port to the server is bad in the same way.
class ImpairedSource final : public SourceAround {
 public:
  ImpairedSource(std::unique_ptr<SessionSource> inner, const Impairment& impairment)
      : SourceAround{std::move(inner)}, impairment_{impairment} {}

  std::unique_ptr<SessionPort> make_port() override {
    return std::make_unique<ImpairedSession>(inner().make_port(), impairment_);
  }

 private:
  Impairment impairment_;
};

Outcome<std::unique_ptr<SessionSource>> open_source(const Target& target,
                                                    OpenEmulatedServer open_emulated) {
  if (target.is_emulated()) return open_emulated(target);
  if (target.scheme != "tcp") {
    return problem(ErrorCode::kBadTarget, target.text,
                   "a server has connections: write emulated: or tcp:HOST:PORT");
  }
  if (const auto port = make_tcp_session(target.address); !port) {
    return tl::unexpected{port.error()};
  }
  return std::make_unique<TcpSource>(target.address);
}

}  // namespace

Outcome<std::unique_ptr<SessionSource>> open_server(std::string_view device,
                                                    const RigOptions& options,
                                                    OpenEmulatedServer open_emulated) {
  auto source = open_source(options.target, open_emulated);
  if (!source) return source;
  if (!options.wire_log.empty()) {
    const auto entry = std::ranges::find(dissectors(), device, &DissectorEntry::device);
    auto log = SessionLog::create(options.wire_log, *entry);
    if (!log) return tl::unexpected{log.error()};
    source = std::make_unique<LoggedSource>(*std::move(source), *std::move(log));
  }
  if (!options.target.is_emulated()) {
    const auto judge = std::ranges::find(judges(), device, &JudgeEntry::device);
    source = std::make_unique<JudgedSource>(*std::move(source), *judge, options.permissions);
  }
  if (options.impairment) {
    source = std::make_unique<ImpairedSource>(*std::move(source), *options.impairment);
  }
  return source;
}

}  // namespace armjig
