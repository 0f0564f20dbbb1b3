// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/morap_probe.hpp"

#include <array>
#include <chrono>

#include "harness/drive/morap/master.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::latency {
namespace {

constexpr std::size_t kAngleSize = 4;
constexpr double kBitTime = 10'000;  ///< nanoseconds at 100 kHz
/// Each transaction: start, bytes of eight bits with their acknowledge, stop.
constexpr double kBits = (1 + 9 * 2 + 1) + (1 + 9 * (1 + kAngleSize) + 1);
constexpr auto kTransactions = kBits * kBitTime;

class AngleProbe final : public Probe {
 public:
  explicit AngleProbe(BusAddress node) noexcept
      : choice_{head_of(write_to(node, {})), static_cast<std::byte>(CommandId::kReadAngle)},
        read_{head_of(read_from(node, {})), std::byte{kAngleSize}} {}

  std::string_view exchange() const noexcept override {
    return "read of an angle, two transactions";
  }
  Hazard hazard() const noexcept override { return Hazard::kObserve; }
  Messages request() override { return messages_; }

  /// Each transaction that was acknowledged comes by itself; a read has bit 0 of its head.
  std::size_t receive(Instant /*now*/, Bytes bytes) override {
    return !bytes.empty() && (bytes.front() & std::byte{1}) != std::byte{0} ? 1 : 0;
  }

  std::optional<Duration> time_on_wire() const override {
    return Duration{static_cast<Duration::rep>(kTransactions)};
  }
  std::vector<Figure> figures(const RunFacts& facts) const override {
    constexpr auto kArithmetic = "arithmetic: 67 bits of two transactions at 100 kHz";
    const auto median = static_cast<double>(facts.median.count());
    std::vector<Figure> figures{
        {"bus time of an angle", kTransactions / 1e6, "ms", kArithmetic},
        {"measured against arithmetic", median / kTransactions, "times", "the median"},
        {"utilisation while it is read", 100 * kTransactions / median, "%", "the median"}};
    if (facts.period) {
      figures.push_back({"utilisation at this rate",
                         100 * median / static_cast<double>(facts.period->count()), "%",
                         "the median and the period"});
    }
    for (const int joints : {1, 2, 3, 6}) {
      figures.push_back({"highest rate for angles of " + std::to_string(joints) + " joints",
                         1e9 / (median * joints), "Hz", "the median"});
    }
    return figures;
  }

 private:
  std::array<std::byte, 2> choice_;
  std::array<std::byte, 2> read_;
  std::array<Bytes, 2> messages_{Bytes{choice_}, Bytes{read_}};
};

}  // namespace

Outcome<std::unique_ptr<Probe>> make_probe(BusPort& port, const std::string& target) {
  constexpr std::uint8_t kLast = 0x1F;
  drive::Master master{port};
  for (auto address = kNodeBaseAddress; address <= kLast; ++address) {
    if (address == pen::kAddress) continue;
    const auto code = master.poke({address});
    if (code == drive::BusCode::kOk) return std::make_unique<AngleProbe>(BusAddress{address});
    if (code == drive::BusCode::kNoSuchAddress) continue;
    return problem(drive::error_of(code), target, std::string{drive::describe(code)});
  }
  return problem(ErrorCode::kTimedOut, target,
                 "no node answers at the addresses 10 to 1F: is the bus powered?");
}

}  // namespace armjig::morap::latency
