// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/loop.hpp"
#include "harness/link/emulated_bus_port.hpp"

namespace armjig {
namespace {

/// As patient as an adapter of the kernel.
constexpr Duration kClockPatience = std::chrono::seconds{1};

/// A bus, whose masters come through `Host::with_bus`.
class BusFront final : public Front {
 public:
  explicit BusFront(HostedBus& bus) : port_{&bus, kClockPatience} {}

  [[nodiscard]] Outcome<void> listen(const HostOptions& options) override {
    if (!options.tcp && !options.pty) return {};
    return problem(ErrorCode::kBadValue, "host", "a bus has no pseudo-terminal and no TCP port");
  }
  void forward() override {}
  [[nodiscard]] std::vector<std::string> targets() const override { return {}; }
  [[nodiscard]] LinkStatistics statistics() const override { return {}; }
  [[nodiscard]] BusPort* bus() noexcept override { return &port_; }

 private:
  EmulatedBusPort<HostedBus*> port_;
};

}  // namespace

std::unique_ptr<Front> make_front(Loop& /*loop*/, HostedBus& bus) {
  return std::make_unique<BusFront>(bus);
}

}  // namespace armjig
