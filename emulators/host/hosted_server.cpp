// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/hosted_server.hpp"

namespace armjig {
namespace {

class KinovaServer final : public HostedServer {
 public:
  explicit KinovaServer(kinovazed::DefectiveServer server) : server_{std::move(server)} {}

  [[nodiscard]] bool is_listening() const override { return server_.is_listening(); }
  std::optional<ConnectionId> connect(Instant time) override { return server_.connect(time); }
  void receive(Instant time, ConnectionId id, Bytes segment) override {
    server_.receive(time, id, segment);
  }
  void half_close(Instant time, ConnectionId id) override { server_.half_close(time, id); }
  void close(Instant time, ConnectionId id) override { server_.close(time, id); }
  void reset(Instant time, ConnectionId id) override { server_.reset(time, id); }
  [[nodiscard]] std::size_t unread(ConnectionId id) const override { return server_.unread(id); }
  void advance_to(Instant time) override { server_.advance_to(time); }
  [[nodiscard]] std::optional<Instant> next_event() const override { return server_.next_event(); }
  [[nodiscard]] std::span<const Event> sent() const override { return server_.sent(); }
  void clear_sent() override { server_.clear_sent(); }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    return server_.set_input(time, name, value);
  }
  [[nodiscard]] std::vector<std::string> take_log() override {
    std::vector<std::string> lines;
    for (const auto& line : server_.log()) lines.push_back(line.text);
    server_.clear_log();
    return lines;
  }

 private:
  kinovazed::DefectiveServer server_;
};

}  // namespace

std::unique_ptr<HostedServer> make_hosted_server(kinovazed::DefectiveServer server) {
  return std::make_unique<KinovaServer>(std::move(server));
}

}  // namespace armjig
