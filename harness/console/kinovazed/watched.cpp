// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <utility>
#include <variant>

#include "harness/console/kinovazed/console.hpp"
#include "harness/console/kinovazed/view.hpp"
#include "harness/console/message_view.hpp"
#include "harness/wire/kinovazed/dissector.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::kinovazed::console {

namespace {

class WatchedServer final : public WatchedStream {
 public:
  using WatchedStream::WatchedStream;

  std::uint64_t answers() const override { return beats_; }
  std::vector<std::string> json_lines() const override { return messages_.json_lines(); }
  std::vector<std::string> lines() const override {
    if (!beat_) return {};
    return {fmt::format("{}  ({})", state_of(*beat_), flags_of(*beat_))};
  }
  std::string panel() const override {
    if (!beat_) return {};
    return fmt::format("state      {}\nbeat       {}\n", state_of(*beat_), flags_of(*beat_));
  }
  std::string link() const override {
    return fmt::format("link       {} beats, {} events, {} lines that are no message\n", beats_,
                       events_, bad_);
  }

 private:
  void receive(Instant now, Bytes bytes) override {
    messages_.feed(Direction::kFromDevice, now, bytes);
    for_each_step(splitter_, bytes, [this](const LineSplitter::Step& step) {
      if (step.found == LineSplitter::Found::kLine) take_line(step.line);
    });
  }

  void take_line(std::string_view line) {
    const auto message = decode_message(line);
    if (!message) {
      ++bad_;
    } else if (const auto* const beat = std::get_if<Heartbeat>(&*message)) {
      beat_ = *beat;
      ++beats_;
    } else {
      ++events_;
    }
  }

  MessageView messages_{make_dissector()};
  LineSplitter splitter_;
  std::optional<Heartbeat> beat_;
  std::uint64_t beats_ = 0;
  std::uint64_t events_ = 0;
  std::uint64_t bad_ = 0;
};

}  // namespace

Outcome<std::unique_ptr<Watched>> watch(Rig<SessionSource> rig, const std::string& target,
                                        const WatchHow& how) {
  auto link = StreamLink::connect(std::move(rig), target, how.when_gone);
  if (!link) return tl::unexpected{link.error()};
  return std::make_unique<WatchedServer>(*std::move(link));
}

}  // namespace armjig::kinovazed::console
