// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/session_rig.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "harness/link/impaired_session.hpp"
#include "harness/link/tcp_session.hpp"
#include "harness/rig/guard.hpp"

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
  TcpSource(std::string address, const JudgeEntry& judge, Permissions permissions)
      : address_{std::move(address)}, judge_{judge}, permissions_{permissions} {}

  std::unique_ptr<SessionPort> make_port() override {
    return std::make_unique<JudgedSession>(*make_tcp_session(address_), judge_.make(),
                                           permissions_);
  }
  void pause(Duration duration) override { std::this_thread::sleep_for(duration); }
  bool touch(std::string_view /*input*/, std::int64_t /*value*/) override { return false; }

 private:
  std::string address_;
  const JudgeEntry& judge_;
  Permissions permissions_;
};

/// Every port to the server is bad in the same way.
class ImpairedSource final : public SessionSource {
 public:
  ImpairedSource(std::unique_ptr<SessionSource> inner, const Impairment& impairment)
      : inner_{std::move(inner)}, impairment_{impairment} {}

  std::unique_ptr<SessionPort> make_port() override {
    return std::make_unique<ImpairedSession>(inner_->make_port(), impairment_);
  }
  void pause(Duration duration) override { inner_->pause(duration); }
  bool touch(std::string_view input, std::int64_t value) override {
    return inner_->touch(input, value);
  }

 private:
  std::unique_ptr<SessionSource> inner_;
  Impairment impairment_;
};

Outcome<std::unique_ptr<SessionSource>> open_source(std::string_view device,
                                                    const RigOptions& options,
                                                    OpenEmulatedServer open_emulated) {
  const auto& target = options.target;
  if (target.is_emulated()) return open_emulated(target);
  if (target.scheme != "tcp") {
    return problem(ErrorCode::kBadTarget, target.text,
                   "a server has connections: write emulated: or tcp:HOST:PORT");
  }
  if (const auto port = make_tcp_session(target.address); !port) {
    return tl::unexpected{port.error()};
  }
  const auto judge = std::ranges::find(judges(), device, &JudgeEntry::device);
  return std::make_unique<TcpSource>(target.address, *judge, options.permissions);
}

}  // namespace

Outcome<std::unique_ptr<SessionSource>> open_server(std::string_view device,
                                                    const RigOptions& options,
                                                    OpenEmulatedServer open_emulated) {
  if (!options.wire_log.empty()) {
    return problem(ErrorCode::kUnsupported, "--wire-log " + options.wire_log,
                   "there is none of servers with several connections; record with tcpdump");
  }
  auto source = open_source(device, options, open_emulated);
  if (!source || !options.impairment) return source;
  return std::make_unique<ImpairedSource>(*std::move(source), *options.impairment);
}

}  // namespace armjig
