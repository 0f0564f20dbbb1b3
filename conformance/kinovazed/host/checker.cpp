// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/host/check.hpp"

#include <fmt/core.h>

#include <map>
#include <optional>

#include "conformance/kinovazed/host/conduct.hpp"
#include "conformance/kinovazed/host/lines.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::kinovazed::programs {
namespace {

class HostChecker final : public ProgramChecker {
 public:
  explicit HostChecker(const LinkNoise& noise) : noise_{noise.most}, conduct_{noise.most} {}

  void to_device(Instant time, Bytes bytes) override {
    begin_only(time);
    on_connection({time, 0, ConnectionEvent::Kind::kToServer, bytes});
  }
  void from_device(Instant time, Bytes bytes) override {
    begin_only(time);
    on_connection({time, 0, ConnectionEvent::Kind::kFromServer, bytes});
  }

  void on_connection(const ConnectionEvent& event) override {
    wait_until(event.time);
    if (event.kind == ConnectionEvent::Kind::kBegun) return admit(event.connection);
    const auto client = clients_.find(event.connection);
    if (client == clients_.end()) return;  // it has left, and the server does not know yet
    switch (event.kind) {
      case ConnectionEvent::Kind::kToServer:
        return hear_client(client->second, is_served(client->first), event.bytes);
      case ConnectionEvent::Kind::kFromServer:
        return hear_server(client->second, is_served(client->first), event.bytes);
      case ConnectionEvent::Kind::kDropped:
        return remove(client->first);
      default:
        client->second.lines.end(complain_);
        if (is_served(client->first)) conduct_.leave(now_, complain_);
        remove(client->first);
    }
  }

  void wait_until(Instant time) override {
    now_ = time;
    judge_crowd();
    conduct_.tick(now_, complain_);
  }
  void finish(Instant time) override { wait_until(time); }

  [[nodiscard]] std::size_t messages() const noexcept override { return messages_; }

 private:
  using Id = std::uint32_t;
  struct Client {
    Lines lines;
    LineSplitter answers;
  };

  [[nodiscard]] bool is_served(Id id) const noexcept { return clients_.begin()->first == id; }

  /// For whoever does not tell of connections.
  void begin_only(Instant time) {
    if (clients_.empty()) on_connection({time, 0, ConnectionEvent::Kind::kBegun, {}});
  }

  void admit(Id id) {
    clients_[id] = {};
    if (is_served(id)) return conduct_.begin(now_);
    crowded_since_ = now_;
  }

  /// One that has just left may be seen behind the next one that comes.
  void judge_crowd() {
    if (!crowded_since_ || now_ - *crowded_since_ <= noise_) return;
    complain_("kinovazed.host.one-connection", "a client came, and another one was there",
              {.since = *std::exchange(crowded_since_, std::nullopt)});
  }

  void hear_client(Client& client, bool is_served, Bytes bytes) {
    const auto before = client.lines.count();
    client.lines.feed(
        bytes,
        [&](const Command& command) {
          if (is_served) conduct_.command(now_, command, complain_);
        },
        complain_);
    messages_ += client.lines.count() - before;
  }

  void hear_server(Client& client, bool is_served, Bytes bytes) {
    for_each_step(client.answers, bytes, [&](const LineSplitter::Step& step) {
      if (step.found != LineSplitter::Found::kLine || !is_served) return;
      if (const auto message = decode_message(step.line)) conduct_.message(now_, *message);
    });
  }

  void remove(Id id) {
    const bool was_served = is_served(id);
    clients_.erase(id);
    crowded_since_.reset();
    if (!was_served) return;
    conduct_.end();
    if (!clients_.empty()) conduct_.begin(now_);
  }

  Duration noise_;
  std::size_t messages_ = 0;
  Conduct conduct_;
  std::map<Id, Client> clients_;  ///< the first one is served
  std::optional<Instant> crowded_since_{};
};

}  // namespace

ProgramCheckEntry program_check() noexcept {
  return {"kinovazed", host_requirements, make_checker<HostChecker>,
          shipped_document("docs/spec/kinovazed.md")};
}

}  // namespace armjig::kinovazed::programs
