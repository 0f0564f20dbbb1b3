// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/loop.hpp"
#include "emulators/usb/tiny_usb.hpp"
#include "harness/link/emulated_bus_port.hpp"

namespace armjig {
namespace {

/// As patient as an adapter of the kernel.
constexpr Duration kClockPatience = std::chrono::seconds{1};

/// A bus, whose masters come through `Host::with_bus`, or over USB adapters.
class BusFront final : public Front {
 public:
  BusFront(Loop& loop, HostedBus& bus) : loop_{loop}, port_{&bus, kClockPatience} {}

  [[nodiscard]] Outcome<void> listen(const HostOptions& options) override {
    if (options.tcp || options.pty) {
      return problem(ErrorCode::kBadValue, "host", "a bus has no pseudo-terminal and no TCP port");
    }
    for (const auto& place : options.usb) {
      auto& adapter = adapters_.emplace_back();
      adapter.function = std::make_unique<usb::TinyUsb>(place.identity, port_);
      auto made = export_usb(loop_.context(), place.place, *adapter.function,
                             usb_events(loop_, [this] { settle(); }));
      if (!made) return tl::unexpected{made.error()};
      adapter.cable = *std::move(made);
      hand_.add([at = adapter.cable.get()](Cable cable) { at->set_cable(cable); });
    }
    return {};
  }
  void forward() override {}
  [[nodiscard]] std::vector<std::string> targets() const override {
    std::vector<std::string> all;
    for (const auto& adapter : adapters_) all.push_back(adapter.cable->target());
    return all;
  }
  [[nodiscard]] LinkStatistics statistics() const override {
    LinkStatistics sum;
    for (const auto& adapter : adapters_) sum += adapter.cable->statistics();
    return sum;
  }
  [[nodiscard]] BusPort* bus() noexcept override { return &port_; }

 private:
  struct Adapter {
    std::unique_ptr<usb::TinyUsb> function;
    std::unique_ptr<UsbExport> cable;
  };

  /// Transactions have brought the bus to a time that is still to come.
  void settle() {
    loop_.reach(port_.now());
    loop_.pump();
  }

  Loop& loop_;
  EmulatedBusPort<HostedBus*> port_;
  std::vector<Adapter> adapters_;
};

}  // namespace

std::unique_ptr<Front> make_front(Loop& loop, HostedBus& bus) {
  return std::make_unique<BusFront>(loop, bus);
}

}  // namespace armjig
