// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/node.hpp"
#include "harness/link/usb_control.hpp"

namespace armjig {

/// An adapter with a MORAP node (identifier 2) on its bus, as seen by control transfers: what a
/// machine without one can have. It notes the request of each message.
class TinyUsbAdapter final : public UsbControl {
 public:
  struct Behaviour {
    std::byte functions{0x01};
    std::optional<ErrorCode> trouble{};  ///< of everything but the first two requests
    bool is_cut_short = false;           ///< takes and gives one byte less than it should
  };
  struct Log {
    std::vector<int> requests;
    std::optional<std::uint16_t> delay;
  };

  TinyUsbAdapter(Behaviour behaviour, std::shared_ptr<Log> log)
      : behaviour_{behaviour}, log_{std::move(log)} {
    bus_.attach(morap::emulation::Node{{.eeprom = morap::emulation::dcx22l()}});
  }

  Result<std::size_t> read(UsbRequest request, std::span<std::byte> into) override {
    if (request.request == 1) {
      std::ranges::fill(into, std::byte{});
      into[0] = behaviour_.functions;
      return into.size();
    }
    if (behaviour_.trouble) return fail(*behaviour_.trouble);
    if (request.request == 3) {
      into[0] = status_;
      return 1;
    }
    if (!begin(request, /*is_read=*/true)) return 0;
    for (auto& byte : into) {
      const auto reply = bus_.read(time_);
      time_ = reply.end;
      byte = reply.byte;
    }
    end(request);
    return into.size() - (behaviour_.is_cut_short ? 1 : 0);
  }

  Result<std::size_t> write(UsbRequest request, Bytes bytes) override {
    if (request.request == 2) {
      log_->delay = request.value;
      return 0;
    }
    if (behaviour_.trouble) return fail(*behaviour_.trouble);
    if (!begin(request, /*is_read=*/false)) return 0;
    for (const auto byte : bytes) time_ = bus_.write(time_, byte).end;
    end(request);
    return bytes.size() - (behaviour_.is_cut_short ? 1 : 0);
  }

 private:
  bool begin(UsbRequest request, bool is_read) {
    log_->requests.push_back(request.request);
    EXPECT_EQ(request.value, is_read ? 1 : 0);
    const auto reply = bus_.start(time_, static_cast<std::uint8_t>(request.index), is_read);
    time_ = reply.end;
    const bool is_there = reply.outcome == BusReply::Outcome::kAck;
    status_ = std::byte{is_there ? std::uint8_t{1} : std::uint8_t{2}};
    return is_there;
  }
  void end(UsbRequest request) {
    if ((request.request & 2) != 0) time_ = bus_.stop(time_).end;
  }

  Behaviour behaviour_;
  std::shared_ptr<Log> log_;
  i2c::Bus bus_;
  Instant time_{};
  std::byte status_{};
};

}  // namespace armjig
