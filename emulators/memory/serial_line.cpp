// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/serial_line.hpp"

#include <algorithm>
#include <cassert>
#include <deque>
#include <utility>

#include "emulators/memory/hosted_around.hpp"

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

/// The device, and the characters on their way to it and from it.
class Line : public hosted_by::SenderAround<HostedStream> {
 public:
  Line(std::unique_ptr<HostedStream> device, CharacterRate rate)
      : SenderAround{std::move(device)}, rate_{rate} {}

 protected:
  template <class Work>
  auto act(Instant time, Work work) {
    carry_to(time);
    return hosted_by::do_then([&] { return work(time); }, [this] { take_answers(); });
  }
  void send(Instant time, Bytes bytes) { to_device_.send(time, bytes, rate_); }
  [[nodiscard]] std::size_t unread_on_line() const noexcept { return to_device_.size(); }
  [[nodiscard]] std::optional<Instant> next_on_line() const {
    return earlier(next_at_device(), from_device_.next_arrival());
  }
  void copy_line_of(const Line& other) {
    to_device_ = other.to_device_;
    from_device_ = other.from_device_;
    reached_ = other.reached_;
    sent_ = other.sent_;
  }
  [[nodiscard]] CharacterRate rate() const noexcept { return rate_; }

 private:
  [[nodiscard]] std::optional<Instant> next_at_device() const {
    return earlier(device().next_event(), to_device_.next_arrival());
  }
  /// From one arrival or event to the next, because each answer begins its way when it is sent.
  void carry_to(Instant time) {
    for (auto next = next_at_device(); next && *next <= time; next = next_at_device()) {
      lead_to(*next);
      while (to_device_.has_arrived(reached_)) {
        const auto character = to_device_.take();
        device().receive(reached_, {&character.value, 1});
      }
      take_answers();
    }
    lead_to(time);
    take_answers();
    while (from_device_.has_arrived(time)) {
      const auto character = from_device_.take();
      sent_.push_back({character.arrival, {character.value}});
    }
  }
  void lead_to(Instant time) {
    reached_ = std::max(reached_, time);
    device().advance_to(reached_);
  }
  void take_answers() {
    take_sent([this](const SentBytes& sent) { from_device_.send(sent.time, sent.bytes, rate_); });
  }

  CharacterRate rate_;
  Direction to_device_;
  Direction from_device_;
  Instant reached_{};
};

class OnLine final : public hosted_by::Stream<Line> {
 public:
  using Stream::Stream;

  void receive(Instant time, Bytes bytes) override {
    act(time, [&](Instant now) { send(now, bytes); });
  }
  [[nodiscard]] std::optional<Instant> next_event() const override { return next_on_line(); }
  [[nodiscard]] std::size_t unread() const override { return unread_on_line() + device().unread(); }
  [[nodiscard]] std::unique_ptr<HostedStream> clone() const override {
    auto inner = device().clone();
    if (!inner) return nullptr;
    auto copy = std::make_unique<OnLine>(std::move(inner), rate());
    copy->copy_line_of(*this);
    return copy;
  }
};

}  // namespace

std::unique_ptr<HostedStream> put_on_line(std::unique_ptr<HostedStream> device,
                                          CharacterRate rate) {
  assert(rate.baud > 0 && rate.bits > 0);
  return std::make_unique<OnLine>(std::move(device), rate);
}

}  // namespace armjig
