// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "emulators/host/loop.hpp"
#include "emulators/host/usb_link.hpp"

namespace armjig {
namespace {

/// Clients whose bytes wait for a slow line are not read any further.
constexpr std::size_t kMostUnread = 4096;

/// A byte stream on one link or several. Answers go to the link that sent last.
class StreamFront final : public Front {
 public:
  StreamFront(Loop& loop, HostedStream& device) : loop_{loop}, device_{device} {}

  [[nodiscard]] Outcome<void> listen(const HostOptions& options) override {
    if (options.pty) {
      auto added = add(open_pty_link(loop_.context(), *options.pty, events()));
      if (!added) return added;
    }
    for (const auto* place : {&options.tcp, &options.rfc2217}) {
      if (!*place) continue;
      auto added = add(open_tcp_link(loop_.context(), **place, events()));
      if (!added) return added;
    }
    for (const auto& place : options.usb) {
      auto link = open_usb_link(loop_, place, events());
      if (!link) return tl::unexpected{link.error()};
      hand_.add([at = link->get()](Cable cable) { at->set_cable(cable); });
      links_.push_back(*std::move(link));
    }
    if (links_.empty()) {
      return problem(ErrorCode::kBadValue, "host",
                     "a pseudo-terminal, a TCP port or a USB socket is needed");
    }
    // On its only link, a device that speaks first is heard.
    if (links_.size() == 1) listener_ = links_.front().get();
    return {};
  }

  void forward() override {
    for (const auto& message : device_.sent()) {
      if (listener_ != nullptr) listener_->send(message.bytes);
    }
    device_.clear_sent();
    for (const auto& link : links_) link->read_on();
  }

  [[nodiscard]] std::vector<std::string> targets() const override {
    std::vector<std::string> all;
    for (const auto& link : links_) {
      for (auto& target : link->targets()) all.push_back(std::move(target));
    }
    return all;
  }

  [[nodiscard]] LinkStatistics statistics() const override {
    LinkStatistics sum;
    for (const auto& link : links_) sum += link->statistics();
    return sum;
  }

 private:
  [[nodiscard]] Outcome<void> add(Outcome<std::unique_ptr<ClientLink>> link) {
    if (!link) return tl::unexpected{link.error()};
    links_.push_back(std::move(*link));
    return {};
  }

  [[nodiscard]] LinkEvents events() {
    return {.on_bytes =
                [this](ClientLink& from, Bytes bytes) {
                  listener_ = &from;
                  device_.receive(loop_.catch_up(), bytes);
                  loop_.pump();
                },
            .wants_bytes = [this] { return device_.unread() < kMostUnread; },
            .on_log = [this](std::string_view line) { loop_.log(line); }};
  }

  Loop& loop_;
  HostedStream& device_;
  std::vector<std::unique_ptr<ClientLink>> links_;
  ClientLink* listener_ = nullptr;  ///< who gets answers: one of `links_`
};

}  // namespace

std::unique_ptr<Front> make_front(Loop& loop, HostedStream& device) {
  return std::make_unique<StreamFront>(loop, device);
}

}  // namespace armjig
