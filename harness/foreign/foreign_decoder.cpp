// SPDX-License-Identifier: Apache-2.0
#include "harness/foreign/foreign_decoder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "harness/foreign/tcp_streams.hpp"
#include "harness/foreign/usb_transfers.hpp"

namespace armjig {
namespace {

class ForeignDecoder final : public PacketDecoder {
 public:
  explicit ForeignDecoder(ForeignHow how) : how_{std::move(how)} {}

  [[nodiscard]] bool knows(std::uint16_t link_type) const noexcept override {
    return is_ip_link(link_type) || is_usb_link(link_type);
  }

  void take(const pcapng::Packet& packet, const pcapng::Interface& interface) override {
    if (is_usb_link(interface.link_type)) {
      usb_.take(packet, interface);
    } else {
      tcp_.take(packet, interface);
    }
  }

  void finish() override {
    tcp_.finish();
    usb_.finish();
  }

  [[nodiscard]] bool next(CaptureRecord& record) override { return found_.next(record); }

  [[nodiscard]] std::string bus_device() const override {
    const auto bus = std::ranges::find(how_.devices, LinkKind::kBus, &ForeignDevice::kind);
    return bus == how_.devices.end() ? std::string{} : bus->name;
  }

  [[nodiscard]] std::string warning(const std::string& name) const override {
    auto text = tcp_.warning(name);
    const auto of_usb = usb_.warning(name);
    if (!text.empty() && !of_usb.empty()) text += '\n';
    return text + of_usb;
  }

 private:
  ForeignHow how_;
  FoundRecords found_;
  TcpStreams tcp_{how_, found_};
  UsbTransfers usb_{how_, found_};
};

}  // namespace

std::unique_ptr<PacketDecoder> make_foreign_decoder(const ForeignHow& how) {
  return std::make_unique<ForeignDecoder>(how);
}

void FoundRecords::add(Instant time, const CaptureLink& link, Direction direction, std::uint32_t id,
                       Bytes bytes, std::string details) {
  bytes_ += bytes.size();
  found_.push_back({.record = {.time = time, .link = &link, .direction = direction, .id = id},
                    .bytes = {bytes.begin(), bytes.end()},
                    .details = std::move(details)});
}

void FoundRecords::add_event(Instant time, const CaptureLink& link, std::string details) {
  add(time, link, Direction::kToDevice, 0, {}, std::move(details));
}

void FoundRecords::add(Instant time, UsbCandidate& candidate, Direction direction, Bytes bytes,
                       std::string details) {
  add(time, *candidate.link, direction, 0, bytes, std::move(details));
  found_.back().candidate = &candidate;
}

bool FoundRecords::next(CaptureRecord& record) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
  constexpr std::size_t kMostRecords = 16'384;
  while (!found_.empty()) {
    auto* const candidate = found_.front().candidate;
    if (candidate != nullptr && candidate->is == UsbCandidate::Is::kUnknown) {
      if (bytes_ <= kMostBytes && found_.size() <= kMostRecords) return false;
      candidate->is = UsbCandidate::Is::kOther;
    }
    const bool is_wanted = candidate == nullptr || candidate->is == UsbCandidate::Is::kWanted;
    given_ = std::move(found_.front());
    found_.pop_front();
    bytes_ -= given_.bytes.size();
    if (!is_wanted) continue;
    record = given_.record;
    if (candidate != nullptr) record.link = candidate->link;
    record.bytes = given_.bytes;
    record.details = given_.details;
    return true;
  }
  return false;
}

std::string lost_details(std::uint64_t lost) {
  return lost == 0 ? std::string{} : fmt::format(R"("lost":{})", lost);
}

}  // namespace armjig
