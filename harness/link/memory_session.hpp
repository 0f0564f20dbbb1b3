// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "harness/core/emulation.hpp"
#include "harness/core/one_client.hpp"
#include "harness/link/session_port.hpp"
#include "harness/link/session_source.hpp"

namespace armjig {

/// Ports to an emulated server in the same process, all on one virtual clock, which begins when the
/// server listens. `Held` is an `EmulatedMultiServer`, or a pointer to something like it.
template <class Held>
class MemoryServer final : public SessionSource {
 public:
  explicit MemoryServer(Held held)
      : held_{std::move(held)}, now_{wait_until_listening(device_in(held_))} {}

  [[nodiscard]] std::unique_ptr<SessionPort> make_port() override {
    return std::make_unique<Port>(*this);
  }
  [[nodiscard]] Instant now() const override { return now_; }
  void pause(Duration duration) override { advance_to(now_ + duration); }
  /// For servers that have `set_input(time, name, value)`.
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override {
    if constexpr (requires { server().set_input(now_, input, value); }) {
      return server().set_input(now_, input, value);
    } else {
      return false;
    }
  }

  [[nodiscard]] auto& server() noexcept { return device_in(held_); }

 private:
  class Port final : public SessionPort {
   public:
    explicit Port(MemoryServer& source) : source_{source} {}
    ~Port() override { close(); }

    Result<void> connect(Instant /*deadline*/) override {
      if (id_) return fail(ErrorCode::kBusy);
      id_ = source_.server().connect(now());
      if (!id_) return fail(ErrorCode::kRefused);
      return {};
    }
    Result<void> send(Bytes segment) override {
      if (!id_) return fail(ErrorCode::kDisconnected);
      source_.server().receive(now(), *id_, segment);
      return {};
    }
    Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
      if (!id_) return fail(ErrorCode::kDisconnected);
      auto& arrived = source_.arrived_[*id_];
      source_.advance_to(now());
      while (arrived.empty()) {
        const auto event = source_.server().next_event();
        const bool is_due = event && *event <= deadline;
        source_.advance_to(is_due ? *event : deadline);
        if (!is_due && arrived.empty()) return Received{Arrival::kDeadline, 0};
      }
      return next(arrived, into, deadline);
    }
    void half_close() override {
      if (id_) source_.server().half_close(now(), *id_);
    }
    void close() override {
      if (id_) source_.server().close(now(), *id_);
      forget();
    }
    void reset() override {
      if (id_) source_.server().reset(now(), *id_);
      forget();
    }
    [[nodiscard]] Instant now() const override { return source_.now_; }

   private:
    Received next(std::deque<ServerEvent>& arrived, std::span<std::byte> into, Instant deadline) {
      auto& event = arrived.front();
      if (event.kind == SessionEvent::Kind::kEnd) {
        // Said again, it takes the time that was given, or who waits for something else never ends.
        if (std::exchange(is_end_told_, true)) source_.advance_to(deadline);
        return {Arrival::kEnd, 0};
      }
      if (event.kind == SessionEvent::Kind::kReset) {
        forget();
        return {Arrival::kReset, 0};
      }
      const auto taken = std::min(into.size(), event.bytes.size());
      std::copy_n(event.bytes.begin(), taken, into.begin());
      event.bytes.erase(event.bytes.begin(),
                        event.bytes.begin() + static_cast<std::ptrdiff_t>(taken));
      if (event.bytes.empty()) arrived.pop_front();
      return {Arrival::kData, taken};
    }
    void forget() {
      if (id_) source_.arrived_.erase(*id_);
      id_.reset();
      is_end_told_ = false;
    }

    MemoryServer& source_;
    std::optional<ConnectionId> id_;
    bool is_end_told_ = false;
  };

  void advance_to(Instant time) {
    now_ = std::max(now_, time);
    server().advance_to(now_);
    for (const auto& event : server().sent()) arrived_[event.connection].push_back(event);
    server().clear_sent();
  }

  Held held_;
  Instant now_;
  std::map<ConnectionId, std::deque<ServerEvent>> arrived_;  ///< at each client
};

/// The only connection to an emulated server in the same process.
template <class Device>
class MemorySession final : public SessionPort {
 public:
  explicit MemorySession(Device device) : source_{Server{std::move(device)}} {}

  Result<void> connect(Instant deadline) override { return port_->connect(deadline); }
  Result<void> send(Bytes segment) override { return port_->send(segment); }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    return port_->receive(into, deadline);
  }
  void half_close() override { port_->half_close(); }
  void close() override { port_->close(); }
  void reset() override { port_->reset(); }
  [[nodiscard]] Instant now() const override { return source_.now(); }

  [[nodiscard]] Device& device() noexcept {
    if constexpr (EmulatedMultiServer<Device>) {
      return source_.server();
    } else {
      return source_.server().device();
    }
  }

 private:
  template <class T>
  struct Adapted : std::type_identity<OneClient<T>> {};
  template <EmulatedMultiServer T>
  struct Adapted<T> : std::type_identity<T> {};
  using Server = typename Adapted<Device>::type;

  MemoryServer<Server> source_;
  std::unique_ptr<SessionPort> port_ = source_.make_port();
};

}  // namespace armjig
