// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/stoppable_ports.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace armjig {
namespace {

/// How long a call waits before it asks again.
constexpr Duration kSlice = std::chrono::milliseconds{50};

/// What all have in common.
template <class Around>
class Stoppable : public Around {
 public:
  template <class Port>
  Stoppable(std::unique_ptr<Port> port, MustStop must_stop)
      : Around{std::move(port)}, must_stop_{std::move(must_stop)} {}

 protected:
  [[nodiscard]] bool must_stop() const { return must_stop_(); }

  /// `call()` unless somebody wants an end.
  template <class Call>
  auto unless_stopped(Call call) -> decltype(call()) {
    if (must_stop()) return fail(ErrorCode::kForbidden);
    return call();
  }

  /// `wait(deadline)` in slices until it has `something` or the deadline has come.
  template <class Wait, class Something>
  auto wait_in_slices(Instant deadline, Wait wait, Something something)
      -> decltype(wait(deadline)) {
    for (;;) {
      if (must_stop()) return fail(ErrorCode::kForbidden);
      const auto slice = std::min(deadline, this->now() + kSlice);
      auto result = wait(slice);
      if (!result || something(*result) || slice == deadline) return result;
    }
  }

 private:
  MustStop must_stop_;
};

class StoppableStream final : public Stoppable<StreamAround> {
 public:
  using Stoppable::Stoppable;
  Result<void> write(Bytes bytes) override {
    return unless_stopped([&] { return inner().write(bytes); });
  }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    return wait_in_slices(
        deadline, [&](Instant slice) { return inner().read(into, slice); },
        [](std::size_t size) { return size > 0; });
  }
};

class StoppableSession final : public Stoppable<SessionAround> {
 public:
  using Stoppable::Stoppable;
  Result<void> connect(Instant deadline) override {
    return unless_stopped([&] { return inner().connect(deadline); });
  }
  Result<void> send(Bytes segment) override {
    return unless_stopped([&] { return inner().send(segment); });
  }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    return wait_in_slices(
        deadline, [&](Instant slice) { return inner().receive(into, slice); },
        [](const Received& received) { return received.arrival != Arrival::kDeadline; });
  }
  void half_close() override { inner().half_close(); }
  void close() override { inner().close(); }
  void reset() override { inner().reset(); }
};

class StoppableSource final : public SourceAround {
 public:
  StoppableSource(std::unique_ptr<SessionSource> source, const MustStop& must_stop)
      : SourceAround{std::move(source),
                     [must_stop](std::unique_ptr<SessionPort> port) {
                       return std::make_unique<StoppableSession>(std::move(port), must_stop);
                     }},
        must_stop_{must_stop} {}

  void pause(Duration duration) override {
    for (; duration > Duration::zero() && !must_stop_(); duration -= kSlice) {
      inner().pause(std::min(duration, kSlice));
    }
  }

 private:
  MustStop must_stop_;
};

class StoppableBus final : public Stoppable<BusAround> {
 public:
  using Stoppable::Stoppable;
  Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    return unless_stopped([&] { return inner().transfer(messages); });
  }
  Result<Ack> start(BusAddress address, Access access) override {
    return unless_stopped([&] { return inner().start(address, access); });
  }
  Result<Ack> write(std::byte byte) override {
    return unless_stopped([&] { return inner().write(byte); });
  }
  Result<std::byte> read(Ack reply) override {
    return unless_stopped([&] { return inner().read(reply); });
  }
  Result<void> stop() override { return inner().stop(); }
  void wait_until(Instant time) override {
    while (!must_stop() && now() < time) inner().wait_until(std::min(time, now() + kSlice));
  }
};

}  // namespace

std::unique_ptr<StreamPort> make_stoppable(std::unique_ptr<StreamPort> port, MustStop must_stop) {
  return std::make_unique<StoppableStream>(std::move(port), std::move(must_stop));
}

std::unique_ptr<SessionSource> make_stoppable(std::unique_ptr<SessionSource> source,
                                              const MustStop& must_stop) {
  return std::make_unique<StoppableSource>(std::move(source), must_stop);
}

std::unique_ptr<BusPort> make_stoppable(std::unique_ptr<BusPort> port, MustStop must_stop) {
  return std::make_unique<StoppableBus>(std::move(port), std::move(must_stop));
}

}  // namespace armjig
