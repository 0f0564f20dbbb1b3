// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/stream_link.hpp"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

namespace armjig {
namespace {

class Transactions final : public StreamPort {
 public:
  explicit Transactions(BusPort& port) : port_{port} {}

  Result<void> write(Bytes bytes) override {
    if (bytes.empty()) return {};
    const auto first = std::to_integer<std::uint8_t>(bytes.front());
    const bool is_read = (first & 1) != 0;
    const BusAddress address{static_cast<std::uint8_t>(first >> 1)};
    std::vector<std::byte> passed{bytes.begin(), bytes.end()};
    if (is_read) passed.resize(1 + (bytes.size() > 1 ? std::to_integer<std::size_t>(bytes[1]) : 1));
    const auto data = std::span{passed}.subspan(1);
    const auto message = is_read ? read_from(address, data) : write_to(address, data);
    const auto done = port_.transfer({&message, 1});
    if (!done) return tl::unexpected{done.error()};
    if (*done != Transfer::kDone) return fail(ErrorCode::kNotFound);
    passed_.push_back(std::move(passed));
    return {};
  }

  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    if (passed_.empty()) {
      if (deadline > now()) port_.wait_until(deadline);
      return 0;
    }
    const auto bytes = std::move(passed_.front());
    passed_.pop_front();
    const auto size = std::min(into.size(), bytes.size());
    std::copy_n(bytes.begin(), size, into.begin());
    return size;
  }
  [[nodiscard]] Instant now() const override { return port_.now(); }

 private:
  BusPort& port_;
  std::deque<std::vector<std::byte>> passed_;  ///< and not read
};

}  // namespace

StreamLink::StreamLink(Rig<BusPort> rig) : rig_{std::move(rig)} {
  adapter_ = std::make_unique<Transactions>(std::get<Rig<BusPort>>(rig_).port());
}

Outcome<StreamLink> StreamLink::connect(Rig<SessionSource> rig, const std::string& target,
                                        WhenGone when_gone) {
  return armjig::connect(std::move(rig), target, when_gone).map([](auto stream) {
    return StreamLink{std::move(stream)};
  });
}

std::optional<Refusal> StreamLink::last_refusal() const {
  return std::visit([](const auto& rig) { return rig.last_refusal(); }, rig_);
}

std::optional<ImpairmentStatistics> StreamLink::impairments() const {
  return std::visit([](const auto& rig) { return rig.impairments(); }, rig_);
}

}  // namespace armjig
