// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/kinovazed_probe.hpp"

#include <chrono>
#include <optional>
#include <variant>

#include "harness/timing/latency_histogram.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::kinovazed::latency {
namespace {

constexpr double kSecond = 1e9;

class ReplyProbe final : public Probe {
 public:
  std::string_view exchange() const noexcept override { return "Unfreeze to Accepted or Rejected"; }
  Hazard hazard() const noexcept override { return Hazard::kState; }
  Messages request() override { return {&message_, 1}; }

  std::size_t receive(Instant now, Bytes bytes) override {
    std::size_t replies = 0;
    for_each_step(splitter_, bytes, [&](const LineSplitter::Step& step) {
      if (step.found != LineSplitter::Found::kLine) return;
      const auto message = decode_message(step.line);
      if (!message) return;
      if (std::holds_alternative<Heartbeat>(*message)) take_beat(now);
      const auto* const event = std::get_if<Event>(&*message);
      if (event != nullptr && (*event == Event::kAccepted || *event == Event::kRejected)) ++replies;
    });
    return replies;
  }

  std::vector<Figure> figures(const RunFacts& /*facts*/) const override {
    if (periods_.count() == 0) return {};
    const auto ns = [](Duration duration) { return static_cast<double>(duration.count()); };
    constexpr auto kBasis = "times at which heartbeats were read";
    const auto mean =
        ns(last_beat_.value_or(Instant{}) - first_beat_) / static_cast<double>(periods_.count());
    return {{"heartbeat period, mean", mean / 1e6, "ms", kBasis},
            {"heartbeat period, least", ns(periods_.min()) / 1e6, "ms", kBasis},
            {"heartbeat period, most", ns(periods_.max()) / 1e6, "ms", kBasis},
            {"heartbeat drift against one second", 1e6 * (mean / kSecond - 1), "ppm", kBasis}};
  }

 private:
  void take_beat(Instant now) {
    if (last_beat_) {
      periods_.record(now - *last_beat_);
    } else {
      first_beat_ = now;
    }
    last_beat_ = now;
  }

  EncodedLine line_ = encode(Command{.verb = Verb::kUnfreeze});
  Bytes message_ = line_.bytes();
  LineSplitter splitter_;
  Instant first_beat_{};
  std::optional<Instant> last_beat_;
  LatencyHistogram periods_;
};

}  // namespace

Outcome<std::unique_ptr<Probe>> make_probe(SessionSource& /*port*/, const std::string& /*target*/) {
  return std::make_unique<ReplyProbe>();
}

}  // namespace armjig::kinovazed::latency
