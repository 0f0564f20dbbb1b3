// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/serial_line.hpp"

#include <algorithm>
#include <cassert>
#include <deque>
#include <utility>

namespace armjig {
namespace {

/// Characters on their way in one direction, each with the time of its last bit.
class Direction {
 public:
  struct Character {
    Instant arrival{};
    std::byte value{};
  };

  void send(Instant time, Bytes bytes, CharacterRate rate) {
    if (time > free_from_) {
      begin_ = time;
      count_ = 0;
    }
    for (const auto byte : bytes) {
      free_from_ = begin_ + rate.time_of(++count_);
      waiting_.push_back({free_from_, byte});
    }
  }
  [[nodiscard]] bool has_arrived(Instant time) const noexcept {
    return !waiting_.empty() && waiting_.front().arrival <= time;
  }
  [[nodiscard]] Character take() {
    const auto first = waiting_.front();
    waiting_.pop_front();
    return first;
  }
  [[nodiscard]] std::optional<Instant> next_arrival() const noexcept {
    return waiting_.empty() ? std::nullopt : std::optional{waiting_.front().arrival};
  }
  [[nodiscard]] std::size_t size() const noexcept { return waiting_.size(); }

 private:
  std::deque<Character> waiting_;
  Instant free_from_{};
  Instant begin_{};          ///< of characters without a pause between them
  std::uint64_t count_ = 0;  ///< of them
};

std::optional<Instant> earlier(std::optional<Instant> a, std::optional<Instant> b) noexcept {
  return a && b ? std::min(*a, *b) : (a ? a : b);
}

class OnLine final : public HostedStream {
 public:
  OnLine(std::unique_ptr<HostedStream> device, CharacterRate rate)
      : device_{std::move(device)}, rate_{rate} {}

  void receive(Instant time, Bytes bytes) override {
    advance_to(time);
    to_device_.send(time, bytes, rate_);
  }
  /// From one arrival or event to the next, because each answer begins its way when it is sent.
  void advance_to(Instant time) override {
    for (auto next = earlier(device_->next_event(), to_device_.next_arrival());
         next && *next <= time; next = earlier(device_->next_event(), to_device_.next_arrival())) {
      reached_ = std::max(reached_, *next);
      device_->advance_to(reached_);
      while (to_device_.has_arrived(reached_)) {
        const auto character = to_device_.take();
        device_->receive(reached_, {&character.value, 1});
      }
      take_sent();
    }
    reached_ = std::max(reached_, time);
    device_->advance_to(reached_);
    take_sent();
    while (from_device_.has_arrived(time)) {
      const auto character = from_device_.take();
      sent_.push_back({character.arrival, {character.value}});
    }
  }
  [[nodiscard]] std::optional<Instant> next_event() const override {
    return earlier(device_->next_event(),
                   earlier(to_device_.next_arrival(), from_device_.next_arrival()));
  }
  [[nodiscard]] std::span<const SentBytes> sent() const override { return sent_; }
  void clear_sent() override { sent_.clear(); }
  [[nodiscard]] std::size_t unread() const override {
    return to_device_.size() + device_->unread();
  }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    advance_to(time);
    const bool is_taken = device_->set_input(time, name, value);
    take_sent();
    return is_taken;
  }
  void overlook(Instant from, Instant to) override { device_->overlook(from, to); }
  [[nodiscard]] std::span<const DeviceInput> inputs() const override { return device_->inputs(); }
  [[nodiscard]] std::vector<std::string> take_log() override { return device_->take_log(); }
  [[nodiscard]] std::unique_ptr<HostedStream> clone() const override {
    auto device = device_->clone();
    if (!device) return nullptr;
    auto copy = std::make_unique<OnLine>(std::move(device), rate_);
    copy->to_device_ = to_device_;
    copy->from_device_ = from_device_;
    copy->reached_ = reached_;
    copy->sent_ = sent_;
    return copy;
  }

 private:
  void take_sent() {
    for (const auto& message : device_->sent()) {
      from_device_.send(message.time, message.bytes, rate_);
    }
    device_->clear_sent();
  }

  std::unique_ptr<HostedStream> device_;
  CharacterRate rate_;
  Direction to_device_;
  Direction from_device_;
  Instant reached_{};
  std::vector<SentBytes> sent_;
};

}  // namespace

std::unique_ptr<HostedStream> put_on_line(std::unique_ptr<HostedStream> device,
                                          CharacterRate rate) {
  assert(rate.baud > 0 && rate.bits > 0);
  return std::make_unique<OnLine>(std::move(device), rate);
}

}  // namespace armjig
