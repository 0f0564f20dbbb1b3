// SPDX-License-Identifier: Apache-2.0
#include "harness/console/generic.hpp"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <utility>

#include "harness/console/message_view.hpp"
#include "harness/core/hex.hpp"

namespace armjig::generic {
namespace {

class Console final : public DeviceConsole {
 public:
  Console(StreamLink link, std::unique_ptr<Dissector> dissector, const std::string& target, Say say)
      : DeviceConsole{rows(), target, std::move(say)},
        link_{std::move(link)},
        messages_{std::move(dissector)} {}

  Instant now() override { return link_.port().now(); }

 private:
  static std::span<const Row> rows() noexcept {
    static constexpr std::array kRows{
        Row{"send", "HEX ...", "send bytes, two digits each", kAlways, run<&Console::send>, ""}};
    return kRows;
  }

  Outcome<void> exchange() override {
    std::array<std::byte, 4096> buffer;
    for (const auto deadline = now() + std::chrono::milliseconds{10}; now() < deadline;) {
      const auto size = link_.port().read(buffer, deadline);
      if (!size) return gone(size.error().code, "is it still there and switched on?");
      show(Direction::kFromDevice, std::span{buffer}.first(*size));
    }
    return {};
  }
  Parsed<std::string> state() override {
    if (messages_.count() == 0) return wrong("nothing has come yet");
    auto text = messages_.newest_panel();
    text.pop_back();
    return text;
  }
  void stand() override { say(Tone::kAnswer, "nobody knows here what makes the device stand"); }

  Read send(Words words) {
    std::string text;
    for (const auto word : words) text += fmt::format("{} ", word);
    const auto bytes = from_hex(text);
    if (!bytes) {
      return wrong(fmt::format("{}: write two digits for each byte", describe(bytes.error().code)));
    }
    if (const auto sent = link_.port().write(*bytes); !sent) {
      const auto refusal = link_.last_refusal();
      say(Tone::kFailed, sent.error().code == ErrorCode::kForbidden && refusal
                             ? "refused: " + refusal->reason
                             : std::string{describe(sent.error().code)});
    } else if (link_.is_bus() || !show(Direction::kToDevice, *bytes)) {
      say(Tone::kAnswer, "sent");
    }
    return {};
  }

  /// False: there is nothing to show yet.
  bool show(Direction direction, Bytes bytes) {
    messages_.feed(direction, now(), bytes);
    for (const auto& line : messages_.lines()) {
      say(direction == Direction::kToDevice ? Tone::kAnswer : Tone::kEvent, line);
    }
    return !messages_.lines().empty();
  }

  StreamLink link_;
  MessageView messages_;
};

class WatchedMessages final : public WatchedStream {
 public:
  WatchedMessages(StreamLink link, std::unique_ptr<Dissector> dissector,
                  std::vector<std::vector<std::byte>> requests)
      : WatchedStream{std::move(link)},
        messages_{std::move(dissector)},
        requests_{std::move(requests)} {}

  std::uint64_t answers() const override { return messages_.count(); }
  std::vector<std::string> json_lines() const override { return messages_.json_lines(); }
  std::vector<std::string> lines() const override { return messages_.newest_line(); }
  std::string panel() const override { return messages_.newest_panel(); }
  std::string link() const override {
    return fmt::format("link       {} sent, {} answered\n", sent_, answers());
  }

 private:
  std::vector<std::byte> request(Instant /*now*/) override {
    if (requests_.empty()) return {};
    return requests_[sent_++ % requests_.size()];
  }
  void receive(Instant now, Bytes bytes) override {
    messages_.feed(Direction::kFromDevice, now, bytes);
  }

  MessageView messages_;
  std::vector<std::vector<std::byte>> requests_;
  std::uint64_t sent_ = 0;
};

}  // namespace

std::unique_ptr<DeviceConsole> open(StreamLink link, std::unique_ptr<Dissector> dissector,
                                    const std::string& target, Say say) {
  return std::make_unique<Console>(std::move(link), std::move(dissector), target, std::move(say));
}

std::unique_ptr<Watched> watch(StreamLink link, std::unique_ptr<Dissector> dissector,
                               std::vector<std::vector<std::byte>> requests) {
  return std::make_unique<WatchedMessages>(std::move(link), std::move(dissector),
                                           std::move(requests));
}

}  // namespace armjig::generic
