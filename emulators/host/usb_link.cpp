// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/usb_link.hpp"

#include <utility>

#include "emulators/usb/cdc_acm.hpp"

namespace armjig {
namespace {

class SerialPortOnUsb final : public UsbLink {
 public:
  SerialPortOnUsb(usb::Identity identity, LinkEvents events)
      : events_{std::move(events)},
        function_{std::move(identity),
                  {.on_bytes = [this](Bytes bytes) { receive(bytes); },
                   .wants_bytes = events_.wants_bytes,
                   .on_open = [this](bool is_open) { statistics_.clients += is_open ? 1 : 0; }}} {}

  [[nodiscard]] Outcome<void> open(Loop& loop, const UsbSocket& place) {
    return export_usb(loop.context(), place, function_, usb_events(loop, [] {}))
        .map([this](auto made) { export_ = std::move(made); });
  }

  /// It leaves when the front asks to read on, which it does after all messages: what the host has
  /// waiting for the device must not come between them.
  void send(Bytes message) override {
    if (function_.send(message)) {
      statistics_.bytes_out += message.size();
    } else {
      ++statistics_.frames_dropped;
    }
  }
  void read_on() override { export_->advance(); }
  void set_cable(Cable cable) override { export_->set_cable(cable); }

  [[nodiscard]] std::vector<std::string> targets() const override { return {export_->target()}; }
  [[nodiscard]] LinkStatistics statistics() const override {
    auto statistics = statistics_;
    statistics.refused = export_->statistics().refused;
    return statistics;
  }

 private:
  void receive(Bytes bytes) {
    statistics_.bytes_in += bytes.size();
    events_.on_bytes(*this, bytes);
  }

  LinkEvents events_;
  LinkStatistics statistics_;
  usb::CdcAcm function_;
  std::unique_ptr<UsbExport> export_;
};

}  // namespace

UsbExport::Events usb_events(Loop& loop, std::function<void()> on_turn) {
  return {.catch_up = [&loop] { return loop.catch_up(); },
          .now = [&loop] { return loop.present(); },
          .wall_time = [&loop](Instant time) { return loop.wall_time(time); },
          .on_turn = std::move(on_turn),
          .on_log = [&loop](std::string_view line) { loop.log(line); }};
}

Outcome<std::unique_ptr<UsbLink>> open_usb_link(Loop& loop, const UsbOptions& options,
                                                LinkEvents events) {
  auto link = std::make_unique<SerialPortOnUsb>(options.identity, std::move(events));
  if (const auto opened = link->open(loop, options.place); !opened) {
    return tl::unexpected{opened.error()};
  }
  return link;
}

}  // namespace armjig
