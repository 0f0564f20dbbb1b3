// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/morap_probe.hpp"

#include <fmt/core.h>

#include <array>
#include <chrono>

#include "harness/drive/morap/master.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::latency {
namespace {

constexpr std::size_t kAngleSize = 4;
constexpr double kBitTime = 10'000;  ///< nanoseconds at 100 kHz
/// A transaction: start, bytes of eight bits with their acknowledge, stop.
constexpr double time_of(std::size_t bytes) noexcept {
  return (1 + 9 * static_cast<double>(bytes) + 1) * kBitTime;
}
constexpr auto kTransactions = time_of(2) + time_of(1 + kAngleSize);

Duration whole(double nanoseconds) noexcept {
  return Duration{static_cast<Duration::rep>(nanoseconds)};
}

bool is_read(Bytes transaction) noexcept {
  return !transaction.empty() && (transaction.front() & std::byte{1}) != std::byte{0};
}

std::vector<Figure> bus_figures(const RunFacts& facts, double on_wire, std::string_view what) {
  const auto arithmetic =
      fmt::format("arithmetic: {:g} bits of two transactions at 100 kHz", on_wire / kBitTime);
  const auto median = static_cast<double>(facts.median.count());
  std::vector<Figure> figures{
      {fmt::format("bus time of {}", what), on_wire / 1e6, "ms", arithmetic},
      {"measured against arithmetic", median / on_wire, "times", "the median"},
      {"utilisation while it is read", 100 * on_wire / median, "%", "the median"}};
  if (facts.period) {
    const auto period = static_cast<double>(facts.period->count());
    figures.push_back(
        {"utilisation at this rate", 100 * on_wire / period, "%", "arithmetic and the period"});
    figures.push_back({"busy at this rate", 100 * median / period, "%",
                       "the median, pauses of the master included, and the period"});
  }
  for (const int joints : {1, 2, 3, 6}) {
    figures.push_back(
        {fmt::format("highest rate for {} of {} joint{}", what, joints, joints == 1 ? "" : "s"),
         1e9 / (median * joints), "Hz", "the median"});
  }
  return figures;
}

class AngleProbe final : public Probe {
 public:
  explicit AngleProbe(BusAddress node) noexcept
      : choice_{head_of(write_to(node, {})), static_cast<std::byte>(CommandId::kReadAngle)},
        read_{head_of(read_from(node, {})), std::byte{kAngleSize}} {}

  std::string_view exchange() const noexcept override {
    return "read of an angle, two transactions";
  }
  Messages request() override { return messages_; }

  /// Each transaction that was acknowledged comes by itself.
  std::size_t receive(Instant /*now*/, Bytes bytes) override { return is_read(bytes) ? 1 : 0; }

  std::optional<Duration> time_on_wire() const override { return whole(kTransactions); }
  std::vector<Figure> figures(const RunFacts& facts) const override {
    return bus_figures(facts, kTransactions, "an angle");
  }

 private:
  std::array<std::byte, 2> choice_;
  std::array<std::byte, 2> read_;
  std::array<Bytes, 2> messages_{Bytes{choice_}, Bytes{read_}};
};

/// Of what others read. Records have the time at which a transaction began.
class ReadListener final : public Probe {
 public:
  std::string_view exchange() const noexcept override {
    return "choice of what to read, and the read: two transactions";
  }
  Messages request() override { return {}; }

  std::size_t requested(Instant /*now*/, Bytes bytes) override {
    const bool is_choice = bytes.size() == 2 && !is_read(bytes) &&
                           find_reading(CommandId{std::to_integer<std::uint8_t>(bytes[1])});
    return is_choice ? 1 : 0;
  }
  std::size_t receive(Instant /*now*/, Bytes bytes) override {
    if (!is_read(bytes)) return 0;
    is_mixed_ = is_mixed_ || (size_ != 0 && size_ != bytes.size());
    size_ = bytes.size();
    return 1;
  }
  Duration rest_of(Bytes bytes) const override { return whole(time_of(bytes.size())); }

  std::optional<Duration> time_on_wire() const override {
    if (size_ == 0 || is_mixed_) return std::nullopt;
    return whole(time_of(2) + time_of(size_));
  }
  std::vector<Figure> figures(const RunFacts& facts) const override {
    const auto on_wire = time_on_wire();
    if (!on_wire) return {};
    return bus_figures(facts, static_cast<double>(on_wire->count()), "a read");
  }

 private:
  std::size_t size_ = 0;   ///< of the last one, its head included
  bool is_mixed_ = false;  ///< there were others
};

}  // namespace

Outcome<BusAddress> first_node(BusPort& port, const std::string& target) {
  constexpr std::uint8_t kLast = 0x1F;
  drive::Master master{port};
  for (auto address = kNodeBaseAddress; address <= kLast; ++address) {
    if (address == pen::kAddress) continue;
    const auto code = master.poke({address});
    if (code == drive::BusCode::kOk) return BusAddress{address};
    if (code == drive::BusCode::kNoSuchAddress) continue;
    return problem(drive::error_of(code), target, std::string{drive::describe(code)});
  }
  return problem(ErrorCode::kTimedOut, target,
                 "no node answers at the addresses 10 to 1F: is the bus powered?");
}

Outcome<std::unique_ptr<Probe>> make_probe(BusPort& port, const std::string& target) {
  return first_node(port, target).map([](BusAddress node) -> std::unique_ptr<Probe> {
    return std::make_unique<AngleProbe>(node);
  });
}

std::unique_ptr<Probe> make_listener() { return std::make_unique<ReadListener>(); }

}  // namespace armjig::morap::latency
