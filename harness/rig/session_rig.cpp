// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/session_rig.hpp"

#include <thread>
#include <utility>

#include "harness/link/impaired_session.hpp"
#include "harness/link/tcp_session.hpp"

namespace armjig {
namespace {

class TcpSource final : public SessionSource {
 public:
  explicit TcpSource(std::string address) : address_{std::move(address)} {}

  /// Requires an address that is known to be good.
  std::unique_ptr<SessionPort> make_port() override { return *make_tcp_session(address_); }
  void pause(Duration duration) override { std::this_thread::sleep_for(duration); }
  bool touch(std::string_view /*input*/, std::int64_t /*value*/) override { return false; }

 private:
  std::string address_;
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

Outcome<std::unique_ptr<SessionSource>> open_server(const RigOptions& options,
                                                    OpenEmulatedServer open_emulated) {
  if (!options.wire_log.empty()) {
    return problem(ErrorCode::kUnsupported, "--wire-log " + options.wire_log,
                   "there is none of servers with several connections; record with tcpdump");
  }
  auto source = open_source(options.target, open_emulated);
  if (!source || !options.impairment) return source;
  return std::make_unique<ImpairedSource>(*std::move(source), *options.impairment);
}

}  // namespace armjig
