// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/parol6_probe.hpp"

#include <array>
#include <optional>

#include "harness/timing/latency_histogram.hpp"
#include "harness/wire/parol6/readings.hpp"
#include "harness/wire/parol6/splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::parol6::latency {
namespace {

constexpr double kBaud = 3'000'000;
constexpr double kBitsPerByte = 10;  ///< with start and stop bit
constexpr auto kExchangeBytes = static_cast<double>(kCommandFrameSize + kTelemetryFrameSize);
/// The board's clock may be 1 % off, so well below its wrap at 93.2 ms.
constexpr Duration kLongestInterval = std::chrono::milliseconds{90};

class IdleProbe final : public Probe {
 public:
  explicit IdleProbe(std::string_view exchange) noexcept : exchange_{exchange} {}

  std::string_view exchange() const noexcept override { return exchange_; }
  Messages request() override { return {&message_, 1}; }

  std::size_t receive(Instant /*now*/, Bytes bytes) override {
    std::size_t answers = 0;
    for_each_step(splitter_, bytes, [&](const Splitter::Step& step) {
      if (const auto frame = telemetry_of(step)) {
        intervals_[(told_ + answers++) % intervals_.size()] = interval_of(frame->timing);
      }
    });
    return answers;
  }

  std::size_t requested(Instant /*now*/, Bytes bytes) override {
    std::size_t requests = 0;
    for_each_step(commands_, bytes, [&requests](const Splitter::Step& step) {
      if (std::holds_alternative<Splitter::Frame>(step.found)) ++requests;
    });
    return requests;
  }

  std::optional<Duration> answered(std::optional<Instant> sent, Instant /*received*/) override {
    const auto board = intervals_[told_++ % intervals_.size()];
    const auto host = sent && last_sent_ ? *sent - *last_sent_ : Duration::max();
    last_sent_ = sent;
    if (host <= Duration{} || host > kLongestInterval) return std::nullopt;
    host_sum_ += host;
    board_sum_ += board;
    ++count_;
    const auto difference = board - host;
    (difference < Duration{} ? early_ : late_)
        .record(difference < Duration{} ? -difference : difference);
    return difference;
  }

  std::vector<Figure> figures(const RunFacts& facts) const override {
    const auto most = kBaud / kBitsPerByte / kExchangeBytes;
    std::vector<Figure> figures{{"link budget at 3 Mbaud", 1e3 / most, "ms an exchange",
                                 "arithmetic: 56 and 60 bytes of 10 bits; over USB the board has "
                                 "no baud rate"}};
    if (facts.period) {
      figures.push_back({"utilisation at 3 Mbaud", 100e9 / most / ns(*facts.period), "%",
                         "arithmetic: the budget at this rate"});
    }
    if (count_ == 0) return figures;
    constexpr auto kBasis = "the board's timing field and the host's send times";
    figures.push_back({"board's clock against the host's",
                       1e2 * (ns(board_sum_) / ns(host_sum_) - 1), "%", kBasis});
    figures.push_back(
        {"frames accepted later than sent, most", ns(late_.max()) / 1e6, "ms", kBasis});
    figures.push_back(
        {"frames accepted earlier than sent, most", ns(early_.max()) / 1e6, "ms", kBasis});
    figures.push_back({"the same at 99 %, later", ns(late_.percentile(99)) / 1e6, "ms", kBasis});
    return figures;
  }

 private:
  static double ns(Duration duration) noexcept { return static_cast<double>(duration.count()); }

  CommandBytes frame_ = encode(CommandFrame{.command = Command::kIdle});
  Bytes message_{frame_};
  std::string_view exchange_;
  Splitter splitter_{kTelemetryPayloadSize};
  Splitter commands_{kCommandPayloadSize};
  std::array<Duration, 256> intervals_{};  ///< of telemetry that belongs to nobody yet; a ring
  std::size_t told_ = 0;
  std::optional<Instant> last_sent_;
  Duration host_sum_{};
  Duration board_sum_{};
  std::size_t count_ = 0;
  LatencyHistogram late_;  ///< by how much more the board counted than the host
  LatencyHistogram early_;
};

}  // namespace

Outcome<std::unique_ptr<Probe>> make_probe(StreamPort& /*port*/, const std::string& /*target*/) {
  return std::make_unique<IdleProbe>("idle frame to telemetry");
}

std::unique_ptr<Probe> make_listener() {
  return std::make_unique<IdleProbe>("any command frame to telemetry");
}

}  // namespace armjig::parol6::latency
